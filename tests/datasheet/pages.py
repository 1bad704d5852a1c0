"""
Pages to look at: of a spec as it is generated, and with a verification's outcome.
"""

import re
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

from stepgen import api
from stepgen.datasheet.page import render_datasheet
from stepgen.datasheet.report import Report
from stepgen.devices import Pin
from stepgen.plan.model import MotorPlan, Plan

ROOT = Path(__file__).resolve().parents[2]
SPECS = sorted((ROOT / "specs").glob("*.yaml"))


def spec(name: str) -> Path:
    """
    Return the path of a spec in specs/.
    """
    return ROOT / "specs" / f"{name}.yaml"


def page(path: Path, report: Report | None = None) -> str:
    """
    Return the datasheet of the spec in *path*.
    """
    return render_datasheet(api.plan(path), path.read_text(encoding="utf-8"), report)


def report_of(plan: Plan, **changes: Any) -> Report:  # noqa: ANN401 - fields of the report
    """
    Return a report as a verification of *plan* could have it, with figures that are easy to find.

    The library has five checks of its own, and each motor 25, as many as one with limits has.
    """
    motors = {
        motor.name: {
            "isr_cycles": {"measured_max": 7001 + index, "bound": 7101 + index},
            "cycles_per_step": 7201.5 + index,
            "jitter_cycles": 7301 + index,
        }
        for index, motor in enumerate(plan.motors)
    }
    names = [f"a check of usual length {number}" for number in range(30)]
    own = [f"{motor.name}: {name}" for motor in plan.motors for name in names[5:]]
    checks = [{"name": name, "passed": True, "detail": ""} for name in (*names[:5], *own)]
    found = {
        "compiler": "gcc-5.4",
        "simulator": "simavr 1.6",
        "passed": True,
        "checks": checks,
        "motors": motors,
        "flash_bytes": 7401,
        "ram_bytes": 7501,
        "stack_bytes": 7601,
        "stack_bound_bytes": 7701,
    }
    return Report.model_validate(found | changes)


def ends_of(motor: MotorPlan) -> list[tuple[str, Pin]]:
    """
    Return what is wired to *motor*: signal and pin of each wire, those of its switches last.
    """
    wires = [(wire.signal, wire.pin) for wire in motor.drive.every_wire]
    return wires + [(switch.signal, switch.pin) for switch in motor.end_switches]


class Reader(HTMLParser):
    """
    Reads a page: its tags in their order, the rows of its tables, the texts of its titles.
    """

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, tuple[str, ...]]] = []
        self.rows: list[list[str]] = []
        self.titles: list[str] = []
        self.captions: dict[str, list[list[str]]] = {}
        self._inside = ""
        self._caption = ""
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """
        Note the tag, and begin a row, a cell or a title.
        """
        self.tags.append((tag, tuple(name for name, _ in attrs)))
        self._inside = tag
        if tag == "tr":
            self.rows.append([])
            self.captions[self._caption].append(self.rows[-1])
        if tag in {"td", "th"}:
            self.rows[-1].append("")
        if tag == "title":
            self.titles.append("")

    def handle_endtag(self, tag: str) -> None:  # noqa: ARG002 - the parser's signature
        """
        End the text of the tag.
        """
        self._inside = ""

    def handle_data(self, data: str) -> None:
        """
        Add to the cell, title or caption that is open.
        """
        if self._inside in {"td", "th"}:
            self.rows[-1][-1] += data
        if self._inside == "title":
            self.titles[-1] += data
        if self._inside == "caption":
            self._caption = data
            self.captions[data] = []


def words(text: str) -> str:
    """
    Return what a page says, without its tags.
    """
    return re.sub(r"\s+", " ", re.sub(r"<[^>]*>", " ", text))

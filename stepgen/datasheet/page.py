"""
The page: everything that its template prints, and the page as text.
"""

import functools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from jinja2 import Environment

from stepgen import __version__
from stepgen.datasheet import figures
from stepgen.datasheet.chart import Chart, motion_charts
from stepgen.datasheet.figures import Table
from stepgen.datasheet.scene import Scene
from stepgen.datasheet.wire_tables import limit_tables, ownership_table, wire_table
from stepgen.datasheet.wiring import wiring_scene
from stepgen.library.prose import takes
from stepgen.library.rates_view import lateness
from stepgen.library.render import environment, spec_hash
from stepgen.library.text import frequency, listed, tidy
from stepgen.library.view import make_view
from stepgen.plan.model import Plan
from stepgen.plan.warnings import PlanWarning, plan_warnings

if TYPE_CHECKING:
    from stepgen.datasheet.report import Check, Report

PATH = "extras/datasheet.html"


@dataclass(frozen=True)
class PageView:
    """
    The datasheet as finished text and drawings.

    Args:
        outcome_css: The class of the outcome: ``open``, ``good`` or ``bad``.
        beside: What must not be used beside the library, or only with care, a line each.
        passed: The names of the checks that passed, or "".
        failed: The checks that did not.
    """

    name: str
    version: str
    author: str
    sentence: str
    hardware: str
    banner: str
    outcome: str
    outcome_css: str
    facts: tuple[tuple[str, str], ...]
    wiring: Scene
    wires: tuple[Table, ...]
    ownership: Table
    beside: tuple[str, ...]
    rates: tuple[Table, ...]
    charts: tuple[Chart, ...]
    interrupts: Table
    memory: Table
    safe: Table
    held: Table
    lateness: str
    passed: str
    failed: "tuple[Check, ...]"


def render_datasheet(plan: Plan, spec_text: str, report: "Report | None" = None) -> str:
    """
    Return the page about the library of *plan*; *report* tells what a verification found.

    The same plan, spec and report give the same bytes: no date, no path of this machine.
    """
    view = page_view(plan, spec_text, report)
    return tidy(_environment().get_template("datasheet/page.html.j2").render(page=view))


@functools.cache
def _environment() -> Environment:
    """
    Return that of libraries, but that it escapes what is printed; kept as that is.
    """
    return environment().overlay(autoescape=True)


def page_view(plan: Plan, spec_text: str, report: "Report | None") -> PageView:
    """
    Return everything that the template prints about *plan* and *report*.
    """
    board, library = plan.board, make_view(plan, spec_hash(spec_text))
    motors = "; ".join(
        f"{motor.name}: {motor.drive.title}, {motor.drive.steps_text}" for motor in plan.motors
    )
    checks = report.checks if report else ()
    return PageView(
        name=library.name,
        version=library.version,
        author=library.author,
        sentence=library.sentence,
        hardware=f"{board.title} ({board.mcu.title}, {frequency(board.f_cpu_hz)}). {motors}",
        banner=f"stepgen {__version__}, spec {spec_hash(spec_text)}",
        outcome=figures.outcome(report),
        outcome_css="open" if report is None else "good" if report.passed else "bad",
        facts=tuple(figures.facts(plan)),
        wiring=wiring_scene(plan),
        wires=(*map(wire_table, plan.motors), *limit_tables(plan)),
        ownership=ownership_table(plan),
        beside=_beside(plan),
        rates=tuple(figures.rate_tables(plan)),
        charts=tuple(motion_charts(plan)),
        interrupts=figures.interrupt_table(plan, report),
        memory=figures.memory_table(plan, report),
        safe=figures.safe_table(plan),
        held=figures.held_table(plan),
        lateness=_plain(lateness(plan)),
        passed="; ".join(check.name for check in checks if check.passed),
        failed=tuple(check for check in checks if not check.passed),
    )


def _beside(plan: Plan) -> tuple[str, ...]:
    under: dict[str, list[PlanWarning]] = {}
    for warning in plan_warnings(plan):
        under.setdefault(warning.cause, []).append(warning)
    return tuple(map(_plain, (*takes(plan), *(_of_all(alike) for alike in under.values()))))


def _of_all(alike: Sequence[PlanWarning]) -> str:
    """
    Return warnings of one cause as one, with the limit of each motor.
    """
    first = alike[0]
    if not first.motor:
        return first.reason
    if not alike[1:] or not first.limit:
        return f"{listed([warning.motor for warning in alike])}: {first.reason}"
    limits = "; ".join(f"{warning.motor}: {warning.limit}" for warning in alike)
    return f"{first.cause}: {limits}"


def _plain(markdown: str) -> str:
    return markdown.replace("`", "")

"""
The page: everything that its template prints, and the page as text.
"""

import functools
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from jinja2 import Environment

from stepgen import __version__
from stepgen.datasheet import figures
from stepgen.datasheet.chart import Chart, motion_charts
from stepgen.datasheet.names import together
from stepgen.datasheet.outcome import outcome, passed_checks
from stepgen.datasheet.rates import rate_tables
from stepgen.datasheet.scene import Scene
from stepgen.datasheet.summary import facts, motor_table, ownership_table
from stepgen.datasheet.tables import Table, Tables, by_width
from stepgen.datasheet.wire_tables import limit_tables, wire_tables
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
_FEW_MOTORS = 2


@dataclass(frozen=True)
class PageView:
    """
    The datasheet as finished text and drawings.

    Args:
        size: The class of the page: ``few`` motors leave room for larger print than ``many``.
        outcome_css: The class of the outcome: ``open``, ``good`` or ``bad``.
        motors: Motors, wires and limits; of one motor what it has for itself, since its figures
            are in *facts*.
        beside: What must not be used beside the library, or only with care, a line each.
        passed: Motors, and the names of the checks that they passed.
        failed: The checks that did not.
    """

    name: str
    size: str
    version: str
    author: str
    sentence: str
    hardware: str
    banner: str
    outcome: str
    outcome_css: str
    facts: tuple[tuple[str, str], ...]
    wiring: Scene
    motors: Tables
    beside: tuple[str, ...]
    rates: Tables
    charts: tuple[Chart, ...]
    interrupts: Tables
    memory: Table
    safe: Table
    held: Table
    lateness: str
    passed: tuple[tuple[str, str], ...]
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
    several = bool(plan.motors[1:])
    first = plan.motors[0]
    drive = "" if several else f" {first.name}: {first.drive.title}, {first.drive.steps_text}"
    checks = report.checks if report else ()
    return PageView(
        name=library.name,
        size="many" if len(plan.motors) > _FEW_MOTORS else "few",
        version=library.version,
        author=library.author,
        sentence=library.sentence,
        hardware=f"{board.title} ({board.mcu.title}, {frequency(board.f_cpu_hz)}).{drive}",
        banner=f"stepgen {__version__}, spec {spec_hash(spec_text)}",
        outcome=outcome(report),
        outcome_css="open" if report is None else "good" if report.passed else "bad",
        facts=tuple(facts(plan)),
        wiring=wiring_scene(plan),
        motors=by_width(
            (
                motor_table(plan) if several else ownership_table(plan),
                *wire_tables(plan),
                *limit_tables(plan),
            )
        ),
        beside=_beside(plan),
        rates=by_width(rate_tables(plan)),
        charts=tuple(motion_charts(plan)),
        interrupts=by_width([figures.interrupt_table(plan, report)]),
        memory=figures.memory_table(plan, report),
        safe=figures.safe_table(plan),
        held=figures.held_table(plan),
        lateness=_plain(lateness(plan)),
        passed=tuple(passed_checks(report, plan)),
        failed=tuple(check for check in checks if not check.passed),
    )


def _beside(plan: Plan) -> tuple[str, ...]:
    under: dict[str, list[PlanWarning]] = {}
    for warning in plan_warnings(plan):
        under.setdefault(warning.cause, []).append(warning)
    lines = (*takes(plan), *(_of_all(alike) for alike in under.values()))
    names = listed([motor.name for motor in plan.motors])
    every = together(plan.motors, plan)
    return tuple(_plain(re.sub(rf"^{names}: ", f"{every}: ", line)) for line in lines)


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

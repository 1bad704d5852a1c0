"""
The tables of the datasheet: the plan's numbers and a verification's as finished text.
"""

from collections.abc import Callable, Iterator, Sequence
from itertools import takewhile
from typing import TYPE_CHECKING

from stepgen.datasheet.names import row_names
from stepgen.datasheet.tables import NONE, Row, Table
from stepgen.plan.model import MotorPlan, Plan, RateLimit

if TYPE_CHECKING:
    from stepgen.datasheet.report import MotorFigures, Report

NOT_VERIFIED = "not verified"
_TENTHS_OF_US = 10_000_000  # in a second


def safe_table(plan: Plan) -> Table:
    """
    Return the highest rate at which each motor loses no step, alone and beside what is named.
    """
    rows = [row for motor in plan.motors for row in _safe_rows(motor.name, plan)]
    stem = _stem([cause for *_, cause in rows])
    short = tuple((*row[:-1], row[-1].removeprefix(stem)) for row in rows)
    heading: Row = (
        "motor",
        "beside",
        "steps/s",
        "clocks",
        f"what allows no more{stem and f': {stem.rstrip()}'}",
    )
    return Table("Highest rate without a lost step", heading, short, kind="safe")


def _safe_rows(name: str, plan: Plan) -> Iterator[Row]:
    """
    Yield the rates of a motor; those that are the same, beside more and more, are one row.
    """
    alike: dict[Row, list[str]] = {}
    for limit in plan.rates[name]:
        rate: Row = (f"{int(limit.steps_per_second)}", f"{limit.period_cycles}", _cause(limit))
        alike.setdefault(rate, []).append(limit.beside)
    for rate, beside in alike.items():
        first, *more = beside
        yield (name, f"{first} up to {more[-1]}" if more else first, *rate)


def _stem(texts: Sequence[str]) -> str:
    """
    Return the words, with no figure in them, with which all of *texts* begin, or "".
    """
    words = zip(*(text.split(" ") for text in texts), strict=False)
    same = takewhile(lambda each: len(set(each)) == 1 and each[0].isalpha(), words)
    return "".join(f"{each[0]} " for each in same) if texts[1:] else ""


def _cause(limit: RateLimit) -> str:
    names = ", ".join(limit.unproven)
    return f"{limit.cause} (not proven: {names})" if names else limit.cause


def held_table(plan: Plan) -> Table:
    """
    Return how long interrupts may be off at some rates, and how late a step then is.
    """
    rows = tuple(
        (
            f"{int(held.steps_per_second)}",
            *_allowed(held.stretch_cycles, plan),
            *_late(held.late_cycles, plan),
        )
        for held in plan.held_off
    )
    heading = ("up to steps/s", "off at most, clocks", "us", "a step then late, clocks", "us")
    return Table("How long the sketch may have interrupts off", heading, rows, kind="figures")


def _allowed(cycles: int, plan: Plan) -> Row:
    """
    Return *cycles*, and microseconds that are not more.
    """
    return (f"{cycles}", f"{cycles * _TENTHS_OF_US // plan.board.f_cpu_hz / 10:.1f}")


def _late(cycles: int, plan: Plan) -> Row:
    """
    Return *cycles*, and microseconds that are not less.
    """
    return (f"{cycles}", f"{-(-cycles * _TENTHS_OF_US // plan.board.f_cpu_hz) / 10:.1f}")


def interrupt_table(plan: Plan, report: "Report | None") -> Table:
    """
    Return the cycles of each step interrupt: as planned, as the program bounds, as measured.
    """
    motors = plan.motors

    def planned(name: str, value: Callable[[MotorPlan], object]) -> Row:
        return (name, *(str(value(motor)) for motor in motors))

    def measured(name: str, value: "Callable[[MotorFigures], object]") -> Row:
        if report is None:
            return (name, *(NONE for _ in motors))
        return (name, *(str(value(report.motors[motor.name])) for motor in motors))

    rows = [
        planned("a step, response to RETI", lambda m: m.hot_path.usual_cycles),
        planned("from the timer's flag to the pins", lambda m: m.hot_path.edge_cycles),
        planned("the same at a boundary", lambda m: m.hot_path.boundary_edge_cycles),
    ]
    if any(motor.motion.watches_clock for motor in motors):
        rows.insert(1, planned("a step that looks at the clock", _clock_watch))
    if any(motor.hot_path.lap_cycles for motor in motors):
        rows.insert(1, planned("a lap between two steps", _laps))
    rows += [
        planned("longest, allowed by the plan", lambda m: m.isr_bound_cycles),
        measured("longest, by the linked program", lambda m: m.isr_cycles.bound),
        measured("longest, measured", lambda m: m.isr_cycles.measured_max),
        measured("mean of a step, measured", _mean),
        measured("latest edge (jitter), measured", lambda m: m.jitter_cycles),
    ]
    rows.append(planned("interrupts off in a call", lambda m: m.masked_bound_cycles))
    heading = ("clocks", *(row_names(plan)[motor.name] for motor in motors))
    note = "" if report else f"{NONE} {NOT_VERIFIED}"
    return Table("Step interrupts", heading, tuple(rows), note, kind="figures")


def _clock_watch(motor: MotorPlan) -> str:
    return f"{motor.hot_path.clock_cycles}" if motor.motion.watches_clock else "none"


def _laps(motor: MotorPlan) -> str:
    return f"{motor.hot_path.lap_cycles[0]}" if motor.hot_path.lap_cycles else "none"


def _mean(figures: "MotorFigures") -> str:
    # Without the long run, which slow simulators leave out, there is no mean.
    return f"{figures.cycles_per_step:g}" if figures.cycles_per_step else "not measured"


def memory_table(plan: Plan, report: "Report | None") -> Table:
    """
    Return flash, RAM and stack that the library takes over an empty sketch.
    """
    mcu = plan.board.mcu
    flash, ram, stack = (NOT_VERIFIED,) * 3
    if report:
        flash = f"{report.flash_bytes} bytes of {mcu.flash_bytes}"
        ram = f"{report.ram_bytes} bytes of {mcu.ram_bytes}"
        stack = f"{report.stack_bytes} bytes, at most {report.stack_bound_bytes}"
    rows = (("flash", flash), ("RAM", ram), ("stack of the step interrupts", stack))
    return Table("Memory, over an empty sketch", ("", "takes"), rows, kind="figures")

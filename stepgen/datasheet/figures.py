"""
The tables of the datasheet: the plan's numbers and a verification's as finished text.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

from stepgen.library.rates_view import microseconds
from stepgen.library.text import listed
from stepgen.plan.curves import FRACTION
from stepgen.plan.ladder import LONGEST_INTERVAL_CYCLES
from stepgen.plan.limit_facts import range_steps
from stepgen.plan.model import MotorPlan, Plan, RateLimit
from stepgen.plan.rates import Clock
from stepgen.plan.timings import plan_setting
from stepgen.units import deviation_ppm, turns_per_minute

if TYPE_CHECKING:
    from stepgen.datasheet.report import MotorFigures, Report

NOT_VERIFIED = "not verified"
_TICKS = ("virtual TOP", "prescaler x ticks")
_TENTHS_OF_US = 10_000_000  # in a second
_RATES_SPS = (1, 10, 30, 100, 200, 300, 500, 1_000, 2_000, 3_000, 5_000, 10_000, 20_000)

Row = tuple[str, ...]
Rates = tuple[tuple[Row, Fraction], ...]
"""Rows about rates, and the rate on the wire of each in steps/s."""


@dataclass(frozen=True)
class Table:
    """
    A table: its heading, and rows whose first cell names them.
    """

    caption: str
    heading: Row
    rows: tuple[Row, ...]


def rate_tables(plan: Plan) -> Iterator[Table]:
    """
    Yield what the timers make of usual rates, one table for the motors that have the same.

    It has a column for the RPM of each gear.
    """
    alike: dict[Rates, list[MotorPlan]] = {}
    axes = [motor for motor in plan.motors if motor.motion.ladder]
    if axes:
        alike[_axis_rates(axes, plan)] = axes
    for motor in plan.motors:
        if motor not in axes:
            alike.setdefault(_rates(motor, plan), []).append(motor)
    for rates, motors in alike.items():
        ticks = ("interval, 1/256 clocks",) if motors == axes else _TICKS
        heading = ("steps/s", *ticks, "on the wire", "ppm off")
        columns = tuple(_rpm_columns(rates, motors))
        rows = [heading, *(cells for cells, _ in rates)]
        first, *others = ((*row, *more) for row, *more in zip(rows, *columns, strict=True))
        yield Table(f"{listed([m.name for m in motors])}: rates", first, tuple(others))


def _rpm_columns(rates: Rates, motors: Sequence[MotorPlan]) -> Iterator[Row]:
    """
    Yield the RPM of *rates* for each gear, below the names of those that have it, unless all have.
    """
    of_gear: dict[Fraction, list[str]] = {}
    for motor in motors:
        if motor.steps_per_turn:
            of_gear.setdefault(motor.steps_per_turn, []).append(motor.name)
    for turn, names in of_gear.items():
        heading = "RPM" if len(names) == len(motors) else f"{listed(names)} RPM"
        yield (heading, *(f"{float(turns_per_minute(real, turn)):.5g}" for _, real in rates))


def _axis_rates(axes: Sequence[MotorPlan], plan: Plan) -> Rates:
    """
    Return the intervals of usual rates, and of the cruise speeds of *axes*, which are the highest.
    """
    f_cpu_256 = plan.board.f_cpu_hz * FRACTION
    cruises = sorted({motor.motion.cruise_interval_256 for motor in axes}, reverse=True)
    usual = [(f_cpu_256 // sps, Fraction(sps)) for sps in _RATES_SPS]
    longest = LONGEST_INTERVAL_CYCLES * FRACTION
    wanted = [row for row in usual if cruises[-1] < row[0] <= longest]
    wanted += [(cruise, Fraction(f_cpu_256, cruise)) for cruise in cruises]
    rates = []
    for interval, rate in sorted(set(wanted), reverse=True):
        real = Fraction(f_cpu_256, interval)
        rates.append(((f"{float(rate):.7g}", str(interval), *_wire(real, rate)), real))
    return tuple(rates)


def _rates(motor: MotorPlan, plan: Plan) -> Rates:
    """
    Return what the timer of *motor* makes of usual rates, and of the highest that is accepted.
    """
    f_cpu, fastest = plan.board.f_cpu_hz, plan.minimum_period_cycles
    periods = [f_cpu // rate for rate in _RATES_SPS]
    wanted = [(period, Fraction(rate)) for period, rate in zip(periods, _RATES_SPS, strict=True)]
    allowed = [row for row in wanted if fastest < row[0] <= motor.timing.largest_period_cycles]
    rates = []
    for period, rate in (*allowed, (fastest, Fraction(f_cpu, fastest))):
        setting = plan_setting(motor.timing, period)
        real = Clock(f_cpu).rate_sps(setting.period_cycles)
        ticks = f"{setting.prescaler} x {setting.top + 1}"
        rates.append(((f"{float(rate):.7g}", str(period), ticks, *_wire(real, rate)), real))
    return tuple(rates)


def _wire(real: Fraction, wanted: Fraction) -> Row:
    """
    Return the rate on the wire, and its deviation in ppm.
    """
    deviation = f"{round(deviation_ppm(real, wanted)):+d}" if real != wanted else "0"
    return (f"{float(real):.8g}", deviation)


def safe_table(plan: Plan) -> Table:
    """
    Return the highest rate at which each motor loses no step, alone and beside what is named.
    """
    rows = tuple(
        (
            motor.name,
            limit.beside,
            f"{int(limit.steps_per_second)}",
            f"{limit.period_cycles}",
            _cause(limit),
        )
        for motor in plan.motors
        for limit in plan.rates[motor.name]
    )
    heading = ("motor", "beside", "steps/s", "clocks", "what allows no more")
    return Table("Highest rate without a lost step", heading, rows)


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
    return Table("How long the sketch may have interrupts off", heading, rows)


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
            return (name, *(NOT_VERIFIED for _ in motors))
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
    heading = ("clocks", *(motor.name for motor in motors))
    return Table("Step interrupts", heading, tuple(rows))


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
    return Table("Memory, over an empty sketch", ("", "takes"), rows)


def outcome(report: "Report | None") -> str:
    """
    Return what came out of the verification, in a few words.
    """
    if report is None:
        return "not verified yet: run stepgen verify"
    failed = sum(not check.passed for check in report.checks)
    tools = f"{report.compiler} on {report.simulator}"
    if report.passed:
        return f"verified: {len(report.checks)} checks passed, {tools}"
    return f"FAILED: {failed} of {len(report.checks)} checks, {tools}"


def facts(plan: Plan) -> Iterator[tuple[str, str]]:
    """
    Yield the few figures that people look for first.
    """
    for motor in plan.motors:
        safest = plan.rates[motor.name][-1]
        yield (f"{motor.name}, up to", f"{int(safest.steps_per_second)} steps/s")
        yield (f"{motor.name}, a step takes", f"{motor.hot_path.usual_cycles} clocks")
        if motor.end_stops and motor.end_stops.range:
            yield (f"{motor.name}, range", range_steps(motor.end_stops.range))
    fastest = plan.held_off[-1]
    yield (
        f"interrupts off at {int(fastest.steps_per_second)} steps/s",
        f"{int(microseconds(fastest, plan))} us at most",
    )

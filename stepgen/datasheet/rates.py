"""
The tables of rates: what the timers make of usual ones, of the highest, and of cruise speeds.
"""

from collections.abc import Iterator, Sequence
from fractions import Fraction

from stepgen.datasheet.names import together
from stepgen.datasheet.tables import Row, Table
from stepgen.plan.curves import FRACTION
from stepgen.plan.ladder import LONGEST_INTERVAL_CYCLES
from stepgen.plan.model import MotorPlan, Plan
from stepgen.plan.rates import Clock
from stepgen.plan.timings import plan_setting
from stepgen.units import deviation_ppm, turns_per_minute

_TICKS = ("virtual TOP", "prescaler x ticks")
_AXIS_TICKS = ("interval, 1/256 clocks",)
_MOST_GEARS = 4  # that have a column of their own
_RATES_SPS = (1, 10, 30, 100, 200, 300, 500, 1_000, 2_000, 3_000, 5_000, 10_000, 20_000)

Rates = tuple[tuple[Row, Fraction], ...]
"""Rows about rates, and the rate on the wire of each in steps/s."""


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
        yield _rate_table(rates, motors, plan)


def _rate_table(rates: Rates, motors: Sequence[MotorPlan], plan: Plan) -> Table:
    """
    Return the table of *rates*, which *motors* have in common.
    """
    ticks: Row = _AXIS_TICKS if motors[0].motion.ladder else _TICKS
    cells = [row for row, _ in rates]
    notes = []
    if ticks == _TICKS and all(row[2] == f"1 x {row[1]}" for row in cells):
        ticks = _TICKS[:1]
        notes.append("prescaler 1, as many ticks")
        cells = [(*row[:2], *row[3:]) for row in cells]
    columns = tuple(_rpm_columns(rates, motors))
    if len(columns) > _MOST_GEARS:
        columns = ()
        notes.append(_rpm_note(motors))
    rows = [("steps/s", *ticks, "on the wire", "ppm off"), *cells]
    first, *others = ((*row, *more) for row, *more in zip(rows, *columns, strict=True))
    caption = f"{together(motors, plan)}: rates"
    return Table(caption, first, tuple(others), "; ".join(notes), kind="numbers")


def _rpm_columns(rates: Rates, motors: Sequence[MotorPlan]) -> Iterator[Row]:
    """
    Yield the RPM of *rates* for each gear; its heading says which, unless all motors have that.
    """
    gears = dict.fromkeys(motor.steps_per_turn for motor in motors)
    for turn in gears:
        if turn:
            heading = f"RPM at {float(turn):.6g} a turn" if len(gears) > 1 else "RPM"
            yield (heading, *(f"{float(turns_per_minute(real, turn)):.5g}" for _, real in rates))


def _rpm_note(motors: Sequence[MotorPlan]) -> str:
    """
    Return the RPM of one step/s for each motor, where there are too many gears for columns.
    """
    each = (
        f"{motor.name} {float(turns_per_minute(Fraction(1), motor.steps_per_turn)):.5g}"
        for motor in motors
        if motor.steps_per_turn
    )
    return f"RPM for each step/s: {', '.join(each)}"


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

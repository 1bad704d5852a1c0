"""
The view of a motor with ramps: its table, and what the header says of its moves.
"""

from dataclasses import dataclass

from stepgen.library.prose import axis_start_comment, refusals, returns
from stepgen.library.sharing import Need
from stepgen.library.text import comment_lines
from stepgen.plan.curves import FRACTION
from stepgen.plan.ladder import Row
from stepgen.plan.model import MotorPlan, Plan


@dataclass(frozen=True)
class AxisView:
    """
    The ramp of one motor as C text, and sentences about it.
    """

    prefix: str
    queue: int
    first_interval: str
    cruise_interval: str
    cruise_height: str
    ramp: str
    rows: tuple[str, ...]
    row_count: str
    ramp_comment: tuple[str, ...]
    start_comment: tuple[str, ...]
    halt_comment: str
    queue_comment: str
    queue_returns: tuple[str, ...]
    run_comment: tuple[str, ...]
    speed_comment: tuple[str, ...]
    position_comment: tuple[str, ...]


def axis_view(motor: MotorPlan, need: Need | None, plan: Plan) -> AxisView | None:
    """
    Return what the templates print of the ramp of *motor* of *plan*; None if it has none.

    Motors whose rows are the same use the table of the first of them.
    """
    ladder = motor.motion.ladder
    if ladder is None:
        return None
    f_cpu_hz = plan.board.f_cpu_hz
    owner = next(
        other.name
        for other in plan.motors
        if other.motion.ladder and other.motion.ladder.rows == ladder.rows
    )
    cruise = motor.motion.cruise_interval_256
    cruise_sps = f_cpu_hz * FRACTION / cruise
    goal = ladder.goal(cruise)
    rows = f", as {owner}'s."
    if owner == motor.name:
        rows = (
            ". Row by row from the lowest speed on: the levels, the steps of each and how much "
            "shorter the interval is from one to the next."
        )
    speeds = ladder.speeds
    how = f"{float(speeds.acceleration):g} steps/s^2"
    if speeds.jerk is not None:
        how = f"up to {how}, which change by {float(speeds.jerk):g} steps/s^2 in a second"
    return AxisView(
        prefix=f"k{motor.name[0].upper()}{motor.name[1:]}",
        queue=motor.motion.queue,
        first_interval=f"{ladder.first_interval_256}UL",
        cruise_interval=f"{cruise}UL",
        cruise_height=str(goal),
        ramp=f"{owner}Ramp",
        rows=tuple(_row(row) for row in ladder.rows) if owner == motor.name else (),
        row_count=str(len(ladder.rows)),
        ramp_comment=comment_lines(
            f"From {float(speeds.start_sps):g} to {cruise_sps:.6g} steps/s at {how}: {goal} "
            f"steps{rows}"
        ),
        start_comment=axis_start_comment(motor, need, f_cpu_hz),
        halt_comment=" The coils go off." if motor.releases_at_rest else "",
        queue_comment=" The queue is emptied." if motor.motion.queue else "",
        queue_returns=_queue_comment(motor),
        run_comment=_run_comment(motor),
        speed_comment=comment_lines(
            "The speed at which it cruises, now and from now on, in 1/256 clocks between two "
            f"steps, such as motorInterval(500). The spec's {cruise_sps:.6g} steps/s is the "
            f"highest. {returns('MOTOR_ERROR_TOO_FAST', *_while_homing(motor))}"
        ),
        position_comment=comment_lines(
            "Gives the place where the motor is another number. "
            f"{returns('MOTOR_ERROR_RUNNING', *_beyond_range(motor))}"
        ),
    )


def _while_homing(motor: MotorPlan) -> tuple[str, ...]:
    return tuple(name for name in refusals(motor) if name == "MOTOR_ERROR_HOMING")


def _beyond_range(motor: MotorPlan) -> tuple[str, ...]:
    return tuple(name for name in refusals(motor) if name == "MOTOR_ERROR_RANGE")


def _has_range(motor: MotorPlan) -> bool:
    return bool(motor.end_stops and motor.end_stops.range)


def _queue_comment(motor: MotorPlan) -> tuple[str, ...]:
    endless = () if _has_range(motor) else ("MOTOR_ERROR_RUNNING behind a run without an end",)
    return comment_lines(
        "The same after the moves before it, each of which ends at rest; "
        f"{motor.motion.queue} can wait. "
        f"{returns(*refusals(motor), 'MOTOR_ERROR_QUEUE_FULL', *endless)}"
    )


def _run_comment(motor: MotorPlan) -> tuple[str, ...]:
    until = "Runs until something else is asked for"
    if _has_range(motor):
        until = "Runs to that end of its range, unless something else is asked for meanwhile"
    codes = (name for name in refusals(motor) if name != "MOTOR_ERROR_RANGE")
    return comment_lines(f"{until}. {returns(*codes)}")


def _row(row: Row) -> str:
    """
    Return *row* as an initialiser, and what it stands for.
    """
    shifts = row.slope_bytes << 4 | row.steps.bit_length() - 1
    return (
        f"{{{row.levels}, {shifts:#04x}, {row.slope}}},  "
        f"// {row.levels} x {row.steps}, {row.slope_256 / FRACTION:.6g} clocks"
    )

"""
How fast the examples of a library turn its motors.
"""

from dataclasses import dataclass
from fractions import Fraction

from stepgen.plan.model import MotorPlan, Plan
from stepgen.plan.rates import Clock
from stepgen.plan.speed_wishes import Wish, plan_wish
from stepgen.units import MILLISECONDS_PER_SECOND

_SPEED_SPS = 200  # slow enough for any motor, a 28BYJ-48 included

# A ramp goes up to twice that, from a quarter of it.
_FAST_SPS = 400
_RAMP_FACTOR = 4
_RAMP_SECONDS = 3


@dataclass(frozen=True)
class Ramp:
    """
    A change of speed by *count* update events, each *modification* I/O clocks, and back.
    """

    motor: str
    title: str
    slow_sps: int
    fast_sps: int
    slow_top: int
    fast_top: int
    modification: int
    interval_ms: int
    count: int


def example_speed_sps(plan: Plan) -> int:
    """
    Return the steps per second of the examples: 200, or the most that the library accepts.
    """
    return max(1, min(_SPEED_SPS, plan.board.f_cpu_hz // plan.minimum_period_cycles))


def example_ramp(motor: MotorPlan, plan: Plan) -> Ramp | None:
    """
    Return a ramp to 400 steps/s or the most that the library accepts; None if that is nearly none.
    """
    f_cpu_hz = plan.board.f_cpu_hz
    fast_sps = min(_FAST_SPS, f_cpu_hz // plan.minimum_period_cycles)
    slow_sps = fast_sps // _RAMP_FACTOR
    if not slow_sps:
        return None
    wish = Wish(
        f_cpu_hz // slow_sps,
        f_cpu_hz // fast_sps,
        duration_ms=Fraction(_RAMP_SECONDS * MILLISECONDS_PER_SECOND),
    )
    change = plan_wish(wish, Clock(f_cpu_hz))
    return Ramp(
        motor=motor.name,
        title=motor.name[0].upper() + motor.name[1:],
        slow_sps=slow_sps,
        fast_sps=fast_sps,
        slow_top=change.start_clocks,
        fast_top=change.end.virtual_clocks,
        modification=change.modification_clocks,
        interval_ms=change.interval_ms,
        count=change.count,
    )

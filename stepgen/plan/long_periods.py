"""
Periods of minutes: which motions can wait so long for a step, and what all motors must have then.
"""

from collections.abc import Sequence

from stepgen.plan.faults import Faults
from stepgen.plan.isr import Motion
from stepgen.plan.model import MotorPlan, TimerPlan

FIELD = "longest_period_s"


def report_impatience(timing: TimerPlan, motion: Motion, faults: Faults) -> None:
    """
    Report that clocks of *motion* need steps more often than *timing* may make them.
    """
    if motion.needs_steps and timing.has_long_periods:
        faults.at(FIELD).report(
            f"the clocks of {motion.kind} need a step each 16 s; remove it, or take "
            "`motion: constant` without `command_timeout_ms`"
        )


def report_unlike(motors: Sequence[MotorPlan], faults: Faults) -> None:
    """
    Report each of *motors* whose longest period is not that of all: they share MOTOR_MAX_TOP.
    """
    shortest = min(motors, key=lambda motor: motor.timing.largest_period_cycles)
    for motor in motors:
        if motor.timing.largest_period_cycles > shortest.timing.largest_period_cycles:
            faults.at("motors", motor.name, "timing", FIELD).report(
                f"the longest period holds for every motor, and that of {shortest.name} is "
                "shorter; give both the same, or remove it"
            )

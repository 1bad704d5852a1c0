"""
CTC: what fast PWM prints, with the compare match in place of the overflow.
"""

from dataclasses import replace

from stepgen.library.timings import fast_pwm
from stepgen.plan.model import MotorPlan


def view(motor: MotorPlan) -> fast_pwm.FastPwmView:
    """
    Return what the partial prints of the timer of *motor*.
    """
    n = motor.timing.timer.number
    return replace(
        fast_pwm.view(motor),
        tov=f"OCF{n}A",
        toie=f"OCIE{n}A",
        waiting="a match",
        mode_a="0",
        mode_b=f"_BV(WGM{n}2)",
    )

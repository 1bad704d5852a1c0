"""
Compare on a 16-bit timer for a motor with ramps: the same channel, and intervals in 1/256 clocks.
"""

from dataclasses import replace

from stepgen.library.timings import wide_compare
from stepgen.library.timings.wide_compare import WideCompareView
from stepgen.plan.curves import FRACTION
from stepgen.plan.model import MotorPlan


def view(motor: MotorPlan) -> WideCompareView:
    """
    Return what the partial prints of the channel of *motor*.
    """
    wake = motor.wake_cycles * FRACTION
    if wake and motor.motion.ladder:
        wake = max(wake, motor.motion.ladder.first_interval_256)
    return replace(
        wide_compare.view(motor),
        struct_prefix="",
        shared_by="ladder_compare",
        wake=f"{wake}UL" if wake else "",
    )

"""
Compare on a 16-bit timer with periods of minutes: the same channel, and more laps.
"""

from dataclasses import replace

from stepgen.library.timings import wide_compare
from stepgen.library.timings.wide_compare import WideCompareView
from stepgen.plan.model import MotorPlan


def view(motor: MotorPlan) -> WideCompareView:
    """
    Return what the partial prints of the channel of *motor*.
    """
    return replace(wide_compare.view(motor), struct_prefix="Long", shared_by="long_compare")

"""
Constant speed: the step interrupt needs no clock.
"""

from stepgen.plan.isr import Motion
from stepgen.spec.motions.constant import Constant


def plan(spec: Constant) -> Motion:
    """
    Return what the motion asks of the step interrupt.
    """
    return Motion(
        kind=spec.kind,
        watches_clock=False,
        handler_cycles=0,
        to_clock_cycles=0,
        thinking_cycles=0,
        limit_cycles=0,
        masked_cycles=285,
        setting_cycles=24,
    )

"""
Constant speed: the step interrupt needs no clock.
"""

from stepgen.plan.isr import Motion

MOTION = Motion(
    kind="constant",
    watches_clock=False,
    handler_cycles=0,
    to_clock_cycles=0,
    thinking_cycles=0,
    masked_cycles=235,
)

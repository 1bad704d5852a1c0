"""
Update events: each step compares the clock with the next moment at which something is due.
"""

from stepgen.plan.isr import Motion

MOTION = Motion(
    kind="update-events",
    watches_clock=True,
    handler_cycles=530,
    to_clock_cycles=21,
    thinking_cycles=74,
    masked_cycles=535,
)

"""
Update events: each step compares the clock with the next moment at which something is due.
"""

from stepgen.plan.isr import Motion

MOTION = Motion(
    kind="update-events",
    watches_clock=True,
    handler_cycles=540,
    to_clock_cycles=61,
    thinking_cycles=69,
    limit_cycles=40,
    masked_cycles=500,
)

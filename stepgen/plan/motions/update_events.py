"""
Update events: each step compares the clock with the next moment at which something is due.
"""

from stepgen.plan.isr import Motion
from stepgen.spec.motions.update_events import UpdateEvents


def plan(spec: UpdateEvents) -> Motion:
    """
    Return what the motion asks of the step interrupt.
    """
    return Motion(
        kind=spec.kind,
        watches_clock=True,
        handler_cycles=632,
        to_clock_cycles=53,
        thinking_cycles=59,
        limit_cycles=40,
        masked_cycles=520,
        dumps=spec.debug,
        setting_cycles=170,
        masked_setting_cycles=85,
    )

"""
Update events: each step compares the clock with the next moment at which something is due.
"""

from stepgen.plan.faults import Faults
from stepgen.plan.isr import Motion
from stepgen.plan.scale import Scale
from stepgen.spec import Motor
from stepgen.spec.motions.update_events import UpdateEvents

_TIMED_CYCLES = 60
# With a time-out each step looks at the clock, and the handler once more: between what the two
# compilers take, which is ten cycles apart.
_TIMED_LOOK_CYCLES = 24
_TIMED_CALL_CYCLES = 30


def plan(
    spec: UpdateEvents,
    motor: Motor,
    _scale: Scale,
    _f_cpu_hz: int,
    _faults: Faults,
) -> Motion:
    """
    Return what the motion asks of the step interrupt.
    """
    timed = motor.command_timeout_ms is not None
    return Motion(
        kind=spec.kind,
        watches_clock=True,
        changes_speed=True,
        handler_cycles=634 + (_TIMED_CYCLES if timed else 0),
        to_clock_cycles=53 + (_TIMED_LOOK_CYCLES if timed else 0),
        thinking_cycles=59 + (_TIMED_LOOK_CYCLES if timed else 0),
        limit_cycles=40,
        masked_cycles=520 + (_TIMED_CALL_CYCLES if timed else 0),
        dumps=spec.debug,
        setting_cycles=157,
        masked_setting_cycles=75,
    )

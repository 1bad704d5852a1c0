"""
Constant speed: the step interrupt needs no clock but for a command time-out.
"""

from stepgen.plan.faults import Faults
from stepgen.plan.isr import Motion
from stepgen.plan.scale import Scale
from stepgen.spec import Motor
from stepgen.spec.motions.constant import Constant

_TIMED_CYCLES = 4  # of the handler: IN or LDS, TST and BREQ
_TIMED_CALL_CYCLES = 20


def plan(spec: Constant, motor: Motor, _scale: Scale, _f_cpu_hz: int, _faults: Faults) -> Motion:
    """
    Return what the motion asks of the step interrupt.
    """
    timed = motor.command_timeout_ms is not None
    return Motion(
        kind=spec.kind,
        watches_clock=timed,
        handler_cycles=_TIMED_CYCLES if timed else 0,
        to_clock_cycles=_TIMED_CYCLES if timed else 0,
        thinking_cycles=_TIMED_CYCLES if timed else 0,
        limit_cycles=0,
        masked_cycles=285 + (_TIMED_CALL_CYCLES if timed else 0),
        can_go_on=not timed,
        setting_cycles=24,
        needs_steps=timed,
    )

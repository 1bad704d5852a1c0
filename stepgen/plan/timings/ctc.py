"""
CTC, mode 4: TOP is OCRnA, which a write changes at once; compare match A makes the steps.

A write while the counter is past the new TOP would cost a whole lap of 65536 ticks. So OCRnA is
written in the interrupt of a step only, just after the counter began again from 0, and what it has
passed by then is seen and made up for.

Source: ATmega328P datasheet, 16-bit Timer/Counter1, Clear Timer on Compare Match (CTC) Mode.
"""

from dataclasses import replace

from stepgen.devices import Board, Timer16
from stepgen.plan.faults import Faults
from stepgen.plan.model import Left, TimerPlan
from stepgen.plan.timings import fast_pwm
from stepgen.plan.timings.fast_pwm import cadence, choose_setting, gate, way_out
from stepgen.spec.timings.ctc import Ctc

__all__ = ["cadence", "choose_setting", "gate", "plan", "way_out"]


def plan(spec: Ctc, board: Board, left: Left, faults: Faults) -> TimerPlan | None:
    """
    Return the 16-bit timer that *spec* asks for, or the first of the *free* ones.
    """
    found = fast_pwm.plan_wide(spec.kind, spec.timer, board, left.free, faults)
    if found is None or not isinstance(found.timer, Timer16):
        return None
    return replace(
        found,
        vector=found.timer.compa.name,
        event="compare match A",
        instant="the match",
    )

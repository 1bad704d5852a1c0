"""
Compare on a 16-bit timer for a motor with ramps: intervals have a fraction and change by rows.

It is `stepgen.plan.timings.wide_compare` with another step interrupt.
"""

from stepgen.devices import Mcu
from stepgen.plan.instructions import Gate, Storage
from stepgen.plan.isr import Motion
from stepgen.plan.ladder_isr import ladder_gate
from stepgen.plan.model import TimerPlan
from stepgen.plan.timings.wide_compare import cadence, choose_setting, way_out

__all__ = ["cadence", "choose_setting", "gate", "way_out"]


def gate(timing: TimerPlan, _motion: Motion, storage: Storage, _mcu: Mcu) -> Gate:
    """
    Return how the interrupt sets its compare register, and what it does about laps and levels.
    """
    return ladder_gate(timing, storage)

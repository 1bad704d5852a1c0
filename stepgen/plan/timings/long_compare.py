"""
Compare on a 16-bit timer with periods of minutes: laps are counted in 24 bits, and limits by laps.

It is `stepgen.plan.timings.wide_compare` with longer numbers: 2**24 laps are 4.7 hours at 16 MHz.
A limit in milliseconds is compared with the lower half of millis(), which must be looked at each
32 s, so that an interrupt that ends a lap looks, too.
"""

from stepgen.devices import Mcu
from stepgen.plan.instructions import Gate, Storage
from stepgen.plan.isr import Motion
from stepgen.plan.model import TimerPlan
from stepgen.plan.timings.wide_compare import cadence, choose_setting, way_out
from stepgen.plan.wide_gate import wide_gate

__all__ = ["cadence", "choose_setting", "gate", "way_out"]

_LAP_BYTES = 3


def gate(timing: TimerPlan, motion: Motion, storage: Storage, _mcu: Mcu) -> Gate:
    """
    Return how the interrupt sets its compare register, and what it does about laps.
    """
    return wide_gate(timing, motion, storage, _LAP_BYTES)

"""
Compare on a 16-bit timer: registers and bits of a motor's compare channel.
"""

from dataclasses import dataclass

from stepgen.devices import Timer16
from stepgen.plan.model import MotorPlan
from stepgen.plan.timings.wide_compare import (
    LAP_CYCLES,
    LONGEST_SINGLE_CYCLES,
    LONGEST_WAIT_CYCLES,
)


@dataclass(frozen=True)
class WideCompareView:
    """
    Names of a timer's registers and of the bits of one channel.

    Args:
        clock: Selects the CPU's clock.
        longest_wait: How many clocks its interrupt may wait without harm.
    """

    number: int
    struct_prefix: str
    shared_by: str
    tccra: str
    tccrb: str
    tcnt: str
    ocr: str
    timsk: str
    tifr: str
    ocf: str
    ocie: str
    clock: str
    longest_wait: int
    wake: str
    elapsed_type: str = ""  # nothing sets this timer anew


def view(motor: MotorPlan) -> WideCompareView:
    """
    Return what the partial prints of the channel of *motor*.

    Raises:
        TypeError: Its timer has not 16 bits.
    """
    timer, channel = motor.timing.timer, motor.timing.channel
    n = timer.number
    if not isinstance(timer, Timer16):
        raise TypeError(f"timer {n} has not 16 bits")
    return WideCompareView(
        number=n,
        struct_prefix="Wide",
        shared_by="wide_compare",
        tccra=timer.tccra.name,
        tccrb=timer.tccrb.name,
        tcnt=timer.tcnt.name,
        ocr=timer.compare_channels[channel][0].name,
        timsk=timer.timsk.name,
        tifr=timer.tifr.name,
        ocf=f"OCF{n}{channel}",
        ocie=f"OCIE{n}{channel}",
        clock=f"CS{n}0",
        longest_wait=LONGEST_WAIT_CYCLES,
        wake=_wake(motor.wake_cycles),
    )


def _wake(cycles: int) -> str:
    """
    Return an interval of *cycles* as an initialiser, like chooseSpan(); empty if there is none.
    """
    if not cycles:
        return ""
    if cycles <= LONGEST_SINGLE_CYCLES:
        return f"{{{cycles}, 0}}"
    laps, rest = divmod(cycles, LAP_CYCLES)
    return f"{{{rest + LAP_CYCLES}, {laps - 1}}}"

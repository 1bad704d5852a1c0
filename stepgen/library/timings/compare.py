"""
Compare: registers and bits of the timer that runs through.
"""

from dataclasses import dataclass

from stepgen.plan.model import MotorPlan
from stepgen.plan.timings.compare import LONGEST_OVERRUN_CYCLES, LONGEST_WAIT_CYCLES, PRESCALER


@dataclass(frozen=True)
class CompareView:
    """
    Names of a timer's registers and bits.

    Args:
        clock: Selects the prescaler of 8.
        longest_wait: How many clocks its interrupt may wait without harm.
        longest_overrun: How many at most for an overrun to be seen and served.
    """

    number: int
    struct_prefix: str
    shared_by: str
    tccra: str
    tccrb: str
    tcnt: str
    ocra: str
    timsk: str
    tifr: str
    ocf: str
    ocie: str
    clock: str
    longest_wait: int
    longest_overrun: int
    wake: str
    elapsed_type: str = ""  # nothing sets this timer anew


def view(motor: MotorPlan) -> CompareView:
    """
    Return what the partial prints of the timer of *motor*.
    """
    timer = motor.timing.timer
    n = timer.number
    return CompareView(
        number=n,
        struct_prefix="Compare",
        shared_by="compare",
        tccra=timer.tccra.name,
        tccrb=timer.tccrb.name,
        tcnt=timer.tcnt.name,
        ocra=timer.ocra.name,
        timsk=timer.timsk.name,
        tifr=timer.tifr.name,
        ocf=f"OCF{n}A",
        ocie=f"OCIE{n}A",
        clock=f"CS{n}1",
        longest_wait=LONGEST_WAIT_CYCLES,
        longest_overrun=LONGEST_OVERRUN_CYCLES,
        wake=_wake(motor.wake_cycles),
    )


def _wake(cycles: int) -> str:
    """
    Return an interval of *cycles* as an initialiser, like chooseInterval(); empty if there is none.
    """
    if not cycles:
        return ""
    laps, rest = divmod(cycles // PRESCALER, 256)
    first = rest // 2 + 128
    return f"{{{first}, {(rest - first) % 256}, {laps % 256}, {(laps - 1) // 256}}}"

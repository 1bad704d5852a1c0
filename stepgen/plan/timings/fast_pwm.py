"""
Fast PWM, mode 15: TOP is OCRnA, double-buffered; the overflow interrupt makes the steps.

Source: ATmega328P datasheet, 16-bit Timer/Counter1, Fast PWM mode; system 1, chapter 6.
"""

from stepgen.devices import Board, Timer16
from stepgen.plan.faults import Faults
from stepgen.plan.model import Setting, TimerPlan
from stepgen.spec.timings.fast_pwm import FastPwm

PRESCALERS = (1, 8, 64, 256, 1024)
LARGEST_TICKS = 65_535
LARGEST_PERIOD_CYCLES = LARGEST_TICKS * PRESCALERS[-1]


def plan(spec: FastPwm, board: Board, free: tuple[int, ...], faults: Faults) -> TimerPlan | None:
    """
    Return the 16-bit timer that *spec* asks for, or the first of the *free* ones.
    """
    timers = [timer.number for timer in board.mcu.timers16]
    names = " or ".join(str(number) for number in timers)
    if spec.timer is None and not free:
        faults.report(
            f"the {board.title} has no 16-bit timer left for this motor ({names}); "
            "remove a motor or a library from `uses`, or take a larger board"
        )
        return None
    number = free[0] if spec.timer is None else spec.timer
    timer = board.mcu.timer16(number)
    if timer is None:
        faults.at("timer").report(
            f"the {board.title} has no 16-bit timer {number}; fast PWM runs on timer {names}"
        )
        return None
    return TimerPlan(spec.kind, timer, vector(timer))


def vector(timer: Timer16) -> str:
    """
    Return the name of the interrupt that makes the steps.
    """
    return timer.ovf.name


def choose_setting(period_cycles: int) -> Setting:
    """
    Return the finest timer setting whose period is at most *period_cycles*.

    The smallest prescaler p with period_cycles // p < 65536 gives the finest period:
    p * (TOP + 1), TOP = period_cycles // p - 1.

    Args:
        period_cycles: Wanted time between two steps, in I/O clocks, 2 or more.

    Raises:
        ValueError: Longer than 65535 * 1024 clocks (4.19 s at 16 MHz), or below 2.
    """
    if not 2 <= period_cycles <= LARGEST_PERIOD_CYCLES:  # noqa: PLR2004 - TOP is at least 1
        raise ValueError(f"{period_cycles} cycles are not within 2 to {LARGEST_PERIOD_CYCLES}")
    prescaler = next(p for p in PRESCALERS if period_cycles // p <= LARGEST_TICKS)
    return Setting(prescaler, period_cycles // prescaler - 1)

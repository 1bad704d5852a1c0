"""
Fast PWM, mode 15: TOP is OCRnA, double-buffered; the overflow interrupt makes the steps.

Source: ATmega328P datasheet, 16-bit Timer/Counter1, Fast PWM mode; system 1, chapter 6.
"""

from stepgen.devices import Board, Mcu
from stepgen.plan.faults import Faults
from stepgen.plan.instructions import Gate, Storage
from stepgen.plan.isr import Motion
from stepgen.plan.model import Cadence, Left, MotorPlan, Setting, TimerPlan
from stepgen.plan.timings import compare
from stepgen.spec.timings.fast_pwm import FastPwm

SMALLEST_PERIOD_CYCLES = 640  # system 1: 25 000 steps/s at 16 MHz
_FLAG_CYCLES = 5  # the longest response of an interrupt, which clears its flag
PRESCALERS = (1, 8, 64, 256, 1024)
LARGEST_TICKS = 65_535
LARGEST_PERIOD_CYCLES = LARGEST_TICKS * PRESCALERS[-1]


def plan(spec: FastPwm, board: Board, left: Left, faults: Faults) -> TimerPlan | None:
    """
    Return the 16-bit timer that *spec* asks for, or the first of those *left*.
    """
    return plan_wide(spec.kind, spec.timer, board, left.free, faults)


def plan_wide(
    kind: str, wanted: int | None, board: Board, free: tuple[int, ...], faults: Faults
) -> TimerPlan | None:
    """
    Return the 16-bit timer *wanted* for the timing *kind*, or the first of the *free* ones.
    """
    timers = [timer.number for timer in board.mcu.timers16]
    names = " or ".join(str(number) for number in timers)
    wide = _wide(board, free)
    if wanted is None and not wide:
        faults.report(
            f"the {board.title} has no 16-bit timer left for this motor ({names}); "
            f"take {compare.offer(board, free)}a larger board, or remove a motor or a library "
            "from `uses`"
        )
        return None
    number = wide[0] if wanted is None else wanted
    timer = board.mcu.timer16(number)
    if timer is None:
        faults.at("timer").report(
            f"the {board.title} has no 16-bit timer {number}; {kind} runs on timer {names}"
        )
        return None
    return TimerPlan(
        kind=kind,
        timer=timer,
        vector=timer.ovf.name,
        event="overflow",
        instant="the timer wraps",
        smallest_period_cycles=SMALLEST_PERIOD_CYCLES,
        largest_period_cycles=LARGEST_PERIOD_CYCLES,
    )


def way_out(board: Board, free: tuple[int, ...]) -> str:
    """
    Return what a motor can take in place of its timer; *free* are those left.
    """
    wide = _wide(board, free)
    if wide:
        return f"take timer {' or '.join(str(number) for number in wide)}"
    return (
        f"take {compare.offer(board, free)}a larger board, since no other 16-bit timer is left on "
        "this one"
    )


def _wide(board: Board, free: tuple[int, ...]) -> list[int]:
    return [number for number in free if board.mcu.timer16(number)]


def gate(_timing: TimerPlan, _motion: Motion, _storage: Storage, _mcu: Mcu) -> Gate:
    """
    Return no gate: each interrupt is a step.
    """
    return Gate()


def cadence(period_cycles: int) -> Cadence:
    """
    Return how an overflow comes and waits at *period_cycles* between steps.

    The timer keeps one overflow that waits, not two: each must be taken, and its flag cleared by
    the chip's response, before the next.
    """
    return Cadence(period_cycles, period_cycles - _FLAG_CYCLES)


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


def elapsed_cycles(motor: MotorPlan) -> tuple[int, ...]:
    """
    Return the cycles from a due step until the boundary handler has set the timer anew.

    Then the same where the handler looked at the clock and made the step itself; then both
    with a limit in milliseconds, for a motion that takes longer with one.
    """
    handler, motion = motor.kernel.handler, motor.motion
    usual = motor.hot_path.boundary_entry_cycles + handler.to_clock + motion.to_clock_cycles
    woken = motor.hot_path.think_entry_cycles + handler.to_clock_thinking
    both = (usual, woken + motion.thinking_cycles)
    limited = tuple(cycles + motion.limit_cycles for cycles in both)
    return both + limited if motion.limit_cycles else both

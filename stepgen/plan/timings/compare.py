"""
Compare: timer 2 runs through with a prescaler of 8, and compare channel A counts its laps.

What it is on a 16-bit timer says `stepgen.plan.timings.wide_compare`.

The timer is started when the motor starts, and neither stopped nor set before it rests: a change
of speed is one of numbers only. An interval of n ticks is first + 256 * laps + last, where first
and last are half of what exceeds the laps, each 128 to 256. At a step OCR2A goes on by *first*;
then each compare match is one lap; after the last of them OCR2A goes on by *last*, to the step.
So each move leaves 128 ticks until the next match, and the interrupt that makes it may come
almost as late without missing it.

An interrupt that comes later sees how late by the counter: TCNT2 less where OCR2A still is. Where
the counter has passed the next match, that one will come a lap late, and is served at once in its
place: a lap by counting one less, a step by making it. So no deadline moves. That holds as long
as the counter is not round, since 8 bits tell no more: each flag of the timer is set within a lap
of the interrupt before, so none of them tells a second lap from the first.

Source: ATmega328P datasheet, "8-bit Timer/Counter2 with PWM and Asynchronous Operation", Normal
Mode and Output Compare Unit.
"""

from stepgen.devices import Board, Mcu, Timer8
from stepgen.plan import compare_gate
from stepgen.plan.compare_gate import PRESCALER
from stepgen.plan.faults import Faults
from stepgen.plan.instructions import Gate, Storage
from stepgen.plan.isr import Motion
from stepgen.plan.model import Cadence, Left, Setting, TimerPlan
from stepgen.plan.timings import wide_compare
from stepgen.spec.timings.compare import Compare

__all__ = ["PRESCALER", "cadence", "choose_setting", "gate", "offer", "plan", "way_out"]

LAP_CYCLES = 256 * PRESCALER
NEAREST_MATCH_CYCLES = 128 * PRESCALER
_MOVE_CYCLES = 46  # from the response until OCR2A is written, at most, with a little to spare
LONGEST_WAIT_CYCLES = NEAREST_MATCH_CYCLES - PRESCALER - _MOVE_CYCLES
"""How long an interrupt may be held up: 970 cycles."""
_LONGEST_RESCUE_CYCLES = 148  # from the response until OCR2A is right again, with some to spare
LONGEST_OVERRUN_CYCLES = LAP_CYCLES - _LONGEST_RESCUE_CYCLES
"""How long it may be held up for its overrun to be seen and served: 1900 cycles."""

SMALLEST_PERIOD_CYCLES = LAP_CYCLES
LARGEST_PERIOD_CYCLES = 65_535 * 1024  # that of fast PWM, so that a sketch can change over


def plan(spec: Compare, board: Board, left: Left, faults: Faults) -> TimerPlan | None:
    """
    Return the timer that *spec* asks for, or of those *left* timer 2, or a 16-bit one.
    """
    narrow = [timer.number for timer in board.mcu.timers8]
    wanted = spec.timer
    if wanted is None:
        free = [number for number in narrow if number in left.free]
        wanted = next(iter((*free, *wide_compare.with_channels(board, left), *narrow)), None)
    timer = None if wanted is None else board.mcu.timer8(wanted)
    if timer is None:
        return wide_compare.plan_wide(spec, wanted, board, left, faults)
    if spec.channel not in {None, "A"}:
        faults.at("channel").report(
            f"timer {timer.number} makes the steps of one motor, with channel A; take `channel: A`"
        )
        return None
    if spec.longest_period_s is not None:
        faults.at("longest_period_s").report(
            f"timer {timer.number} has 8 bits and a step in 4.19 s at least; take a 16-bit timer, "
            "such as `timer: 1`"
        )
        return None
    return TimerPlan(
        kind=spec.kind,
        timer=timer,
        vector=timer.compa.name,
        event="compare match A",
        instant="the match",
        smallest_period_cycles=SMALLEST_PERIOD_CYCLES,
        largest_period_cycles=LARGEST_PERIOD_CYCLES,
        rule=(
            f"There can be no tone(), which needs timer {timer.number} too. Its interrupt may be "
            f"held up for {LONGEST_WAIT_CYCLES} clocks in all, by calls of the library, other "
            "interrupts and stretches with interrupts off. A step that waits longer is made late "
            "and counted, MOTOR_STAT_MISSED is set, and the next one is on time again; but after "
            f"more than {LONGEST_OVERRUN_CYCLES} clocks a step and all that follow it can come "
            f"{LAP_CYCLES} clocks late, and nothing tells."
        ),
        is_set_anew=False,
    )


def offer(board: Board, free: tuple[int, ...]) -> str:
    """
    Return words that offer this timing where its timer is *free*, followed by "or"; else "".
    """
    numbers = [timer.number for timer in board.mcu.timers8 if timer.number in free]
    return f"`timing: {{kind: compare, timer: {numbers[0]}}}` or " if numbers else ""


def way_out(board: Board, free: tuple[int, ...]) -> str:
    """
    Return what a motor can take in place of its timer: one of those that are *free* and wide.
    """
    numbers = [str(number) for number in free if board.mcu.timer16(number)]
    if numbers:
        return f"take `timing: fast-pwm` on timer {' or '.join(numbers)}"
    return "take a larger board, since no other timer is left on this one"


def gate(timing: TimerPlan, _motion: Motion, storage: Storage, mcu: Mcu) -> Gate:
    """
    Return the count of laps, which each interrupt passes on its way to the step.
    """
    if not isinstance(timing.timer, Timer8):
        raise TypeError(f"timer {timing.timer.number} has not 8 bits")
    return compare_gate.gate(timing.timer, storage, mcu)


def cadence(_period_cycles: int) -> Cadence:
    """
    Return how a match comes and waits: the same at every speed.

    The interrupt of a match sets the next one, 128 ticks on at least, and must have moved OCR2A a
    tick before the timer is there. Each counts as a step, though a lap's interrupt is short.
    """
    return Cadence(NEAREST_MATCH_CYCLES, LONGEST_WAIT_CYCLES)


def choose_setting(period_cycles: int) -> Setting:
    """
    Return the ticks of *period_cycles*, cut off to whole ones; they may be many laps of the timer.
    """
    return Setting(PRESCALER, period_cycles // PRESCALER - 1)

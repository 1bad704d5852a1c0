"""
Compare: timer 2 runs through with a prescaler of 8, and compare channel A counts its laps.

The timer is started when the motor starts, and neither stopped nor set before it rests: a change
of speed is one of numbers only. An interval of n ticks is first + 256 * laps + last, where first
and last are half of what exceeds the laps, each 128 to 256. At a step OCR2A goes on by *first*;
then each compare match is one lap; after the last of them OCR2A goes on by *last*, to the step.
So each move leaves 128 ticks until the next match, and the interrupt that makes it may come
almost as late without missing it.

Source: ATmega328P datasheet, "8-bit Timer/Counter2 with PWM and Asynchronous Operation", Normal
Mode and Output Compare Unit.
"""

from stepgen.devices import Board, Mcu, Timer8
from stepgen.plan.faults import Faults
from stepgen.plan.instructions import Gate, Instruction, Storage
from stepgen.plan.model import Cadence, TimerPlan
from stepgen.spec.timings.compare import Compare

PRESCALER = 8
LAP_CYCLES = 256 * PRESCALER
NEAREST_MATCH_CYCLES = 128 * PRESCALER
_MOVE_CYCLES = 46  # from the response until OCR2A is written, at most, with a little to spare
LONGEST_WAIT_CYCLES = NEAREST_MATCH_CYCLES - PRESCALER - _MOVE_CYCLES
"""How long an interrupt may be held up: 970 cycles."""

SMALLEST_PERIOD_CYCLES = LAP_CYCLES
LARGEST_PERIOD_CYCLES = 65_535 * 1024  # that of fast PWM, so that a sketch can change over


def plan(spec: Compare, board: Board, free: tuple[int, ...], faults: Faults) -> TimerPlan | None:
    """
    Return the 8-bit timer that *spec* asks for, or the first of the *free* ones.
    """
    timers = [timer.number for timer in board.mcu.timers8]
    names = " or ".join(str(number) for number in timers)
    narrow = [number for number in free if number in timers]
    number = next(iter((*narrow, *timers)), None) if spec.timer is None else spec.timer
    timer = None if number is None else board.mcu.timer8(number)
    if timer is None:
        faults.at("timer").report(
            f"compare does not run on timer {number} of the {board.title}, only on timer {names}"
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
            "interrupts and stretches with interrupts off; after a longer one a step and all that "
            f"follow it come {LAP_CYCLES} clocks late."
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


def gate(timer: Timer8, storage: Storage, mcu: Mcu) -> Gate:
    """
    Return the count of laps, which each interrupt passes on its way to the step.
    """
    count = (
        Instruction("lds   r24, %[laps]", 2, "one compare match less of this interval"),
        Instruction("dec   r24", 1),
        Instruction("sts   %[laps], r24", 2),
        Instruction("breq  6f", 1),
    )
    leave = (
        Instruction(
            storage.scratch.load("r24", "scratch").text, 1, "a lap, and no step yet", label="5"
        ),
        Instruction("out   %[sreg], r24", 1),
        Instruction("pop   r24", 2),
        Instruction("reti", mcu.response_cycles),
    )
    high = (
        Instruction("lds   r24, %[lapsHigh]", 2, "256 laps less,", label="6"),
        Instruction("dec   r24", 1),
        Instruction("sts   %[lapsHigh], r24", 2),
        Instruction("brpl  5b", 1, "which are still to come; or"),
        Instruction("sbrs  r24, 0", 1, "255: this is the last lap,"),
        Instruction("rjmp  7f", 2, "254: the step after it"),
    )
    last = (
        Instruction("ldi   r24, 1", 1),
        Instruction("sts   %[laps], r24", 2, "the next match is the step"),
        *_advance("last", "ticks from the last lap to the step"),
        Instruction("rjmp  5b", 2),
    )
    step = (
        *_advance("first", "ticks from this step to the first lap", label="7"),
        *_copy("nextLast", "last", "the interval that begins now"),
        *_copy("nextLaps", "laps"),
        *_copy("nextLapsHigh", "lapsHigh"),
    )
    until_high = _cycles(count) + 1  # the branch is taken
    return Gate(
        instructions=(*count, *leave, *high, *last, *step),
        step_cycles=until_high + _cycles(high) + _cycles(step),
        lap_cycles=(
            _cycles(count) + _cycles(leave),
            until_high + _cycles(high) - 1 + _cycles(last) + _cycles(leave),
        ),
        registers=(("ocr", timer.ocra),),
        fields=(
            ("laps", "now.laps"),
            ("lapsHigh", "now.lapsHigh"),
            ("last", "now.last"),
            ("first", "next.first"),
            ("nextLaps", "next.laps"),
            ("nextLapsHigh", "next.lapsHigh"),
            ("nextLast", "next.last"),
        ),
    )


def _advance(ticks: str, note: str, label: str = "") -> tuple[Instruction, ...]:
    return (
        Instruction("push  r25", 2, label=label),
        Instruction("lds   r24, %[ocr]", 2),
        Instruction(f"lds   r25, %[{ticks}]", 2, note),
        Instruction("add   r24, r25", 1),
        Instruction("sts   %[ocr], r24", 2),
        Instruction("pop   r25", 2),
    )


def _copy(source: str, target: str, note: str = "") -> tuple[Instruction, ...]:
    return (
        Instruction(f"lds   r24, %[{source}]", 2, note),
        Instruction(f"sts   %[{target}], r24", 2),
    )


def _cycles(instructions: tuple[Instruction, ...]) -> int:
    return sum(instruction.cycles for instruction in instructions)


def cadence(_period_cycles: int) -> Cadence:
    """
    Return how a match comes and waits: the same at every speed.

    The interrupt of a match sets the next one, 128 ticks on at least, and must have moved OCR2A a
    tick before the timer is there. Each counts as a step, though a lap's interrupt is short.
    """
    return Cadence(NEAREST_MATCH_CYCLES, LONGEST_WAIT_CYCLES)

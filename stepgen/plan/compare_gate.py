"""
The way to the step of timing compare: the count of laps, and what is late served at once.

Source: ATmega328P datasheet, "8-bit Timer/Counter2 with PWM and Asynchronous Operation": the
comparator works all the time, and sets OCF2A with the tick after TCNT2 has become OCR2A.
"""

from stepgen.devices import Mcu, Timer8
from stepgen.plan.instructions import Gate, Instruction, Storage
from stepgen.plan.instructions import total_cycles as cycles

PRESCALER = 8
_LATE_TICKS = 127  # the next match is 128 ticks after this one, or more; OCR2A must be moved before
_FIELDS = (
    ("laps", "now.laps"),
    ("lapsHigh", "now.lapsHigh"),
    ("last", "now.last"),
    ("first", "next.first"),
    ("nextLaps", "next.laps"),
    ("nextLapsHigh", "next.lapsHigh"),
    ("nextLast", "next.last"),
    ("missed", "missed"),
    ("status", "status"),
)


def gate(timer: Timer8, storage: Storage, mcu: Mcu) -> Gate:
    """
    Return the count of laps, which each interrupt passes on its way to the step.
    """
    count, leave, high, last, step = _count(), _leave(storage, mcu), _high(), _last(), _step()
    late_last, late_step = _late_last(), _late_step()
    until_high = cycles(count) + 1  # the branch is taken
    until_step = until_high + cycles(high)
    until_last = until_step - 1
    until_read = until_step + cycles(step[:2]) + 1  # LDS reads in its second cycle
    # The longest way: a step that is made in place of the last lap, so late that a lap has passed.
    seen_late = cycles(_lateness("")) + 1
    both_late = cycles(late_last) + seen_late + cycles(late_step) + cycles(step[-2:])
    latest = until_last + cycles(last[:2]) + seen_late + both_late
    return Gate(
        instructions=(*count, *leave, *high, *last, *late_last, *late_step, *step),
        step_cycles=until_step + cycles(step),
        lap_cycles=(
            cycles(count) + cycles(leave),
            until_last + cycles(last) + cycles(leave),
        ),
        late_cycles=latest - until_step - cycles(step),
        overrun_cycles=(_LATE_TICKS - 1) * PRESCALER - until_read,
        tells_missed=True,
        registers=(("ocr", timer.ocra), ("tcnt", timer.tcnt), ("tifr", timer.tifr)),
        fields=_FIELDS,
        constants=(("match", f"_BV(OCF{timer.number}A)"), ("statMissed", "MOTOR_STAT_MISSED")),
    )


def _count() -> tuple[Instruction, ...]:
    return (
        Instruction("lds   r24, %[laps]", 2, "one compare match less of this interval"),
        Instruction("dec   r24", 1),
        Instruction("sts   %[laps], r24", 2),
        Instruction("breq  6f", 1),
    )


def _leave(storage: Storage, mcu: Mcu) -> tuple[Instruction, ...]:
    return (
        Instruction(
            storage.scratch.load("r24", "scratch").text, 1, "a lap, and no step yet", label="5"
        ),
        Instruction("out   %[sreg], r24", 1),
        Instruction("pop   r24", 2),
        Instruction("reti", mcu.response_cycles),
    )


def _high() -> tuple[Instruction, ...]:
    return (
        Instruction("lds   r24, %[lapsHigh]", 2, "256 laps less,", label="6"),
        Instruction("dec   r24", 1),
        Instruction("sts   %[lapsHigh], r24", 2),
        Instruction("brpl  5b", 1, "which are still to come; or"),
        Instruction("sbrs  r24, 0", 1, "255: this is the last lap,"),
        Instruction("rjmp  7f", 2, "254: the step after it"),
    )


def _last() -> tuple[Instruction, ...]:
    return (
        Instruction("ldi   r24, 1", 1),
        Instruction("sts   %[laps], r24", 2, "the next match is the step"),
        *_lateness("8f"),
        *_move("last", "ticks from the last lap to the step"),
        Instruction("pop   r25", 2),
        Instruction("rjmp  5b", 2),
    )


def _step() -> tuple[Instruction, ...]:
    return (
        *_lateness("9b", label="7"),
        *_move("first", "ticks from this step to the first lap"),
        *_copy("nextLast", "last", "the interval that begins now", label="10"),
        *_copy("nextLaps", "laps"),
        Instruction("lds   r24, %[nextLapsHigh]", 2),
        Instruction("sts   %[lapsHigh], r24", 2, label="11"),
        Instruction("pop   r25", 2),
    )


def _lateness(late: str, label: str = "") -> tuple[Instruction, ...]:
    return (
        Instruction("push  r25", 2, label=label),
        Instruction("lds   r24, %[ocr]", 2),
        Instruction("lds   r25, %[tcnt]", 2),
        Instruction("sub   r25, r24", 1, "ticks since the match: one more,"),
        Instruction(f"cpi   r25, {_LATE_TICKS}", 1, "and the next could be missed"),
        Instruction(f"brsh  {late}", 1),
    )


def _move(ticks: str, note: str, label: str = "") -> tuple[Instruction, ...]:
    return (
        Instruction(f"lds   r25, %[{ticks}]", 2, note, label=label),
        Instruction("add   r24, r25", 1),
        Instruction("sts   %[ocr], r24", 2),
    )


def _since() -> tuple[Instruction, ...]:
    """
    Return the ticks since the match in r25, where r24 is that match: read after OCR2A has moved.
    """
    return (Instruction("lds   r25, %[tcnt]", 2), Instruction("sub   r25, r24", 1))


def _forget_match() -> tuple[Instruction, ...]:
    """
    Return what drops the match that is served by hand, if it came just after OCR2A had moved.
    """
    return (
        Instruction("ldi   r24, %[match]", 1),
        Instruction("out   %[tifr], r24", 1, "served here, once"),
    )


def _late_last() -> tuple[Instruction, ...]:
    """
    Return what follows the last lap if it is late: a step that the counter has passed is made now.
    """
    return (
        *_move("last", "the last lap is late:", label="8"),
        Instruction("sub   r24, r25", 1),
        *_since(),
        Instruction("lds   r24, %[last]", 2, "is the counter past the step?"),
        Instruction("dec   r24", 1, "0 stands for 256"),
        Instruction("dec   r25", 1),
        Instruction("cp    r24, r25", 1),
        Instruction("pop   r25", 2),
        Instruction("brsh  5b", 1, "no: it will come"),
        *_forget_match(),
        Instruction("rjmp  7f", 2),
    )


def _late_step() -> tuple[Instruction, ...]:
    """
    Return what follows a step that is too late: it counts, and so does a lap that has passed.
    """
    return (
        *_move("first", "the step is too late:", label="9"),
        Instruction("sub   r24, r25", 1),
        Instruction("lds   r25, %[missed]", 2, "count it"),
        Instruction("subi  r25, 0xff", 1),
        Instruction("sts   %[missed], r25", 2),
        Instruction("lds   r25, %[missed] + 1", 2),
        Instruction("sbci  r25, 0xff", 1),
        Instruction("sts   %[missed] + 1, r25", 2),
        Instruction("lds   r25, %[status]", 2, "and tell"),
        Instruction("ori   r25, %[statMissed]", 1),
        Instruction("sts   %[status], r25", 2),
        *_since(),
        Instruction("lds   r24, %[first]", 2, "is the counter past the first lap?"),
        Instruction("cp    r24, r25", 1),
        Instruction("brsh  10f", 1, "no: it will come"),
        *_forget_match(),
        *_copy("nextLast", "last", "the interval that begins now, a lap less"),
        Instruction("lds   r24, %[nextLaps]", 2),
        Instruction("dec   r24", 1),
        Instruction("sts   %[laps], r24", 2),
        Instruction("lds   r24, %[nextLapsHigh]", 2),
        Instruction("brne  11f", 1),
        Instruction("dec   r24", 1),
        Instruction("brpl  11f", 1),
        Instruction("lds   r24, %[ocr]", 2, "it was the last:"),
        *_move("last", "from there to the step"),
        Instruction("ldi   r24, 1", 1),
        Instruction("sts   %[laps], r24", 2),
        Instruction("ldi   r24, 255", 1),
        Instruction("rjmp  11f", 2),
    )


def _copy(source: str, target: str, note: str = "", label: str = "") -> tuple[Instruction, ...]:
    return (
        Instruction(f"lds   r24, %[{source}]", 2, note, label=label),
        Instruction(f"sts   %[{target}], r24", 2),
    )

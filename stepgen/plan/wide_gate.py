"""
What timing compare on a 16-bit timer puts into the step interrupt: OCRnx goes on by the interval.

Source: ATmega328P datasheet, "16-bit Timer/Counter1 with PWM", Accessing 16-bit Registers: the high
byte of OCRnx is written first and waits in TEMP, that of TCNTn is read last and comes from there.
All 16-bit registers of a timer share that TEMP, so whatever touches one has interrupts off.
"""

from dataclasses import replace

from stepgen.devices import Register, Timer16
from stepgen.plan.instructions import Gate, Instruction, Storage
from stepgen.plan.isr import Motion
from stepgen.plan.model import TimerPlan

COAST_BIT = 1
"""The bit of a motion's mode that says that its last step is made."""

_HANDLER_CYCLES = 130  # to move the compare register, to look if that was too late, to count that
_MASKED_CYCLES = 30  # to make laps of an interval


def wide_gate(timing: TimerPlan, motion: Motion, storage: Storage, lap_bytes: int = 2) -> Gate:
    """
    Return the fragments of the compare channel of *timing*, whose counts of laps have *lap_bytes*.
    """
    gate = Gate(
        boundary=laps(lap_bytes),
        advance=_advance(),
        check=(*passed(), Instruction("pop   r25", 2), Instruction("brpl  13f", 1)),
        handler_cycles=_HANDLER_CYCLES,
        masked_cycles=_MASKED_CYCLES,
        tells_missed=True,
        registers=channel_registers(timing),
        fields=(("due", "due"), ("ticks", "next.ticks"), ("laps", "lapsLeft")),
    )
    if not motion.can_go_on:
        return gate
    nolaps = _nolaps(lap_bytes)
    return replace(
        gate,
        go_on=(*passed(), Instruction("brpl  16f", 1), *nolaps, *_next_run(storage)),
        out=(Instruction("pop   r25", 2, label="16"),),
        look=_look(storage, nolaps),
        fields=(
            *gate.fields,
            ("nextLaps", "next.laps"),
            ("rest", "rest"),
            ("endMillis", "endMillis"),
        ),
    )


def channel_registers(timing: TimerPlan) -> tuple[tuple[str, Register], ...]:
    """
    Return the bytes of the compare register and of the counter of *timing*, by operand.
    """
    timer = timing.timer
    if not isinstance(timer, Timer16):
        raise TypeError(f"timer {timer.number} has not 16 bits")
    ocr, _ = timer.compare_channels[timing.channel]
    return (*_bytes("ocr", ocr), *_bytes("tcnt", timer.tcnt))


def _bytes(name: str, register: Register) -> tuple[tuple[str, Register], ...]:
    low = Register(f"{register.name}L", register.address)
    high = Register(f"{register.name}H", register.address + 1)
    return (f"{name}Low", low), (f"{name}High", high)


def laps(size: int = 2) -> tuple[Instruction, ...]:
    """
    Return what keeps an interrupt that ends a lap away from the step; their count has *size* bytes.
    """
    middle = (
        Instruction("lds   r24, %[laps] + 1", 2),
        Instruction("tst   r24", 1),
        Instruction("brne  17f", 1),
    )
    return (
        Instruction("lds   r24, %[laps]", 2, "laps of a long interval that are left?"),
        Instruction("tst   r24", 1),
        Instruction("brne  17f", 1),
        *(middle if size > 2 else ()),  # noqa: PLR2004 - what is between the first and the last
        Instruction(f"lds   r24, %[laps] + {size - 1}", 2),
        Instruction("tst   r24", 1),
        Instruction("breq  .+2", 2),
        Instruction("rjmp  2f", 0, "one less, and no step", label="17"),
    )


def _advance() -> tuple[Instruction, ...]:
    """
    Return what moves the compare register to the next step; r25 then is on the stack.
    """
    return (
        Instruction("push  r25", 2),
        Instruction("lds   r24, %[due]", 2, "when this step was due, and the interval more"),
        Instruction("lds   r25, %[ticks]", 2),
        Instruction("add   r24, r25", 1),
        Instruction("sts   %[due], r24", 2),
        Instruction("lds   r24, %[due] + 1", 2),
        Instruction("lds   r25, %[ticks] + 1", 2),
        Instruction("adc   r24, r25", 1),
        Instruction("sts   %[due] + 1, r24", 2),
        Instruction("sts   %[ocrHigh], r24", 2, "waits in TEMP"),
        Instruction("lds   r25, %[due]", 2),
        Instruction("sts   %[ocrLow], r25", 2, "the next match is the next step"),
    )


def passed() -> tuple[Instruction, ...]:
    """
    Return what looks if the moment that was set has passed: not if negative. r25 is its low byte.
    """
    return (
        Instruction("lds   r24, %[tcntLow]", 2),
        Instruction("sub   r24, r25", 1),
        Instruction("lds   r24, %[tcntHigh]", 2),
        Instruction("lds   r25, %[due] + 1", 2),
        Instruction("sbc   r24, r25", 1, "negative: that is still to come"),
    )


def _nolaps(size: int) -> tuple[Instruction, ...]:
    """
    Return what leads to the handler where the interval that has begun, or the next one, has laps.
    """
    more = (
        (
            Instruction(f"lds   r25, %[nextLaps] + {byte}", 2),
            Instruction("or    r24, r25", 1),
        )
        for byte in range(1, size)
    )
    return (
        Instruction("lds   r24, %[nextLaps]", 2, "no laps to count?"),
        *(line for lines in more for line in lines),
        Instruction("brne  16f", 1),
    )


def _next_run(storage: Storage) -> tuple[Instruction, ...]:
    """
    Return what begins a run of 255 steps if as many are left.
    """
    return (
        Instruction("lds   r24, %[rest]", 2, "255 more steps"),
        Instruction("lds   r25, %[rest] + 1", 2),
        Instruction("subi  r24, 255", 1),
        Instruction("sbci  r25, 0", 1),
        Instruction("brcs  16f", 1, "not so many"),
        Instruction("sts   %[rest], r24", 2),
        Instruction("sts   %[rest] + 1, r25", 2),
        Instruction("ldi   r24, 255", 1),
        storage.count.store("r24", "count"),
        Instruction("pop   r25", 2),
    )


def _look(storage: Storage, nolaps: tuple[Instruction, ...]) -> tuple[Instruction, ...]:
    """
    Return the look at the clock: as long as the end is not there, one step more and no handler.
    """
    return (
        Instruction(f"sbrc  r24, {COAST_BIT}", 2, "after the last step there is none", label="20"),
        Instruction("rjmp  2b", 0),
        Instruction("push  r25", 2),
        Instruction("lds   r24, %[millis]", 2, "millis(), lower half,"),
        Instruction("lds   r25, %[endMillis]", 2, "less the end of the limit"),
        Instruction("sub   r24, r25", 1),
        Instruction("lds   r24, %[millis] + 1", 2),
        Instruction("lds   r25, %[endMillis] + 1", 2),
        Instruction("sbc   r24, r25", 1),
        Instruction("brpl  16b", 1, "it is over"),
        *(replace(one, text=one.text.replace("16f", "16b")) for one in nolaps),
        Instruction("lds   r24, %[rest]", 2, "one step less"),
        Instruction("lds   r25, %[rest] + 1", 2),
        Instruction("sbiw  r24, 1", 2),
        Instruction("brcs  16b", 1, "the upper half, too"),
        Instruction("sts   %[rest], r24", 2),
        Instruction("sts   %[rest] + 1, r25", 2),
        Instruction("ldi   r24, 1", 1),
        storage.count.store("r24", "count", "look again with the next step"),
        Instruction("pop   r25", 2),
        Instruction("rjmp  21b", 2),
    )

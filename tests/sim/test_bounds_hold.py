"""
No interrupt ever takes longer, or more stack, than its bound: random programs, run and measured.

A bound that leaves out ways which can be gone would be worse than none. The programs are made of
the instructions whose effects the search follows, and branch on what earlier ones left behind.
"""

import random
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from stepgen.devices.mcus.atmega328p import MCU
from stepgen.verify.bounds.worst_case import WorstCase
from stepgen.verify.compilers import default_compiler
from stepgen.verify.simavr import Kind, Machine

SPACING_CYCLES = 2000
RUNS = 400
INSTRUCTIONS = 50
PROGRAM = """\
#include <avr/interrupt.h>
#include <avr/io.h>
unsigned char cell[8];
int main() {{
  OCR1A = {spacing} - 1;
  TCCR1A = 3;  // fast PWM, TOP is OCR1A
  TIMSK1 = 1;
  TCCR1B = 0x19;
  sei();
  for (unsigned long x = {seed};;) {{
    x ^= x << 13;
    x ^= x >> 17;
    x ^= x << 5;
    cell[x & 7] = x >> 8 & ((x & 0x40000000) ? 0x81 : 0xFF);
  }}
}}
ISR(TIMER1_OVF_vect, ISR_NAKED) {{
  asm volatile({code});
}}
"""
HIGH = range(16, 26)
UNARY = ("com", "neg", "inc", "dec", "lsr", "asr", "ror", "lsl", "rol", "swap", "tst")
BINARY = ("add", "adc", "sub", "sbc", "and", "or", "eor", "mov", "cp", "cpc")
IMMEDIATE = ("ldi", "subi", "sbci", "andi", "ori", "cpi")
BRANCHES = ("breq", "brne", "brcs", "brcc", "brmi", "brpl", "brlt", "brge", "brts", "brtc")
CONSTANTS = (0, 0, 1, 2, 0x40, 0x80, 0x81, 0xFF)
SAVED = [*(f"r{number}" for number in HIGH), "r26", "r27", "r30", "r31"]


def random_code(dice: random.Random) -> Iterator[str]:
    """
    Yield the lines of an interrupt that only goes forward.
    """
    labels: dict[int, list[int]] = {}
    yield from (f"push {register}" for register in SAVED)
    yield from ("in r16, 0x3f", "push r16")
    for place in range(INSTRUCTIONS):
        yield from (f"{label}:" for label in labels.pop(place, ()))
        kind = dice.random()
        if kind < 0.2:
            label = 100 + place
            labels.setdefault(place + dice.randint(1, 8), []).append(label)
            yield f"{dice.choice(BRANCHES)} {label}f"
        elif kind < 0.35:
            register, other = dice.choice(HIGH), dice.choice(HIGH)
            yield dice.choice(
                (
                    f"sbrc r{register}, {dice.randint(0, 7)}",
                    f"cpse r{register}, r{other}",
                    f"sbrs r{register}, {dice.randint(0, 7)}",
                    "sbis 0x1e, 3",
                    "sbic 0x1e, 0",
                )
            )
            yield random_instruction(dice)
        else:
            yield random_instruction(dice)
    for left in labels.values():
        yield from (f"{label}:" for label in left)
    yield from ("pop r16", "out 0x3f, r16")
    yield from (f"pop {register}" for register in reversed(SAVED))
    yield "reti"


def random_instruction(dice: random.Random) -> str:
    """
    Return an instruction that changes registers, memory or flags.
    """
    register, other = dice.choice(HIGH), dice.choice(HIGH)
    bit, cell = dice.randint(0, 7), dice.randint(0, 7)
    return dice.choice(
        (
            f"{dice.choice(UNARY)} r{register}",
            f"{dice.choice(BINARY)} r{register}, r{other}",
            f"{dice.choice(BINARY)} r{register}, r{other}",
            f"{dice.choice(IMMEDIATE)} r{register}, {dice.choice(CONSTANTS)}",
            f"{dice.choice(IMMEDIATE)} r{register}, {dice.choice(CONSTANTS)}",
            f"lds r{register}, cell + {cell}",
            f"lds r{register}, cell + {cell}",
            f"sts cell + {cell}, r{register}",
            f"{dice.choice(('adiw', 'sbiw'))} r24, {dice.choice((0, 1, 2))}",
            f"movw r{register & ~1}, r{other & ~1}",
            f"bst r{register}, {bit}",
            f"bld r{register}, {bit}",
            f"in r{register}, 0x1e",
            f"out 0x1e, r{register}",
            f"sbi 0x1e, {bit}",
            f"{dice.choice(('sec', 'clc', 'set', 'clt'))}",
        )
    )


def measure(code: str, seed: int, folder: Path) -> tuple[int, int, WorstCase]:
    """
    Return the most cycles and bytes of stack that the interrupt took, and its bounds.
    """
    text = "\n".join(f'    "{line}\\n"' for line in code.splitlines())
    (folder / "program.c").write_text(
        PROGRAM.format(code=text, seed=seed, spacing=SPACING_CYCLES), encoding="utf-8"
    )
    elf = folder / "program.elf"
    command = ["avr-gcc", "-mmcu=atmega328p", "-Os", str(folder / "program.c"), "-o", str(elf)]
    subprocess.run(command, check=True)
    with Machine(elf, mcu="atmega328p", f_cpu_hz=16_000_000) as machine:
        machine.run_until(RUNS * SPACING_CYCLES)
        exits = machine.events()
        exits = exits[exits["kind"] == Kind.ISR_EXIT]
        assert len(exits) > RUNS // 2
        cycles = int((exits["cycle"] - exits["since"]).max())
        stack = int(exits["value"].max())
    return cycles, stack, WorstCase(elf, MCU, default_compiler())


@pytest.mark.parametrize("seed", range(40))
def test_no_run_exceeds_the_bound(seed: int, tmp_path: Path) -> None:
    """
    Whatever the memory holds, the interrupt keeps to its bound in cycles and stack.
    """
    dice = random.Random(seed)  # noqa: S311 - no secret
    code = "\n".join(random_code(dice))

    cycles, stack, program = measure(code, seed + 1, tmp_path)

    bound = program.interrupt("TIMER1_OVF_vect")
    assert cycles <= bound.cycles
    assert stack <= bound.stack_bytes

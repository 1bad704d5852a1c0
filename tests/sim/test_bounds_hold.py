"""
No interrupt ever takes longer, or more stack, than its bound: random programs, run and measured.

A bound that leaves out ways which can be gone would be worse than none. The programs are made of
the instructions whose effects the search follows, and branch on what earlier ones left behind.
"""

import random
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from stepgen.devices.mcus.atmega328p import MCU
from stepgen.verify.bounds.cycles import Core
from stepgen.verify.bounds.disassembly import disassemble
from stepgen.verify.bounds.graph import Graph
from stepgen.verify.bounds.machine import Memory
from stepgen.verify.bounds.search import Search, Way
from stepgen.verify.bounds.worst_case import WorstCase
from stepgen.verify.compilers import default_compiler
from stepgen.verify.events import Kind
from stepgen.verify.simavr import Machine

VECTOR = "TIMER1_OVF_vect"
SPACING_CYCLES = 2000
RUNS = 400
INSTRUCTIONS = 24
PROGRAM = """\
#include <avr/interrupt.h>
#include <avr/io.h>
unsigned char cell[8] __attribute__((aligned(16)));
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
    cell[x & 1 ? 0 : x >> 1 & 3] = x >> 8 & ((x & 0x40000000) ? 0x81 : 0xFF);
  }}
}}
ISR(TIMER1_OVF_vect, ISR_NAKED) {{
  asm volatile({code});
}}
"""
HIGH = range(22, 26)  # few, so that what one instruction leaves the next one finds
UNARY = ("com", "neg", "inc", "dec", "lsr", "asr", "ror", "lsl", "rol", "swap", "tst")
BINARY = ("add", "adc", "sub", "sbc", "and", "or", "eor", "mov", "cp", "cpc")
IMMEDIATE = ("ldi", "subi", "sbci", "andi", "ori", "cpi")
BRANCHES = ("breq", "brne", "brcs", "brcc", "brmi", "brpl", "brlt", "brge", "brts", "brtc")
CONSTANTS = (0, 0, 1, 2, 0x40, 0x80, 0x81, 0xFF)
SAVED = ["r16", "r17", *(f"r{number}" for number in HIGH), "r26", "r27", "r30", "r31"]


def random_code(dice: random.Random) -> Iterator[str]:
    """
    Yield the lines of an interrupt that only goes forward.

    Where it falls through a branch, or does not skip, it writes a number of its own to port B.
    """
    labels: dict[int, list[int]] = {}
    yield from (f"push {register}" for register in SAVED)
    yield from ("in r16, 0x3f", "push r16")
    yield from ("ldi r17, 0", "out 0x05, r17")  # a mark shows where it changes the port
    # Z points at the cells, and X somewhere among them: see below.
    yield from ("ldi r30, lo8(cell)", "ldi r31, hi8(cell)", "mov r26, r30", "mov r27, r31")
    for place in range(INSTRUCTIONS):
        yield from (f"{label}:" for label in labels.pop(place, ()))
        kind = dice.random()
        if kind < 0.2:
            label = 100 + place
            labels.setdefault(place + dice.randint(1, 8), []).append(label)
            yield f"{dice.choice(BRANCHES)} {label}f"
            yield from (f"ldi r17, {place + 1}", "out 0x05, r17")
        elif kind < 0.35:
            register, other = dice.choice(HIGH), dice.choice(HIGH)
            yield f"ldi r17, {place + 1}"
            yield dice.choice(
                (
                    f"sbrc r{register}, {dice.choice((0, 7))}",
                    f"cpse r{register}, r{other}",
                    f"sbrs r{register}, {dice.choice((0, 7))}",
                    "sbis 0x1e, 3",
                    "sbic 0x1e, 0",
                )
            )
            yield "out 0x05, r17"
        else:
            yield random_instruction(dice)
    for left in labels.values():
        yield from (f"{label}:" for label in left)
    yield from ("pop r16", "out 0x3f, r16")
    yield from (f"pop {register}" for register in reversed(SAVED))
    yield "reti"


def random_instruction(dice: random.Random) -> str:
    """
    Return an instruction that changes registers, memory or flags, or a few that belong together.
    """
    register, other = dice.choice(HIGH), dice.choice(HIGH)
    bit, cell = dice.choice((0, 7)), dice.randint(0, 2)
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
            f"ldd r{register}, Z+{cell}",
            f"std Z+{cell}, r{register}",
            f"lds r26, cell + {cell}\nandi r26, 1\nsubi r26, lo8(-(cell))\nst X, r{register}",
            f"ld r{register}, X",
            f"push r{register}\ninc r{register}\npop r{other}",
            f"{dice.choice(('sec', 'clc', 'set', 'clt'))}",
        )
    )


Marks = tuple[int, ...]


@dataclass(frozen=True)
class Measured:
    """
    What the runs of the interrupt took at most, and the marks that each kind of run left.
    """

    cycles: int
    stack_bytes: int
    marks: set[Marks]


def build(code: str, seed: int, folder: Path) -> Path:
    """
    Return the program with the interrupt *code*.
    """
    text = "\n".join(f'    "{line}\\n"' for line in code.splitlines())
    (folder / "program.c").write_text(
        PROGRAM.format(code=text, seed=seed, spacing=SPACING_CYCLES), encoding="utf-8"
    )
    elf = folder / "program.elf"
    command = ["avr-gcc", "-mmcu=atmega328p", "-Os", str(folder / "program.c"), "-o", str(elf)]
    subprocess.run(command, check=True)
    return elf


def measure(elf: Path) -> Measured:
    """
    Run *elf* and return what its interrupt did.
    """
    with Machine(elf, mcu=MCU.name, f_cpu_hz=16_000_000) as machine:
        machine.run_until(RUNS * SPACING_CYCLES)
        events = machine.events()
        exits = events[events["kind"] == Kind.ISR_EXIT]
        ports = events[events["kind"] == Kind.PORT]
        assert len(exits) > RUNS // 2
        runs = ((ports["cycle"] > one["since"]) & (ports["cycle"] < one["cycle"]) for one in exits)
        return Measured(
            int((exits["cycle"] - exits["since"]).max()),
            int(exits["value"].max()),
            {tuple(filter(None, ports["value"][inside].tolist())) for inside in runs},
        )


def possible_marks(elf: Path) -> set[Marks]:
    """
    Return the marks of every way that the search does not rule out.
    """
    program = disassemble(elf, default_compiler())
    graph = Graph(program, Core.of(MCU), {})
    start = 4 * MCU.vector(VECTOR).number
    return {marks(way) for way in Search(graph, Memory.of(MCU)).ways(start, graph.reach(start))}


def marks(way: Way) -> Marks:
    """
    Return what is written to port B on *way*.
    """
    written, mark = [], 0
    for line in way.lines:
        if line.name == "ldi" and line.operands[0] == "r17":
            mark = int(line.operands[1], 0)
        elif line.name == "out" and line.operands == ("0x05", "r17"):
            written.append(mark)
    return tuple(filter(None, written))


@pytest.mark.parametrize("seed", range(40))
def test_no_run_goes_a_way_that_was_ruled_out(seed: int, tmp_path: Path) -> None:
    """
    Whatever the memory holds, the interrupt goes a way that the search knows, within its bound.
    """
    dice = random.Random(seed)  # noqa: S311 - repeatable, not secret
    elf = build("\n".join(random_code(dice)), seed + 1, tmp_path)

    measured = measure(elf)

    bound = WorstCase(elf, MCU, default_compiler()).interrupt(VECTOR)
    assert measured.cycles <= bound.cycles
    assert measured.stack_bytes <= bound.stack_bytes
    assert measured.marks <= possible_marks(elf)

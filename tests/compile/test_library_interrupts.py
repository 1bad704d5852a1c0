"""
What the plan assumes of other libraries' interrupts, and of stretches with interrupts off, is so.

The libraries are those of the Arduino core, compiled as the IDE does and bounded like a step.
"""

import re
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import pytest

from stepgen import api
from stepgen.devices import CORE, INTERRUPTS, UNBOUND, Board, find_board, library_claims
from stepgen.errors import StepgenError
from stepgen.plan.waits import LONG_APART, SHORT_APART, SHORT_STRETCH_CYCLES
from stepgen.verify.bounds.cycles import Core
from stepgen.verify.bounds.disassembly import Line, Program, disassemble
from stepgen.verify.bounds.machine import Memory
from stepgen.verify.bounds.masked import MaskedSections
from stepgen.verify.bounds.worst_case import WorstCase
from stepgen.verify.compilers import Compiler, find_compilers
from stepgen.verify.firmware import build_firmware
from stepgen.verify.recipes import platform_dir
from stepgen.verify.toolchain import Target, build

SPECS = Path(__file__).parents[2] / "specs"
SERIAL = """\
void setup() {{ {0}.begin(115200); }}
void loop() {{ if ({0}.available()) {0}.write({0}.read()); }}
"""
SKETCHES = {
    "USB": SERIAL.format("Serial"),
    **{name: SERIAL.format(name) for name in ("Serial", "Serial1", "Serial2", "Serial3")},
    "tone": "void setup() {}\nvoid loop() { tone(analogRead(0), 440, 100); noTone(5); }\n",
    "SoftwareSerial": """\
#include <SoftwareSerial.h>
SoftwareSerial line(10, 11);
void setup() { line.begin(9600); }
void loop() { if (line.available()) line.write(line.read()); }
""",
    "Wire": """\
#include <Wire.h>
void setup() { Wire.begin(); }
void loop() { Wire.requestFrom(3, 4); Wire.read(); }
""",
}
SOURCES = {
    "SoftwareSerial": ("SoftwareSerial/src/SoftwareSerial.cpp",),
    "Wire": ("Wire/src/Wire.cpp", "Wire/src/utility/twi.c"),
}
PROVEN = [
    *((board, "Serial") for board in ("uno", "pro-mini-8mhz", "mega", "mega1280")),
    *((board, "Serial1") for board in ("leonardo", "mega", "mega1280")),
    *((board, "tone") for board in ("uno", "pro-mini-8mhz", "leonardo")),
]
EACH_COMPILER = pytest.mark.parametrize(
    "compiler", find_compilers(), ids=lambda compiler: compiler.name
)
# Each kind of timing and motion, two motors, and shields that share their enables.
STRETCHES = (
    "uno_motor_shield",
    "uno_servo_beside_variable",
    "uno_three_ports_variable",
    "mega_stacked_shields_variable",
)


def program(name: str, board: Board, compiler: Compiler, folder: Path) -> WorstCase:
    """
    Return the worst case of a sketch that uses the library *name*.
    """
    libraries = platform_dir() / "libraries"
    sources = [libraries / source for source in SOURCES.get(name, ())]
    sketch = folder / "sketch.ino"
    sketch.write_text(SKETCHES[name], encoding="utf-8")
    includes = [libraries / name / "src"] if sources else []
    target = Target.from_fqbn(board.fqbn)
    made = build([sketch, *sources], includes, target, compiler, folder, warnings_as_errors=False)
    return WorstCase(made.elf, board.mcu, compiler)


def board_named(name: str) -> Board:
    """
    Return the board *name*.
    """
    board = find_board(name)
    assert board is not None
    return board


@EACH_COMPILER
@pytest.mark.parametrize(("name", "library"), PROVEN)
def test_interrupts_of_other_libraries_are_bounded(
    name: str, library: str, compiler: Compiler, tmp_path: Path
) -> None:
    """
    None takes longer than stated, nor a seventh less.
    """
    board = board_named(name)
    worst = program(library, board, compiler, tmp_path)

    claims = library_claims(library, board)
    assert claims is not None
    for interrupt in INTERRUPTS[library]:
        pattern = interrupt.vector.format(timer=claims.timers[-1] if claims.timers else "")
        (vector,) = (v for v in board.mcu.vectors if re.fullmatch(pattern, v.name))
        cycles = worst.interrupt(vector.name).cycles
        assert interrupt.is_proven_on(board.mcu)
        assert cycles <= interrupt.cycles_on(board.mcu) < 1.17 * cycles


@EACH_COMPILER
def test_the_interrupt_of_a_usb_frame_is_bounded(compiler: Compiler, tmp_path: Path) -> None:
    """
    It takes no longer than stated, nor a seventh less, where the sketch uses Serial.
    """
    stated = CORE["USB"]
    found = program("Serial", board_named("leonardo"), compiler, tmp_path).interrupt(stated.vector)

    assert found.cycles <= stated.cycles < 1.17 * found.cycles


@EACH_COMPILER
@pytest.mark.parametrize("library", UNBOUND)
def test_what_is_said_to_have_no_bound_has_none(
    library: str, compiler: Compiler, tmp_path: Path
) -> None:
    """
    Loops that wait for the line, and calls of what the sketch gave: no bound is found.
    """
    vector = UNBOUND[library].vector
    worst = program(library, board_named("leonardo"), compiler, tmp_path)

    with pytest.raises(StepgenError, match="cycles have no bound"):
        worst.interrupt(vector)


@dataclass(frozen=True)
class Stretches:
    """
    The stretches of a program with interrupts off: how long they are, and how far apart.
    """

    program: Program
    cycles: Mapping[int, int]  # of the stretch that begins at an address

    def apart(self, ends_of: Iterable[int], to: Iterable[int]) -> int | None:
        """
        Return the fewest instructions from the end of a stretch of *ends_of* to one of *to*.

        A function may return to whoever calls it: then there can only be fewer of them.
        """
        goals = set(to)
        return _nearest([end for start in ends_of for end in self._ends(start)], goals, self._next)

    def _ends(self, start: int) -> list[int]:
        ends: list[int] = []
        seen, waiting = {start}, [start]
        while waiting:
            line = self.program.at(waiting.pop())
            if line.name == "sei" or (line.name, *line.operands[:1]) == ("out", "0x3f"):
                ends.append(line.address)
                continue
            fresh = [address for address in self._next(line.address) if address not in seen]
            seen.update(fresh)
            waiting += fresh
        return ends

    def _next(self, address: int) -> list[int]:
        line = self.program.at(address)
        if line.name == "ret":
            return list(self._returns(self.program.entry_of(address)))
        if line.name in {"reti", "ijmp", "eijmp"}:
            return []
        if line.name in {"icall", "eicall"}:
            return [line.following]
        after = list(self.program.after(line))
        return [line.target, *after] if line.is_call else after

    def _returns(self, entry: int, seen: tuple[int, ...] = ()) -> Iterator[int]:
        for line in self.program.lines.values():
            if line.is_call and line.target == entry:
                yield line.following
            elif _is_tail_call(self.program, line, entry):
                caller = self.program.entry_of(line.address)
                if caller not in (*seen, entry):
                    yield from self._returns(caller, (*seen, entry))


def _is_tail_call(code: Program, line: Line, entry: int) -> bool:
    return line.is_jump and line.target == entry != code.entry_of(line.address)


def _nearest(
    starts: list[int], goals: set[int], following: Callable[[int], list[int]]
) -> int | None:
    seen = set(starts)
    waiting = deque((start, 0) for start in starts)
    while waiting:
        address, far = waiting.popleft()
        if far and address in goals:
            return far
        fresh = [one for one in following(address) if one not in seen]
        seen.update(fresh)
        waiting.extend((one, far + 1) for one in fresh)
    return None


def stretches(elf: Path, name: str, board: Board, compiler: Compiler) -> Stretches:
    """
    Return the stretches of the library *name* in *elf*.
    """
    code = disassemble(elf, compiler)
    sections = MaskedSections(code, Core.of(board.mcu), Memory.of(board.mcu), f"{name}.cpp")
    return Stretches(code, {start: way.cycles for start, way in sections.each()})


@EACH_COMPILER
@pytest.mark.parametrize("stem", STRETCHES)
def test_long_stretches_with_interrupts_off_are_far_apart(stem: str, compiler: Compiler) -> None:
    """
    Between two long ones lie at least 32 instructions, and 2 before any other.
    """
    path = SPECS / f"{stem}.yaml"
    plan = api.plan(path)
    firmware = build_firmware(plan, path.read_text(encoding="utf-8"), compiler)

    for elf in (firmware.bench, firmware.example):
        found = stretches(elf, plan.library.name, plan.board, compiler)
        long = [start for start, cycles in found.cycles.items() if cycles > SHORT_STRETCH_CYCLES]
        assert long
        assert (found.apart(long, long) or LONG_APART) >= LONG_APART
        assert (found.apart(found.cycles, found.cycles) or 0) >= SHORT_APART

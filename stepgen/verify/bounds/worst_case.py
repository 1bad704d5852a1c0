"""
The worst case of a program: its interrupts, and its library's stretches with interrupts off.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path

from stepgen.devices import Mcu
from stepgen.verify.bounds.cycles import Core, extra_cycles
from stepgen.verify.bounds.disassembly import Line, disassemble
from stepgen.verify.bounds.graph import Graph
from stepgen.verify.bounds.loops import STATED_ROUNDS
from stepgen.verify.bounds.machine import Memory
from stepgen.verify.bounds.masked import MaskedSections
from stepgen.verify.bounds.search import Search
from stepgen.verify.bounds.stack import stack_bytes
from stepgen.verify.compilers import Compiler

_NEAR_FLASH_BYTES = 8 * 1024  # up to it a vector is an RJMP, beyond it a JMP


@dataclass(frozen=True)
class Bound:
    """
    The longest that something can take.

    Args:
        cycles: CPU cycles; of an interrupt from the response through RETI.
        stack_bytes: The most stack that an interrupt takes, its return address included.
        path: The longest way: each function with its cycles and the source lines passed.
    """

    cycles: int
    stack_bytes: int
    path: tuple[str, ...]


class WorstCase:
    """
    Bounds of the program *elf* for *mcu*, which *compiler* built.
    """

    def __init__(self, elf: Path, mcu: Mcu, compiler: Compiler) -> None:
        self._mcu = mcu
        self._core = Core.of(mcu)
        self._memory = Memory.of(mcu)
        self._program = disassemble(elf, compiler)
        self._graph = Graph(self._program, self._core, STATED_ROUNDS)

    def interrupt(self, vector: str) -> Bound:
        """
        Return the bound of the interrupt *vector*, such as ``TIMER1_OVF_vect``.

        Raises:
            StepgenError: It has no bound; says which instruction is to blame.
        """
        start = self._start_of(vector)
        way = Search(self._graph, self._memory).longest(start, self._graph.reach(start))
        response = self._core.response_cycles
        path = (f"response: {response} cycles", *self._describe(way.lines))
        return Bound(response + way.cycles, stack_bytes(self._graph, start), path)

    def interrupt_cycles(self, vector: str) -> int:
        """
        Return the longest that the interrupt *vector* takes, whatever it does with the stack.

        Raises:
            StepgenError: It has no bound; says which instruction is to blame.
        """
        start = self._start_of(vector)
        way = Search(self._graph, self._memory).longest(start, self._graph.reach(start))
        return self._core.response_cycles + way.cycles

    def masked(self, source: str) -> Bound:
        """
        Return the bound of a stretch with interrupts off that begins in the file *source*.

        Raises:
            StepgenError: It has no bound, or there is none.
        """
        way = MaskedSections(self._program, self._core, self._memory, source).longest()
        return Bound(way.cycles, 0, tuple(self._describe(way.lines)))

    def _start_of(self, vector: str) -> int:
        vector_bytes = 4 if self._mcu.flash_bytes > _NEAR_FLASH_BYTES else 2
        return self._mcu.vector(vector).number * vector_bytes

    def _describe(self, lines: Sequence[Line]) -> Iterator[str]:
        following = (*lines[1:], None)
        steps = list(zip(lines, following, strict=True))
        for name, group in groupby(steps, lambda step: self._program.function_at(step[0].address)):
            passed = list(group)
            cycles = sum(self._cycles(line, after) for line, after in passed)
            yield f"{name}: {cycles} cycles {_sources(line for line, _ in passed)}".rstrip()

    def _cycles(self, line: Line, after: Line | None) -> int:
        return self._graph.cycles(line) + (extra_cycles(line, after.address) if after else 0)


def _sources(lines: Iterator[Line]) -> str:
    """
    Return the source lines that *lines* pass, such as ``(Pan.cpp:3-5,9)``.
    """
    places = [line.source.rpartition(":") for line in lines if line.source]
    shown = []
    for file, group in groupby(places, lambda place: place[0]):
        numbers = [int(number) for number, _ in groupby(place[2] for place in group)]
        shown.append(f"{file}:{_ranges(numbers)}")
    return f"({' '.join(shown)})" if shown else ""


def _ranges(numbers: Sequence[int]) -> str:
    runs: list[list[int]] = []
    for number in numbers:
        if runs and number == runs[-1][-1] + 1:
            runs[-1].append(number)
        else:
            runs.append([number])
    return ",".join(str(run[0]) if len(run) == 1 else f"{run[0]}-{run[-1]}" for run in runs)


def longest(bounds: Sequence[Bound]) -> Bound:
    """
    Return the bound that holds for all of the programs of *bounds*.
    """
    most = max(bounds, key=lambda bound: bound.cycles)
    return Bound(most.cycles, max(bound.stack_bytes for bound in bounds), most.path)

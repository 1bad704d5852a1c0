"""
The longest stretch that the main line has interrupts off: from CLI until SREG is restored.
"""

import re
from collections.abc import Iterator, Sequence
from functools import cached_property

from stepgen.errors import StepgenError
from stepgen.verify.bounds.cycles import Core
from stepgen.verify.bounds.disassembly import Line, Program
from stepgen.verify.bounds.graph import Graph, Reach
from stepgen.verify.bounds.loops import STATED_ROUNDS
from stepgen.verify.bounds.machine import Memory
from stepgen.verify.bounds.search import Search, Way

_SREG_IO = 0x3F
# The library's guard. Where link-time optimisation has put one of its functions into a sketch, a
# line of the guard, or all lines of the function, can be taken for the sketch's; the guard's name
# stays. No example switches interrupts off itself, and the bench only by ATOMIC_BLOCK in holdUp.
_SKETCH = re.compile(r"bench\.cpp|\w+\.ino\.cpp")
_HOLD_UP = re.compile(r"__iCliRetVal|_ZL6holdUpj")
_GUARD = re.compile(r"_ZN6MaskedC\dEv|Masked::Masked\(.*\)|Masked::Masked")


class MaskedSections:
    """
    The stretches of *program* with interrupts off that begin in one source file or in the guard.

    Where interrupts go off in a function that returns before they come on again, as a C++
    constructor does, the stretch goes on in each of its callers.

    Args:
        program: The program.
        core: What its instructions cost.
        memory: Which addresses keep their contents.
        source: The name of the file: CLI elsewhere is the affair of whoever wrote it.
    """

    def __init__(self, program: Program, core: Core, memory: Memory, source: str) -> None:
        self._program = program
        self._graph = Graph(program, core, STATED_ROUNDS, _ends)
        self._search = Search(self._graph, memory, self._callers)
        self._source = source
        self._beyond: dict[int, int] = {}

    def longest(self) -> Way:
        """
        Return the longest of them.

        Raises:
            StepgenError: There is none, or one has no bound.
        """
        ways = [way for _, way in self.each()]
        if not ways:
            raise StepgenError.of(f"nothing of {self._source} ever switches interrupts off")
        return max(ways, key=lambda way: way.cycles)

    def each(self) -> Iterator[tuple[int, Way]]:
        """
        Yield where each of them begins, and the longest way through it.

        Raises:
            StepgenError: One has no bound.
        """
        for line in self._starts:
            yield line.address, self._search.longest(line.address, self._reach(line))

    @cached_property
    def _starts(self) -> list[Line]:
        return [
            line
            for line in self._program.lines.values()
            if line.name == "cli" and self._is_of_library(line)
        ]

    def _is_of_library(self, line: Line) -> bool:
        file = line.source.split(":")[0]
        of_sketch = _SKETCH.fullmatch(file) and not _HOLD_UP.fullmatch(line.scope)
        return bool(file == self._source or of_sketch or _GUARD.fullmatch(line.scope))

    def _reach(self, start: Line) -> Reach:
        """
        Return what can be reached from *start* until interrupts are on, callers counted in.
        """
        reach = self._graph.reach(start.address)
        again = [a for a in reach.edges if self._program.at(a).name == "cli" and a != start.address]
        if again:
            second = self._program.at(again[0])
            raise self._program.refuse(second, "switches interrupts off where they are off")
        if not reach.returns:
            return reach
        entry = self._program.entry_of(start.address)
        return self._graph.reach(start.address, self._after_return(entry))

    def _after_return(self, entry: int) -> int:
        """
        Return the longest way on after the function at *entry* has returned.
        """
        if entry not in self._beyond:
            sites = self._callers(entry)
            self._beyond[entry] = max((r.to_end[x.following] for x, r in sites), default=0)
        return self._beyond[entry]

    def _callers(self, entry: int) -> Sequence[tuple[Line, Reach]]:
        calls = self._calls(entry)
        return [(call, self._reach(self._program.at(call.following))) for call in calls]

    def _calls(self, entry: int) -> list[Line]:
        """
        Return what calls the function at *entry*, also by way of one that jumps to it.
        """
        calls = []
        for line in self._program.lines.values():
            if line.is_call and line.target == entry:
                calls.append(line)
            elif line.is_jump and line.target == entry:
                jumps_from = self._program.entry_of(line.address)
                calls += self._calls(jumps_from) if jumps_from != entry else []
        return calls


def _ends(line: Line) -> bool:
    return line.name == "sei" or (line.name == "out" and int(line.operands[0], 0) == _SREG_IO)

"""
The control-flow graph of a function, and its longest ways to the end when any way may be taken.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field

from stepgen.verify.bounds.cycles import Core, extra_cycles
from stepgen.verify.bounds.disassembly import Line, Program
from stepgen.verify.bounds.loops import Loop, counted_rounds, strong_components

_NEVER = -(1 << 30)
Edges = Mapping[int, tuple[tuple[int, int], ...]]


@dataclass(frozen=True)
class Reach:
    """
    What can be reached from one address, callees left out.

    Args:
        edges: Instruction -> where it may go on, and the cycles until there, calls included.
        ends: The instructions that end it, and how long they take.
        to_end: Instruction -> longest way to an end, its own cycles included.
        loops: The loops, by their first instruction.
        returns: Whether some way ends with RET.
    """

    edges: Edges
    ends: Mapping[int, int]
    to_end: Mapping[int, int]
    loops: Mapping[int, Loop]
    returns: bool


@dataclass
class Graph:
    """
    Longest ways through the functions of *program*.

    Args:
        program: The program.
        core: What its instructions cost.
        rounds: Function -> how often the first instruction of a loop in it is run at most, for
            loops that do not say so themselves.
        is_end: Tells instructions at which a way ends, other than RET and RETI.
    """

    program: Program
    core: Core
    rounds: Mapping[str, int]
    is_end: Callable[[Line], bool] = lambda _: False
    _known: dict[tuple[int, int], Reach] = field(default_factory=dict)
    _open: list[int] = field(default_factory=list)

    def reach(self, start: int, after_return: int = 0) -> Reach:
        """
        Return what can be reached from *start*, with *after_return* cycles after its RET.

        Raises:
            StepgenError: A loop without a stated bound, a recursion, a jump to an unknown place,
                or an instruction whose cycles have no bound.
        """
        key = (start, after_return)
        if key not in self._known:
            if start in self._open:
                raise self.program.refuse(self.program.at(start), "calls itself")
            self._open.append(start)
            self._known[key] = self._explore(start, after_return)
            self._open.pop()
        return self._known[key]

    def cycles(self, line: Line) -> int:
        """
        Return how long *line* takes when it falls through.
        """
        found = self.core.cycles(line)
        if found is None:
            raise self.program.refuse(line, "has no fixed length")
        return found

    def _explore(self, start: int, after_return: int) -> Reach:
        edges: dict[int, tuple[tuple[int, int], ...]] = {}
        ends: dict[int, int] = {}
        returns = False
        waiting = [start]
        while waiting:
            address = waiting.pop()
            if address in edges:
                continue
            line = self.program.at(address)
            own = self.cycles(line)
            edges[address] = ()
            if line.is_return or self.is_end(line):
                is_return = line.name == "ret"
                ends[address] = own + after_return * is_return
                returns |= is_return
                continue
            if line.is_call:
                callee = self.reach(line.target)
                own += callee.to_end[line.target]
                if not callee.returns:
                    ends[address] = own
                    continue
            following = dict.fromkeys(self.program.after(line))
            edges[address] = tuple((goes, own + extra_cycles(line, goes)) for goes in following)
            waiting.extend(following)
        loops: dict[int, Loop] = {}
        to_end = self._longest(edges, ends, loops, start)
        if to_end[start] < 0:
            raise self.program.refuse(self.program.at(start), "never ends")
        return Reach(edges, ends, to_end, loops, returns)

    def _longest(
        self, edges: Edges, ends: Mapping[int, int], loops: dict[int, Loop], start: int
    ) -> dict[int, int]:
        """
        Return the longest way from each instruction of *edges* to one of *ends*.

        Straight code is done backward. A loop is its laps, each the longest way round, and the
        longest way out: loops within it are found once the way back to its head is cut.
        """
        longest: dict[int, int] = {}
        for part in strong_components(edges):
            if len(part) == 1 and part[0] not in _targets(edges, part[0]):
                address = part[0]
                longest[address] = _best(edges[address], longest, ends.get(address, _NEVER))
                continue
            loop = self._loop(set(part), edges, start)
            loops[loop.head] = loop
            inside, back, leave = {}, {}, {}
            for a in part:
                inside[a] = tuple((g, c) for g, c in edges[a] if g in loop.body - {loop.head})
                back[a] = max((c for g, c in edges[a] if g == loop.head), default=_NEVER)
                outward = tuple((g, c) for g, c in edges[a] if g not in loop.body)
                leave[a] = _best(outward, longest, ends.get(a, _NEVER))
            lap = self._longest(inside, back, loops, loop.head)
            out = self._longest(inside, leave, loops, loop.head)
            head = (loop.rounds - 1) * max(lap[loop.head], 0) + out[loop.head]
            longest.update({a: max(out[a], lap[a] + head) for a in part})
            longest[loop.head] = head
        return longest

    def _loop(self, body: set[int], edges: Edges, start: int) -> Loop:
        heads = {goes for a in edges if a not in body for goes in _targets(edges, a)} & body
        heads |= {start} & body
        first = self.program.at(min(heads or body))
        if len(heads) != 1:
            raise self.program.refuse(first, "is a loop with several entries")
        lines = [self.program.at(address) for address in sorted(body)]
        entries = [
            self.program.at(a)
            for a in edges
            if a not in body and first.address in _targets(edges, a)
        ]
        rounds = counted_rounds(first, lines, entries)
        if rounds is None:
            rounds = self.rounds.get(self.program.function_at(first.address))
        if rounds is None:
            raise self.program.refuse(first, "begins a loop that nobody has stated a bound of")
        return Loop(first.address, frozenset(body), rounds)


def _targets(edges: Edges, address: int) -> Iterator[int]:
    return (goes for goes, _ in edges[address])


def _best(out: tuple[tuple[int, int], ...], longest: Mapping[int, int], own: int) -> int:
    return max([own, *(cycles + longest[goes] for goes, cycles in out)])

"""
The longest way that can really be gone: best-first search with what each way knows.

A way is taken up in the order of the longest that it can still become (A*; the estimate is the
plain longest way of the graph, which is never too small). A test that contradicts what the way
already knows cuts it off. So the first way that is complete is the longest of all, and whenever
the search is given up, the best estimate is still a bound.

Source: Hart, Nilsson, Raphael, A Formal Basis for the Heuristic Determination of Minimum Cost
Paths, 1968.
"""

import heapq
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import count

from stepgen.verify.bounds.cycles import extra_cycles
from stepgen.verify.bounds.disassembly import Line
from stepgen.verify.bounds.effects import run
from stepgen.verify.bounds.graph import Graph, Reach
from stepgen.verify.bounds.knowledge import Condition
from stepgen.verify.bounds.machine import Machine, Memory

_MOST_FORKS = 20_000
Trail = tuple["Trail", Line] | None  # the last instruction, and those before it


@dataclass(frozen=True)
class Way:
    """
    The longest way found.

    Args:
        cycles: How long it takes, or may take at most.
        lines: Its instructions.
        is_exact: Whether no test contradicts it; else the search was given up, at a bound.
    """

    cycles: int
    lines: tuple[Line, ...]
    is_exact: bool


@dataclass(frozen=True)
class Frame:
    """
    A function that is being run.

    Args:
        reach: What can be reached in it.
        entry: Where the function begins.
        call: The instruction that called it, if that lies on the way.
        after: Longest way of its callers, once it has returned.
    """

    reach: Reach
    entry: int
    call: Line | None = None
    after: int = 0


@dataclass
class _State:
    """
    A way that is not complete: cycles so far, where it stands and what it knows.
    """

    address: int
    frames: tuple[Frame, ...]
    machine: Machine
    cycles: int = 0
    trail: Trail = None
    came_from: int | None = None
    rounds: dict[tuple[int, int], int] = field(default_factory=dict)

    @property
    def estimate(self) -> int:
        """
        Return the longest that the way can become.
        """
        frame = self.frames[-1]
        return self.cycles + frame.reach.to_end[self.address] + frame.after

    def fork(self) -> "_State":
        """
        Return a way that shares this one's past and can go its own way.
        """
        return replace(self, machine=self.machine.copy(), rounds=dict(self.rounds))

    def enter(self) -> bool:
        """
        Count the rounds of a loop that begins here; tell whether this one is still allowed.
        """
        loop = self.frames[-1].reach.loops.get(self.address)
        if loop is None:
            return True
        key = (len(self.frames), loop.head)
        again = self.came_from in loop.body
        self.rounds[key] = self.rounds.get(key, 0) + 1 if again else 1
        return self.rounds[key] <= loop.rounds


@dataclass
class Search:
    """
    Looks for the longest way from one place.

    Args:
        graph: The program.
        memory: Which addresses keep their contents.
        callers: Of a function that a way began in: each call of it, and what it goes on with.
        most_forks: After how many forks the best estimate is good enough.
    """

    graph: Graph
    memory: Memory
    callers: Callable[[int], Sequence[tuple[Line, Reach]]] = lambda _: ()
    most_forks: int = _MOST_FORKS

    def longest(self, start: int, reach: Reach) -> Way:
        """
        Return the longest way from *start*, where *reach* is what can be reached.

        Raises:
            StepgenError: A function takes its return address from elsewhere.
        """
        order = count()
        heap = [(0, 0, self._begin(start, reach))]
        for _ in range(self.most_forks):
            _, _, best = heapq.heappop(heap)
            if not best.frames:
                return Way(best.cycles, _unroll(best.trail), is_exact=True)
            for state in self._advance(best):
                longest = state.estimate if state.frames else state.cycles
                heapq.heappush(heap, (-longest, next(order), state))
        bound, _, best = heap[0]
        return Way(-bound, _unroll(best.trail), is_exact=False)

    def ways(self, start: int, reach: Reach) -> Iterator[Way]:
        """
        Yield every way from *start* that no test contradicts; there may be very many.
        """
        waiting = [self._begin(start, reach)]
        while waiting:
            state = waiting.pop()
            if state.frames:
                waiting.extend(self._advance(state))
            else:
                yield Way(state.cycles, _unroll(state.trail), is_exact=True)

    def _begin(self, start: int, reach: Reach) -> _State:
        entry = self.graph.program.entry_of(start)
        return _State(start, (Frame(reach, entry),), Machine(self.memory))

    def _advance(self, state: _State) -> Iterator[_State]:
        """
        Go on until the way forks or is complete, and yield what follows.

        A complete way has no frames any more.
        """
        following: Sequence[int] = (state.address,)
        while len(following) == 1:
            state.address = following[0]
            if not state.enter():
                return
            line = self.graph.program.at(state.address)
            state.trail = (state.trail, line)
            state.cycles += self.graph.cycles(line)
            state.came_from = line.address
            if line.name == "reti" or self.graph.is_end(line):
                yield replace(state, frames=())
                return
            if line.is_call:
                following = (self._call(state, line),)
            elif line.name == "ret" and len(state.frames) == 1:
                yield from self._leave(state)
                return
            elif line.name == "ret":
                following = (self._return(state, line),)
            else:
                tested = state.machine.condition(line)
                run(state.machine, line)
                following = self.graph.program.after(line)
        yield from _both_ways(state, line, following, tested)

    def _call(self, state: _State, line: Line) -> int:
        outer = state.frames[-1]
        after = outer.reach.to_end.get(line.following, 0) + outer.after
        state.frames += (Frame(self.graph.reach(line.target), line.target, line, after),)
        state.machine.stack.append(line.following)
        return line.target

    def _return(self, state: _State, line: Line) -> int:
        call = state.frames[-1].call
        top = state.machine.stack.pop() if state.machine.stack else None
        if call is None or top != call.following:
            raise self.graph.program.refuse(line, "does not return to its caller")
        state.frames, state.came_from = state.frames[:-1], call.address
        return call.following

    def _leave(self, state: _State) -> Iterator[_State]:
        """
        Yield each way on in a caller of the function that the way began in.
        """
        callers = self.callers(state.frames[0].entry)
        for call, reach in callers:
            on = state.fork()
            on.machine.stack.clear()
            on.address, on.came_from = call.following, call.address
            on.frames = (Frame(reach, self.graph.program.entry_of(call.address)),)
            yield on
        if not callers:
            yield replace(state, frames=())


def _both_ways(
    state: _State, line: Line, following: Sequence[int], tested: tuple[Condition, bool]
) -> Iterator[_State]:
    """
    Yield the ways on after a branch or skip, that which goes on straight first, if they can be.
    """
    condition, wanted = tested
    known = state.machine.facts.holds(condition)
    for goes, is_taken in zip(following, (False, True), strict=True):
        holds = is_taken == wanted
        if known is not None and known != holds:
            continue
        on = state.fork()
        on.address = goes
        on.cycles += extra_cycles(line, goes)
        if known is not None or on.machine.facts.learn(condition, is_true=holds):
            yield on


def _unroll(trail: Trail) -> tuple[Line, ...]:
    lines = []
    while trail:
        trail, line = trail
        lines.append(line)
    return tuple(reversed(lines))

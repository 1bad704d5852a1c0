"""
Loops: where they are, and how often those go round that say so themselves.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from stepgen.verify.bounds.disassembly import Line

STATED_ROUNDS = {
    "__udivmodqi4_ep": 9,
    "__udivmodhi4_ep": 17,
    "__udivmodsi4_ep": 33,
    "__lshrdi3": 9,
    "chooseSetting": 7,
    "motorTimerGetIOclocksPerSecond": 16,
}
"""
How often loops go round that do not say so themselves, by the label at their head or their
function. libgcc's divisions: once for each bit of the dividend, and once more for the last bit of
the quotient (libgcc, config/avr/lib1funcs.S); its shift of 64 bits, by 63 at most:
once for each byte, then for each bit. chooseSetting: it shifts by 6 bits at
most, one each time, and looks once more whether any is left; motorTimerGetIOclocksPerSecond
likewise, by the 15 that four bits of CLKPR can hold.
"""

_WRITES_PAIRS = frozenset({"movw", "adiw", "sbiw", "mul", "muls", "mulsu", "call", "rcall"})


@dataclass(frozen=True)
class Loop:
    """
    A loop: its first instruction, all that lie in it, and how often the first is run at most.
    """

    head: int
    body: frozenset[int]
    rounds: int


def strong_components(edges: Mapping[int, Sequence[tuple[int, int]]]) -> Iterator[list[int]]:
    """
    Yield the strongly connected parts of a graph, each after those that it leads to.

    Source: Tarjan, Depth-First Search and Linear Graph Algorithms, 1972.
    """
    index: dict[int, int] = {}
    low: dict[int, int] = {}
    stack: list[int] = []
    done: set[int] = set()
    for root in edges:
        work = [(root, iter(edges[root]))] if root not in index else []
        while work:
            node, rest = work[-1]
            if node not in index:
                index[node] = low[node] = len(index)
                stack.append(node)
            for goes, _ in rest:
                if goes not in index:
                    work.append((goes, iter(edges[goes])))
                    break
                if goes not in done:
                    low[node] = min(low[node], index[goes])
            else:
                work.pop()
                if work:
                    low[work[-1][0]] = min(low[work[-1][0]], low[node])
                if low[node] == index[node]:
                    part = stack[stack.index(node) :]
                    del stack[-len(part) :]
                    done.update(part)
                    yield part


def counted_rounds(head: Line, body: Sequence[Line], entries: Sequence[Line]) -> int | None:
    """
    Return how often a counted loop goes round, or None if it is not of this kind.

    avr-gcc shifts by a constant with LDI rN, k before the loop and DEC rN, BRNE at its end.
    Nothing else in the loop touches rN, goes back to its head, or gets round DEC.
    """
    if len(entries) != 1 or entries[0].name != "ldi" or len(body) < 2:  # noqa: PLR2004 - DEC, BRNE
        return None
    counter, rounds = entries[0].operands[0], int(entries[0].operands[1], 0)
    *rest, step, branch = body
    is_counted = (
        (step.name, step.operands) == ("dec", (counter,))
        and (branch.name, branch.target) == ("brne", head.address)
        and not any(counter in line.operands or line.name in _WRITES_PAIRS for line in rest)
        and not any(goes in {head.address, branch.address} for goes in _jumps(rest))
        and not any(line.is_skip and line.following == step.address for line in rest)
    )
    return rounds if is_counted and rounds else None


def _jumps(lines: Sequence[Line]) -> Iterator[int]:
    return (line.target for line in lines if line.is_branch or line.is_jump)

"""
The most stack that an interrupt takes: PUSH, calls, and the return address that the chip pushes.
"""

from stepgen.verify.bounds.disassembly import Line
from stepgen.verify.bounds.graph import Graph

_STACK_POINTER_IO = frozenset({0x3D, 0x3E})


def stack_bytes(graph: Graph, start: int) -> int:
    """
    Return the most bytes on the stack while the interrupt at *start* runs.

    No other interrupt comes on top of them: one that lets others in is refused. So the stack
    of a program is that of its main line and the most of any one interrupt.

    Raises:
        StepgenError: It uses SEI or moves the stack pointer, or what it pushes depends on its way.
    """
    return graph.core.pc_bytes + _deepest(graph, start)


def _deepest(graph: Graph, start: int) -> int:
    """
    Return the most bytes that the function at *start* puts on top of its return address.
    """
    edges = graph.reach(start).edges
    depths: dict[int, int] = {}
    deepest = 0
    waiting = [(start, 0)]
    while waiting:
        address, depth = waiting.pop()
        line = graph.program.at(address)
        if depths.setdefault(address, depth) != depth:
            raise graph.program.refuse(line, "is reached with more or less on the stack")
        after = depth + _pushed(graph, line)
        inside = graph.core.pc_bytes + _deepest(graph, line.target) if line.is_call else 0
        deepest = max(deepest, after, depth + inside)
        waiting += [(goes, after) for goes, _ in edges[address] if depths.get(goes) != after]
    return deepest


def _pushed(graph: Graph, line: Line) -> int:
    if line.name == "sei":
        raise graph.program.refuse(line, "lets other interrupts in")
    if line.name == "out" and int(line.operands[0], 0) in _STACK_POINTER_IO:
        raise graph.program.refuse(line, "moves the stack pointer")
    makes_room = line.name == "rcall" and not line.is_call  # rcall .+0
    return {"push": 1, "pop": -1}.get(line.name, graph.core.pc_bytes if makes_room else 0)

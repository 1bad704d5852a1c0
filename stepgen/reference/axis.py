"""
How steps reach the motor: the place in the coil table, the current, and what the wires show.
"""

from dataclasses import dataclass, field

from stepgen.reference.sequences import Pattern
from stepgen.reference.stimuli import Edge, EdgeKind

_INT32_HALF = 1 << 31


def wrapped_int32(number: int) -> int:
    """
    Return *number* as a two's complement 32-bit integer holds it.
    """
    return (number + _INT32_HALF) % (2 * _INT32_HALF) - _INT32_HALF


@dataclass
class Axis:
    """
    The coils of one motor; it collects the edges it makes.

    Args:
        phases: The coil table.
        coils_off: The pattern without current.
        position: Steps made since Init, int32.
        phase: The place in the table.
        coils_on: Whether the coils get current.
        edges: The edges nobody has taken yet.
    """

    phases: tuple[Pattern, ...]
    coils_off: Pattern
    position: int = 0
    phase: int = 0
    coils_on: bool = False
    edges: list[Edge] = field(default_factory=list)

    def step(self, cycle: int, direction: int, call_index: int) -> None:
        """
        Go on by one phase, +1 along the table or -1 against it.
        """
        self.position = wrapped_int32(self.position + direction)
        self.phase = (self.phase + direction) % len(self.phases)
        self._emit(cycle, EdgeKind.STEP, call_index)

    def switch(self, cycle: int, *, on: bool, call_index: int) -> None:
        """
        Switch the current on or off; an edge only if it was not so.
        """
        if on != self.coils_on:
            self.coils_on = on
            self._emit(cycle, EdgeKind.ENERGISE if on else EdgeKind.COILS_OFF, call_index)

    def init(self, cycle: int, call_index: int) -> None:
        """
        Go to the state after Init: no current, position 0, phase 0.
        """
        self.position = 0
        self.phase = 0
        self.switch(cycle, on=False, call_index=call_index)

    def take_edges(self) -> list[Edge]:
        """
        Return the edges since the last time.
        """
        edges, self.edges = self.edges, []
        return edges

    def _emit(self, cycle: int, kind: EdgeKind, call_index: int) -> None:
        pattern = self.phases[self.phase] if self.coils_on else self.coils_off
        self.edges.append(Edge(cycle, pattern, self.position, kind, call_index))

"""
How steps reach the motor: the place in the coil table, the current, and what the wires show.
"""

from dataclasses import dataclass, field

from stepgen.reference.sequences import Pattern
from stepgen.reference.sharing import Need
from stepgen.reference.stimuli import Edge, EdgeKind

_INT32_HALF = 1 << 31


def wrapped_int32(number: int) -> int:
    """
    Return *number* as a two's complement 32-bit integer holds it.
    """
    return (number + _INT32_HALF) % (2 * _INT32_HALF) - _INT32_HALF


@dataclass(frozen=True)
class Turn:
    """
    From this cycle on DIR shows *direction*, +1 or -1.
    """

    cycle: int
    direction: int


@dataclass
class Axis:
    """
    The coils of one motor; it collects the edges it makes.

    Args:
        phases: The coil table.
        released: What the wires show in each phase while the motor needs no current.
        position: Steps made since Init, int32.
        phase: The place in the table.
        coils_on: Whether the motor needs current.
        edges: The edges nobody has taken yet.
        needs: When that changed, each time so far.
        turns: When the direction changed, each time so far.
    """

    phases: tuple[Pattern, ...]
    released: tuple[Pattern, ...]
    position: int = 0
    phase: int = 0
    coils_on: bool = False
    edges: list[Edge] = field(default_factory=list)
    needs: list[Need] = field(default_factory=list)
    turns: list[Turn] = field(default_factory=list)

    def face(self, cycle: int, direction: int) -> None:
        """
        Note the direction of the steps that follow, +1 or -1, which coils do not show.
        """

    def step(self, cycle: int, direction: int, call_index: int) -> None:
        """
        Go on by one phase, +1 along the table or -1 against it.
        """
        self.position = wrapped_int32(self.position + direction)
        self.phase = self._next_phase(direction)
        self._emit(cycle, EdgeKind.STEP, call_index)

    def switch(
        self, cycle: int, *, on: bool, call_index: int, served_cycle: int | None = None
    ) -> None:
        """
        Switch the current on or off; an edge only if it was not so.

        An interrupt does so at its *served_cycle*; what a call does is done at its *cycle*.
        """
        if on != self.coils_on:
            self.coils_on = on
            self.needs.append(Need(cycle if served_cycle is None else served_cycle, on))
            self._emit(cycle, EdgeKind.ENERGISE if on else EdgeKind.COILS_OFF, call_index)

    def init(self, cycle: int, call_index: int) -> None:
        """
        Go to the state after Init: no current, position 0, phase 0.
        """
        shown = self.released[self.phase]
        self.position = 0
        self.face(cycle, 1)
        self.phase = 0
        if self.coils_on:
            self.switch(cycle, on=False, call_index=call_index)
        elif self.released[0] != shown:
            self._emit(cycle, EdgeKind.COILS_OFF, call_index)

    def take_edges(self) -> list[Edge]:
        """
        Return the edges since the last time.
        """
        edges, self.edges = self.edges, []
        return edges

    def _next_phase(self, direction: int) -> int:
        return (self.phase + direction) % len(self.phases)

    def _emit(self, cycle: int, kind: EdgeKind, call_index: int) -> None:
        pattern = (self.phases if self.coils_on else self.released)[self.phase]
        self.edges.append(Edge(cycle, pattern, self.position, kind, call_index))


class DirectedAxis(Axis):
    """
    One motor whose driver counts the phases itself and is told the direction: phase 0 is forward.
    """

    def face(self, cycle: int, direction: int) -> None:
        """
        Show *direction*, +1 or -1, from now on.
        """
        phase = 0 if direction > 0 else 1
        if phase != self.phase:
            self.phase = phase
            self.turns.append(Turn(cycle, direction))

    def _next_phase(self, direction: int) -> int:
        return 0 if direction > 0 else 1

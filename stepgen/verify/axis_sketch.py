"""
A sketch that moves one axis: its calls, and how long they take.
"""

from collections.abc import Iterator, Sequence

from stepgen.plan.model import Plan
from stepgen.reference.climb import Climb
from stepgen.reference.ladder import Ladder
from stepgen.reference.timer import FRACTIONS
from stepgen.verify.bench import Call, CallKind
from stepgen.verify.scenarios import Action, Wait

BUDGET_CYCLES = 12_000_000  # of a scenario, about: longer ones are thinned out
FURTHEST = (1 << 31) - 1
SETTLE_CYCLES = 5_000


class AxisSketch:
    """
    What a sketch does with axis number *index* of *plan*, which climbs on *ladder*.
    """

    def __init__(self, plan: Plan, index: int, ladder: Ladder) -> None:
        motor = plan.motors[index]
        self.name = motor.name
        self.index = index
        self.range = motor.end_stops.range if motor.end_stops else None
        self.queue = motor.motion.queue
        self.cruise_256 = motor.motion.cruise_interval_256
        self.ladder = ladder
        self.period = self.cruise_256 // FRACTIONS
        goal = self.ladder.levels[self.ladder.goal(self.cruise_256)]
        self.ramp_steps = goal.height
        self.first = self.ladder.first_interval_256 // FRACTIONS

    def begin(self) -> Iterator[Action]:
        """
        Begin where there is room either way.
        """
        if self.range:
            yield self.call(CallKind.SET_POSITION, sum(self.range) // 2)

    def call(self, kind: CallKind, steps: int = 0) -> Call:
        """
        Return the call *kind* of this axis.
        """
        return Call(kind, self.index, steps=steps)

    def pace(self, interval_256: int) -> Call:
        """
        Return the call that sets its shortest interval, within what it accepts.
        """
        within = min(max(interval_256, self.cruise_256), 0xFFFF_FFFF)
        return Call(CallKind.SET_PACE, self.index, top=within)

    @property
    def read(self) -> Call:
        """
        Return the call that reads all that it tells.
        """
        return self.call(CallKind.READ)

    def clocks(self, steps: int, pace_256: int | None = None) -> int:
        """
        Return how long a move of *steps* takes, the interval after the last one included.
        """
        climb = Climb(self.ladder, pace_256 or self.cruise_256)
        climb.begin(abs(steps))
        total_256 = climb.interval_256
        for _ in range(abs(steps)):
            climb.step()
            total_256 += climb.interval_256
        return total_256 // FRACTIONS + SETTLE_CYCLES

    def thinned(self, points: Sequence[int], clocks_each: int) -> Sequence[int]:
        """
        Return as many of *points* as fit the budget if each takes so long.
        """
        most = max(BUDGET_CYCLES // max(clocks_each, 1), 1)
        return points[:: -(-len(points) // most)]

    def moves(self, lengths: Sequence[int]) -> Iterator[Action]:
        """
        Go each of *lengths* forward and backward, and read.
        """
        for steps in lengths:
            for way in (steps, -steps):
                yield self.call(CallKind.MOVE, way)
                yield Wait(self.clocks(steps))
            yield self.read

    def to_speed(self) -> Iterator[Action]:
        """
        Run forward until it is at full speed.
        """
        yield self.call(CallKind.RUN_FORWARD)
        yield Wait(self.clocks(self.ramp_steps) + 2 * self.first)
        yield self.read

"""
Scenarios for axes: moves of all lengths, queues, refusals, and all axes at once.
"""

from collections.abc import Iterator, Sequence

from stepgen.plan.model import Plan
from stepgen.reference.ladder import Ladder
from stepgen.reference.timer import FRACTIONS
from stepgen.verify.axis_flight_scenarios import InFlight
from stepgen.verify.axis_limit_scenarios import AtLimits
from stepgen.verify.axis_sketch import BUDGET_CYCLES, FURTHEST, SETTLE_CYCLES, AxisSketch
from stepgen.verify.bench import Call, CallKind, Loop
from stepgen.verify.end_stops import planned_limits
from stepgen.verify.ladders import ladder_of
from stepgen.verify.scenarios import Action, Scenario, Wait

_LONG_MOVE_STEPS = 10_000
_SHORT_MOVES = 60


def axis_scenarios(plan: Plan) -> Iterator[Scenario]:
    """
    Yield the scenarios for each axis of *plan*, and for all of them together.

    An axis that has a range begins in the middle of it.
    """
    axes = [
        (index, ladder)
        for index, motor in enumerate(plan.motors)
        if (ladder := ladder_of(motor.motion))
    ]
    for index, ladder in axes:
        for kind in _kinds(plan, index, ladder):
            for name, loop, actions in kind.scenarios():
                yield Scenario(f"{kind.name}: {name}", loop, (*kind.begin(), *actions))
    if len(axes) > 1:
        sketches = [AxisSketch(plan, index, ladder) for index, ladder in axes]
        yield Scenario("all axes at once", Loop.BUSY, tuple(_together(sketches)))


class FromRest(AxisSketch):
    """
    What a sketch does with an axis, from one rest to the next.
    """

    def scenarios(self) -> Iterator[tuple[str, Loop, Iterator[Action]]]:
        """
        Yield name, loop and actions of each.
        """
        yield "a long move at full speed", Loop.BUSY, self._long_move()
        yield "short moves both ways", Loop.BUSY, self._short_moves()
        yield "moves that do not come to full speed", Loop.SLEEP, self._triangles()
        yield "endless runs", Loop.BUSY, self._endless()
        if self.queue:
            yield "a queue that is full", Loop.BUSY, self._queued()
        yield "refused calls", Loop.BUSY, self._refused()
        yield "positions that are set", Loop.BUSY, self._positions()
        yield "outputs on and off", Loop.BUSY, self._outputs()
        yield "a busy, hostile sketch", Loop.HOSTILE, self._hostile()

    def _long_move(self) -> Iterator[Action]:
        steps = min(_LONG_MOVE_STEPS, 4 * BUDGET_CYCLES // self.period)
        steps = max(steps, 2 * self.ramp_steps + 100)
        yield self.call(CallKind.MOVE_TO, steps)
        yield Wait(self.clocks(steps) // 2)
        yield self.read
        yield Wait(self.clocks(steps) // 2)
        yield self.read

    def _short_moves(self) -> Iterator[Action]:
        middle = self.clocks(_SHORT_MOVES // 2)
        yield from self.moves(self.thinned(range(1, _SHORT_MOVES + 1), 2 * middle))

    def _triangles(self) -> Iterator[Action]:
        part = max(2 * self.ramp_steps // 9, 2)
        lengths = (-part - 1, part, 1 - part, part // 2, -part // 3, part + 7)
        for steps in self.thinned(lengths, self.clocks(part)):
            yield self.call(CallKind.MOVE, steps)
            yield Wait(self.clocks(steps))
            yield self.read

    def _endless(self) -> Iterator[Action]:
        """
        Run either way, turn round, take that back, and stop.
        """
        part = min(self.clocks(self.ramp_steps), BUDGET_CYCLES) // 8 + 2 * self.first
        for kind in (
            CallKind.RUN_FORWARD,
            CallKind.RUN_BACKWARD,
            CallKind.RUN_FORWARD,
            CallKind.RUN_FORWARD,
            CallKind.RUN_BACKWARD,
        ):
            yield self.call(kind)
            yield self.read
            yield Wait(2 * part if kind is CallKind.RUN_BACKWARD else part)
            yield self.read
        yield self.call(CallKind.MOVE_TO, 3)
        yield Wait(2 * part)
        yield self.read
        yield self.call(CallKind.RUN_BACKWARD)
        yield Wait(3 * part)
        yield self.call(CallKind.STOP)
        yield self.read
        yield Wait(2 * part)
        yield self.read

    def _queued(self) -> Iterator[Action]:
        """
        Ask for more than there is room for; read while it is made, and once more after a stop.
        """
        targets = [place * (-1) ** place for place in range(1, self.queue + 4)]
        for ending in (None, CallKind.STOP, CallKind.HALT, CallKind.MOVE_TO):
            yield self.call(CallKind.SET_POSITION, 0)
            yield self.call(CallKind.QUEUE_MOVE_TO, 5)
            yield Wait(self.first // 2)
            for target in (5, 5, *targets, targets[self.queue - 1]):
                yield self.call(CallKind.QUEUE_MOVE_TO, target)
            yield self.read
            for _ in targets:
                yield Wait(2 * self.first)
                yield self.read
                yield self.call(CallKind.QUEUE_MOVE_TO, 2)
            if ending:
                yield self.call(ending)
                yield self.read
                yield Wait(self.clocks(5))
            else:
                yield Wait(sum(self.clocks(place) for place in range(7, 2 * len(targets), 2)))
            yield self.read
        yield self.call(CallKind.RUN_FORWARD)
        yield self.call(CallKind.QUEUE_MOVE_TO, 2)
        yield self.call(CallKind.HALT)

    def _refused(self) -> Iterator[Action]:
        """
        Ask for what it refuses, at rest and while it runs.
        """
        too_fast = (self.cruise_256 - 1, 0, 1, FRACTIONS)
        for kind in (None, CallKind.RUN_FORWARD):
            if kind:
                yield self.call(kind)
            for interval in too_fast:
                yield Call(CallKind.SET_PACE, self.index, top=interval)
                yield self.read
                yield Wait(self.first // 5)
        for kind in (
            CallKind.SET_POSITION,
            CallKind.HOLD,
            CallKind.RELEASE,
            CallKind.QUEUE_MOVE_TO,
        ):
            yield self.call(kind, 1_234)
            yield self.read
            yield Wait(self.first // 5)
        yield self.call(CallKind.STOP)
        yield Wait(self.clocks(20))
        yield self.read

    def _positions(self) -> Iterator[Action]:
        """
        Begin near the ends of the numbers, and go over them.
        """
        for position in (FURTHEST - 2, -FURTHEST - 1, 1_000, -1):
            yield self.call(CallKind.SET_POSITION, position)
            yield self.read
            for steps in (5, -9):
                yield self.call(CallKind.MOVE, steps)
                yield Wait(self.clocks(9))
                yield self.read
        yield self.call(CallKind.SET_POSITION, 0)
        yield self.call(CallKind.MOVE_TO, -FURTHEST - 1)
        yield Wait(2 * self.first)
        yield self.read
        yield self.call(CallKind.MOVE_TO, FURTHEST)
        yield Wait(4 * self.first)
        yield self.read
        yield self.call(CallKind.INIT)
        yield self.read

    def _outputs(self) -> Iterator[Action]:
        """
        Switch the current at rest, before a move, in it and after it, and halt in all of these.
        """
        for kind in (CallKind.HOLD, CallKind.RELEASE, CallKind.HOLD, CallKind.HALT):
            yield self.call(kind)
            yield self.read
        for kind in (CallKind.HOLD, CallKind.RELEASE, CallKind.HALT, CallKind.INIT):
            yield self.call(CallKind.MOVE, 3)
            yield Wait(self.clocks(3) - self.first // 2 - SETTLE_CYCLES)
            yield self.call(kind)  # before the coils go off, where they do
            yield self.read
            yield Wait(self.first)
            yield self.call(CallKind.MOVE, -2)
            yield Wait(self.first // 2)
            yield self.call(kind)
            yield self.read
            yield Wait(self.clocks(3))
            yield self.call(kind)
            yield self.read

    def _hostile(self) -> Iterator[Action]:
        """
        Go to and fro while the sketch does all that it may do.
        """
        lengths = (1, 2, 3, 40, self.ramp_steps // 4 + 1, self.ramp_steps + 1)
        yield from self.moves(self.thinned(lengths, 4 * self.clocks(lengths[-1])))
        steps = min(500, BUDGET_CYCLES // (12 * self.period))
        yield self.call(CallKind.MOVE, steps)
        yield self.pace(3 * self.cruise_256)
        yield Wait(self.clocks(steps, 3 * self.cruise_256))
        yield self.read


def _kinds(plan: Plan, index: int, ladder: Ladder) -> Iterator[FromRest | InFlight | AtLimits]:
    yield FromRest(plan, index, ladder)
    yield InFlight(plan, index, ladder)
    limits = planned_limits(plan.motors[index])
    if limits:
        yield AtLimits(plan, index, ladder, limits)


def _together(axes: Sequence[AxisSketch]) -> Iterator[Action]:
    """
    Let all of them run at once, each on a way of its own, and turn round one by one.
    """
    for number, axis in enumerate(axes):
        yield axis.call(CallKind.MOVE, (2_000 + 17 * number) * (-1) ** number)
    longest = min(max(axis.clocks(2_000) for axis in axes), 2 * BUDGET_CYCLES)
    for axis in axes:
        yield Wait(longest // (2 * len(axes)) + 33)
        yield axis.call(CallKind.MOVE_TO, 0)
        yield axis.read
    yield Wait(longest)
    for axis in axes:
        yield axis.call(CallKind.STOP)
        yield axis.read
    yield Wait(longest)
    yield from (axis.read for axis in axes)

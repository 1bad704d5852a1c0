"""
Scenarios for axes: moves of all lengths, and calls at every point of a ramp and of a period.
"""

from collections.abc import Iterator, Sequence
from itertools import cycle
from random import Random

from stepgen.plan.model import Plan
from stepgen.reference.climb import Climb
from stepgen.reference.ladder import Ladder
from stepgen.reference.timer import FRACTIONS
from stepgen.verify.bench import Call, CallKind, Loop
from stepgen.verify.ladders import ladder_of
from stepgen.verify.late_scenarios import hold_up
from stepgen.verify.scenarios import Action, Scenario, Wait

_BUDGET_CYCLES = 12_000_000  # of a scenario, about: longer ones are thinned out
_LONG_MOVE_STEPS = 10_000
_MANY_STEPS = 1_000_000
_SHORT_MOVES = 60
_SETTLE_CYCLES = 5_000
_LONGEST_HOLD_CYCLES = 30_000
_FIRST_STEPS = 5
_FURTHEST = (1 << 31) - 1
_RANDOM_TARGETS = 60
_SEED = 20_261_201

Named = tuple[str, Loop, Iterator[Action]]


def axis_scenarios(plan: Plan) -> Iterator[Scenario]:
    """
    Yield the scenarios for each axis of *plan*, and for all of them together.
    """
    axes = [
        AxisSketch(plan, index, ladder)
        for index, motor in enumerate(plan.motors)
        if (ladder := ladder_of(motor.motion))
    ]
    for axis in axes:
        for name, loop, actions in axis.scenarios():
            yield Scenario(f"{axis.name}: {name}", loop, tuple(actions))
    if len(axes) > 1:
        yield Scenario("all axes at once", Loop.BUSY, tuple(_together(axes)))


class AxisSketch:
    """
    What a sketch does with axis number *index* of *plan*, which climbs on *ladder*.
    """

    def __init__(self, plan: Plan, index: int, ladder: Ladder) -> None:
        motor = plan.motors[index]
        self.name = motor.name
        self._index = index
        self._queue = motor.motion.queue
        self._cruise_256 = motor.motion.cruise_interval_256
        self._ladder = ladder
        self._period = self._cruise_256 // FRACTIONS
        goal = self._ladder.levels[self._ladder.goal(self._cruise_256)]
        self.ramp_steps = goal.height
        self._first = self._ladder.first_interval_256 // FRACTIONS

    def scenarios(self) -> Iterator[Named]:
        """
        Yield name, loop and actions of each.
        """
        yield "a long move at full speed", Loop.BUSY, self._long_move()
        yield "short moves both ways", Loop.BUSY, self._short_moves()
        yield "moves that do not come to full speed", Loop.SLEEP, self._triangles()
        yield "halts and stops at every point of the first steps", Loop.BUSY, self._first_steps()
        yield "stops at many points of a ramp", Loop.BUSY, self._stops()
        yield "calls at every point of a period at full speed", Loop.BUSY, self._at_speed()
        yield "turns at every point of a period at full speed", Loop.BUSY, self._turns()
        yield "targets that change in flight", Loop.BUSY, self._targets()
        yield "speeds that change in flight", Loop.BUSY, self._speeds()
        yield "endless runs", Loop.BUSY, self._endless()
        if self._queue:
            yield "a queue that is full", Loop.BUSY, self._queued()
        yield "refused calls", Loop.BUSY, self._refused()
        yield "positions that are set", Loop.BUSY, self._positions()
        yield "outputs on and off", Loop.BUSY, self._outputs()
        yield "interrupts held up", Loop.BUSY, self._held_up()
        yield "a busy, hostile sketch", Loop.HOSTILE, self._hostile()

    def call(self, kind: CallKind, steps: int = 0) -> Call:
        """
        Return the call *kind* of this axis.
        """
        return Call(kind, self._index, steps=steps)

    def pace(self, interval_256: int) -> Call:
        """
        Return the call that sets its shortest interval, within what it accepts.
        """
        within = min(max(interval_256, self._cruise_256), 0xFFFF_FFFF)
        return Call(CallKind.SET_PACE, self._index, top=within)

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
        climb = Climb(self._ladder, pace_256 or self._cruise_256)
        climb.begin(abs(steps))
        total_256 = climb.interval_256
        for _ in range(abs(steps)):
            climb.step()
            total_256 += climb.interval_256
        return total_256 // FRACTIONS + _SETTLE_CYCLES

    def _thinned(self, points: Sequence[int], clocks_each: int) -> Sequence[int]:
        """
        Return as many of *points* as fit the budget if each takes so long.
        """
        most = max(_BUDGET_CYCLES // max(clocks_each, 1), 1)
        return points[:: -(-len(points) // most)]

    def _long_move(self) -> Iterator[Action]:
        steps = min(_LONG_MOVE_STEPS, 4 * _BUDGET_CYCLES // self._period)
        steps = max(steps, 2 * self.ramp_steps + 100)
        yield self.call(CallKind.MOVE_TO, steps)
        yield Wait(self.clocks(steps) // 2)
        yield self.read
        yield Wait(self.clocks(steps) // 2)
        yield self.read

    def _moves(self, lengths: Sequence[int]) -> Iterator[Action]:
        """
        Go each of *lengths* forward and backward, and read.
        """
        for steps in lengths:
            for way in (steps, -steps):
                yield self.call(CallKind.MOVE, way)
                yield Wait(self.clocks(steps))
            yield self.read

    def _short_moves(self) -> Iterator[Action]:
        middle = self.clocks(_SHORT_MOVES // 2)
        yield from self._moves(self._thinned(range(1, _SHORT_MOVES + 1), 2 * middle))

    def _triangles(self) -> Iterator[Action]:
        part = max(2 * self.ramp_steps // 9, 2)
        lengths = (-part - 1, part, 1 - part, part // 2, -part // 3, part + 7)
        for steps in self._thinned(lengths, self.clocks(part)):
            yield self.call(CallKind.MOVE, steps)
            yield Wait(self.clocks(steps))
            yield self.read

    def _first_steps(self) -> Iterator[Action]:
        """
        Halt, stop, turn and go on at points of the first steps, a few clocks further each time.
        """
        begin = self.clocks(2) // 2
        longest = self.clocks(2 * _FIRST_STEPS)
        points = range(0, longest // 2, 37)
        ways = cycle(
            (
                (CallKind.HALT, 0),
                (CallKind.STOP, 0),
                (CallKind.RUN_BACKWARD, 0),
                (CallKind.MOVE, -3),
                (CallKind.MOVE, 2),
            )
        )
        thinned = self._thinned(points, (2 * longest + self._first) // 4)
        for offset, (kind, steps) in zip(thinned, ways, strict=False):
            yield self.call(CallKind.RUN_FORWARD)
            yield Wait(begin // 2 + offset)
            yield self.call(kind, steps)
            yield self.read
            yield Wait(self._first + offset % 101)
            yield self.call(CallKind.HALT)
            yield self.read

    def _stops(self) -> Iterator[Action]:
        """
        Stop on the way up, on the flat and on the way down.
        """
        steps = 2 * self.ramp_steps // 9 + 20
        whole = self.clocks(steps)
        for part in self._thinned((7, 5, 2, 10, 3, 8, 1, 11, 6, 9), whole):
            yield self.call(CallKind.MOVE, steps if part % 2 else -steps)
            yield Wait(whole * part // 12)
            yield self.call(CallKind.STOP)
            yield self.read
            yield Wait(whole)
            yield self.read

    def _to_speed(self) -> Iterator[Action]:
        yield self.call(CallKind.RUN_FORWARD)
        yield Wait(self.clocks(self.ramp_steps) + 2 * self._first)
        yield self.read

    def _at_speed(self) -> Iterator[Action]:
        """
        Make calls that let it run on, a clock later each time; what they change shows at once.
        """
        yield from self._to_speed()
        some = cycle(
            (
                self.call(CallKind.MOVE, _MANY_STEPS),
                self.pace(self._cruise_256 + 60 * FRACTIONS + 77),
                self.call(CallKind.RUN_FORWARD),
                self.pace(self._cruise_256),
                self.call(CallKind.MOVE_TO, _FURTHEST // 2),
                self.read,
            )
        )
        points = self._thinned(range(self._period + 60), 3 * self._period)
        for offset, call in zip(points, some, strict=False):
            yield call
            yield Wait(self._period + offset)
        yield self.call(CallKind.HALT)
        yield self.read

    def _turns(self) -> Iterator[Action]:
        """
        Begin to stop, to turn round or to slow down, and take it back a little later.
        """
        yield from self._to_speed()
        some = cycle(
            (
                self.call(CallKind.STOP),
                self.call(CallKind.RUN_BACKWARD),
                self.call(CallKind.MOVE, 1),
                self.pace(3 * self._cruise_256),
                self.call(CallKind.MOVE, -_MANY_STEPS),
            )
        )
        points = self._thinned(range(0, self._period + 60, 3), 8 * self._period)
        for offset, call in zip(points, some, strict=False):
            yield call
            yield Wait(3 * self._period + offset)
            yield self.read
            yield self.pace(self._cruise_256)
            yield self.call(CallKind.RUN_FORWARD)
            yield Wait(2 * self._period)
        yield self.call(CallKind.HALT)
        yield self.read

    def _targets(self) -> Iterator[Action]:
        """
        Name another target at many points of a move: farther, nearer, behind, here; then at random.
        """
        steps = 12
        whole = self.clocks(3 * steps)
        others = (3 * steps, steps // 2, -steps, 0, steps, steps + 1, steps - 1)
        points = [(part, target) for part in range(1, 9) for target in others]
        chosen = self._thinned(range(len(points)), whole)
        for part, target in (points[number] for number in chosen):
            yield self.call(CallKind.SET_POSITION, 0)
            yield self.call(CallKind.MOVE_TO, steps)
            yield Wait(self.clocks(steps) * part // 8)
            yield self.call(CallKind.MOVE_TO, target)
            yield self.read
            yield Wait(whole)
            yield self.read
        random = Random(_SEED)  # noqa: S311 - repeatable, not secret
        for _ in range(_RANDOM_TARGETS):
            yield self.call(CallKind.MOVE_TO, random.randrange(-2 * steps, self.ramp_steps + steps))
            yield Wait(random.randrange(1, _BUDGET_CYCLES // _RANDOM_TARGETS))
            yield self.read
        yield self.call(CallKind.HALT)

    def _speeds(self) -> Iterator[Action]:
        """
        Set speeds up and down while it runs, slower than it begins and as fast as it can.
        """
        ramp = self.clocks(self.ramp_steps)
        first = self._ladder.first_interval_256
        yield self.call(CallKind.RUN_BACKWARD)
        for interval in (
            2 * self._cruise_256,
            self._cruise_256,
            3 * self._cruise_256 + 1,
            self._cruise_256 + 1,
            first - 1,
            self._cruise_256,
            first + 5,
            2 * first,
            2 * self._cruise_256,
        ):
            yield Wait(min(ramp // 8, _BUDGET_CYCLES // 8) + self._first // 2)
            yield self.pace(interval)
            yield self.read
        yield Wait(ramp // 8)
        yield self.call(CallKind.STOP)
        yield Wait(ramp // 2)
        yield self.call(CallKind.HALT)
        yield self.pace(2 * first)
        yield self.call(CallKind.MOVE, 3)
        yield Wait(self.clocks(3, 2 * first))
        yield self.read

    def _endless(self) -> Iterator[Action]:
        """
        Run either way, turn round, take that back, and stop.
        """
        part = min(self.clocks(self.ramp_steps), _BUDGET_CYCLES) // 8 + 2 * self._first
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
        targets = [place * (-1) ** place for place in range(1, self._queue + 4)]
        for ending in (None, CallKind.STOP, CallKind.HALT, CallKind.MOVE_TO):
            yield self.call(CallKind.SET_POSITION, 0)
            yield self.call(CallKind.QUEUE_MOVE_TO, 5)
            yield Wait(self._first // 2)
            for target in (5, 5, *targets, targets[self._queue - 1]):
                yield self.call(CallKind.QUEUE_MOVE_TO, target)
            yield self.read
            for _ in targets:
                yield Wait(2 * self._first)
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
        too_fast = (self._cruise_256 - 1, 0, 1, FRACTIONS)
        for kind in (None, CallKind.RUN_FORWARD):
            if kind:
                yield self.call(kind)
            for interval in too_fast:
                yield Call(CallKind.SET_PACE, self._index, top=interval)
                yield self.read
                yield Wait(self._first // 5)
        for kind in (
            CallKind.SET_POSITION,
            CallKind.HOLD,
            CallKind.RELEASE,
            CallKind.QUEUE_MOVE_TO,
        ):
            yield self.call(kind, 1_234)
            yield self.read
            yield Wait(self._first // 5)
        yield self.call(CallKind.STOP)
        yield Wait(self.clocks(20))
        yield self.read

    def _positions(self) -> Iterator[Action]:
        """
        Begin near the ends of the numbers, and go over them.
        """
        for position in (_FURTHEST - 2, -_FURTHEST - 1, 1_000, -1):
            yield self.call(CallKind.SET_POSITION, position)
            yield self.read
            for steps in (5, -9):
                yield self.call(CallKind.MOVE, steps)
                yield Wait(self.clocks(9))
                yield self.read
        yield self.call(CallKind.SET_POSITION, 0)
        yield self.call(CallKind.MOVE_TO, -_FURTHEST - 1)
        yield Wait(2 * self._first)
        yield self.read
        yield self.call(CallKind.MOVE_TO, _FURTHEST)
        yield Wait(4 * self._first)
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
            yield Wait(self.clocks(3) - self._first // 2 - _SETTLE_CYCLES)
            yield self.call(kind)  # before the coils go off, where they do
            yield self.read
            yield Wait(self._first)
            yield self.call(CallKind.MOVE, -2)
            yield Wait(self._first // 2)
            yield self.call(kind)
            yield self.read
            yield Wait(self.clocks(3))
            yield self.call(kind)
            yield self.read

    def _held_up(self) -> Iterator[Action]:
        """
        Hold interrupts up at full speed and in the ramps, for less and more than a period.
        """
        random = Random(_SEED)  # noqa: S311 - repeatable, not secret
        yield from self._to_speed()
        for part in range(1, 40):
            yield Wait(self._period + part * self._period // 13)
            yield hold_up(min(part * self._period // 8 + 100, _LONGEST_HOLD_CYCLES))
            yield self.read
        steps = 2 * self.ramp_steps + 50
        yield self.call(CallKind.MOVE, -steps)
        left = min(self.clocks(steps) + self.clocks(2 * self.ramp_steps), 2 * _BUDGET_CYCLES)
        while left > 0:
            gap = random.randrange(1, max(left // 16, 2)) + 10 * self._period
            left -= gap
            yield Wait(gap)
            yield hold_up(int(2 ** random.uniform(6, 14.8)))
            yield self.read
        yield self.call(CallKind.HALT)
        yield self.read

    def _hostile(self) -> Iterator[Action]:
        """
        Go to and fro while the sketch does all that it may do.
        """
        lengths = (1, 2, 3, 40, self.ramp_steps // 4 + 1, self.ramp_steps + 1)
        yield from self._moves(self._thinned(lengths, 4 * self.clocks(lengths[-1])))
        steps = min(500, _BUDGET_CYCLES // (12 * self._period))
        yield self.call(CallKind.MOVE, steps)
        yield self.pace(3 * self._cruise_256)
        yield Wait(self.clocks(steps, 3 * self._cruise_256))
        yield self.read


def _together(axes: Sequence[AxisSketch]) -> Iterator[Action]:
    """
    Let all of them run at once, each on a way of its own, and turn round one by one.
    """
    for number, axis in enumerate(axes):
        yield axis.call(CallKind.MOVE, (2_000 + 17 * number) * (-1) ** number)
    longest = min(max(axis.clocks(2_000) for axis in axes), 2 * _BUDGET_CYCLES)
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

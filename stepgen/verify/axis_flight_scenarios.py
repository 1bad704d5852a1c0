"""
Scenarios of axes in flight: calls at every point of a ramp and of a period, and held up interrupts.
"""

from collections.abc import Iterator
from itertools import cycle
from random import Random

from stepgen.reference.timer import FRACTIONS
from stepgen.verify.axis_sketch import BUDGET_CYCLES, FURTHEST, AxisSketch
from stepgen.verify.bench import CallKind, Loop
from stepgen.verify.late_scenarios import hold_up
from stepgen.verify.scenarios import Action, Wait

_MANY_STEPS = 1_000_000
_LONGEST_HOLD_CYCLES = 30_000
_FIRST_STEPS = 5
_RANDOM_TARGETS = 60
_SEED = 20_261_201


class InFlight(AxisSketch):
    """
    What a sketch does with an axis that is under way.
    """

    def scenarios(self) -> Iterator[tuple[str, Loop, Iterator[Action]]]:
        """
        Yield name, loop and actions of each.
        """
        yield "halts and stops at every point of the first steps", Loop.BUSY, self._first_steps()
        yield "stops at many points of a ramp", Loop.BUSY, self._stops()
        yield "calls at every point of a period at full speed", Loop.BUSY, self._at_speed()
        yield "turns at every point of a period at full speed", Loop.BUSY, self._turns()
        yield "targets that change in flight", Loop.BUSY, self._targets()
        yield "speeds that change in flight", Loop.BUSY, self._speeds()
        yield "interrupts held up", Loop.BUSY, self._held_up()

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
        thinned = self.thinned(points, (2 * longest + self.first) // 4)
        for offset, (kind, steps) in zip(thinned, ways, strict=False):
            yield self.call(CallKind.RUN_FORWARD)
            yield Wait(begin // 2 + offset)
            yield self.call(kind, steps)
            yield self.read
            yield Wait(self.first + offset % 101)
            yield self.call(CallKind.HALT)
            yield self.read

    def _stops(self) -> Iterator[Action]:
        """
        Stop on the way up, on the flat and on the way down.
        """
        steps = 2 * self.ramp_steps // 9 + 20
        whole = self.clocks(steps)
        for part in self.thinned((7, 5, 2, 10, 3, 8, 1, 11, 6, 9), whole):
            yield self.call(CallKind.MOVE, steps if part % 2 else -steps)
            yield Wait(whole * part // 12)
            yield self.call(CallKind.STOP)
            yield self.read
            yield Wait(whole)
            yield self.read

    def _at_speed(self) -> Iterator[Action]:
        """
        Make calls that let it run on, a clock later each time; what they change shows at once.
        """
        yield from self.to_speed()
        some = cycle(
            (
                self.call(CallKind.MOVE, _MANY_STEPS),
                self.pace(self.cruise_256 + 60 * FRACTIONS + 77),
                self.call(CallKind.RUN_FORWARD),
                self.pace(self.cruise_256),
                self.call(CallKind.MOVE_TO, FURTHEST // 2),
                self.read,
            )
        )
        points = self.thinned(range(self.period + 60), 3 * self.period)
        for offset, call in zip(points, some, strict=False):
            yield call
            yield Wait(self.period + offset)
        yield self.call(CallKind.HALT)
        yield self.read

    def _turns(self) -> Iterator[Action]:
        """
        Begin to stop, to turn round or to slow down, and take it back a little later.
        """
        yield from self.to_speed()
        some = cycle(
            (
                self.call(CallKind.STOP),
                self.call(CallKind.RUN_BACKWARD),
                self.call(CallKind.MOVE, 1),
                self.pace(3 * self.cruise_256),
                self.call(CallKind.MOVE, -_MANY_STEPS),
            )
        )
        points = self.thinned(range(0, self.period + 60, 3), 8 * self.period)
        for offset, call in zip(points, some, strict=False):
            yield call
            yield Wait(3 * self.period + offset)
            yield self.read
            yield self.pace(self.cruise_256)
            yield self.call(CallKind.RUN_FORWARD)
            yield Wait(2 * self.period)
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
        chosen = self.thinned(range(len(points)), whole)
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
            yield Wait(random.randrange(1, BUDGET_CYCLES // _RANDOM_TARGETS))
            yield self.read
        yield self.call(CallKind.HALT)

    def _speeds(self) -> Iterator[Action]:
        """
        Set speeds up and down while it runs, slower than it begins and as fast as it can.
        """
        ramp = self.clocks(self.ramp_steps)
        first = self.ladder.first_interval_256
        yield self.call(CallKind.RUN_BACKWARD)
        for interval in (
            2 * self.cruise_256,
            self.cruise_256,
            3 * self.cruise_256 + 1,
            self.cruise_256 + 1,
            first - 1,
            self.cruise_256,
            first + 5,
            2 * first,
            2 * self.cruise_256,
        ):
            yield Wait(min(ramp // 8, BUDGET_CYCLES // 8) + self.first // 2)
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

    def _held_up(self) -> Iterator[Action]:
        """
        Hold interrupts up at full speed and in the ramps, for less and more than a period.
        """
        random = Random(_SEED)  # noqa: S311 - repeatable, not secret
        yield from self.to_speed()
        for part in range(1, 40):
            yield Wait(self.period + part * self.period // 13)
            yield hold_up(min(part * self.period // 8 + 100, _LONGEST_HOLD_CYCLES))
            yield self.read
        steps = 2 * self.ramp_steps + 50
        yield self.call(CallKind.MOVE, -steps)
        left = min(self.clocks(steps) + self.clocks(2 * self.ramp_steps), 2 * BUDGET_CYCLES)
        while left > 0:
            gap = random.randrange(1, max(left // 16, 2)) + 10 * self.period
            left -= gap
            yield Wait(gap)
            yield hold_up(int(2 ** random.uniform(6, 14.8)))
            yield self.read
        yield self.call(CallKind.HALT)
        yield self.read

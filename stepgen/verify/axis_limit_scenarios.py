"""
Scenarios for the limits of axes: switches that are met at any moment, ranges, and homing.
"""

from collections.abc import Iterator

from stepgen.plan.model import Plan
from stepgen.reference.climb import Climb
from stepgen.reference.end_stops import EndStopFacts, HomingFacts
from stepgen.reference.ladder import Ladder
from stepgen.reference.timer import FRACTIONS
from stepgen.verify.axis_sketch import BUDGET_CYCLES, FURTHEST, AxisSketch
from stepgen.verify.bench import SWITCH_BITS, Call, CallKind, Loop
from stepgen.verify.scenarios import Action, Wait

_LONGEST_SEARCH_CYCLES = 20 * BUDGET_CYCLES
_POINTS = 40
_MOVES = (
    CallKind.MOVE_TO,
    CallKind.MOVE,
    CallKind.QUEUE_MOVE_TO,
    CallKind.RUN_FORWARD,
    CallKind.RUN_BACKWARD,
)
_WAYS = {CallKind.RUN_BACKWARD: "low", CallKind.RUN_FORWARD: "high"}


class AtLimits(AxisSketch):
    """
    What a sketch does with an axis, and what happens to it at the ends *limits* of its way.
    """

    def __init__(self, plan: Plan, index: int, ladder: Ladder, limits: EndStopFacts) -> None:
        super().__init__(plan, index, ladder)
        self.limits = limits
        lowest, highest = limits.range or (-1_000, 1_000)
        self.lowest, self.highest = lowest, highest
        self.middle = (lowest + highest) // 2

    def scenarios(self) -> Iterator[tuple[str, Loop, Iterator[Action]]]:
        """
        Yield name, loop and actions of each.
        """
        yield "emergency stops", Loop.BUSY, self._emergencies()
        if self.limits.switches:
            yield "switches that are run into", Loop.BUSY, self._switches()
            yield "a switch at every point of a step", Loop.BUSY, self._every_point()
        if self.limits.range:
            yield "moves beyond the range", Loop.BUSY, self._beyond()
        if self.limits.homing:
            homing = Homing(self, self.limits.homing)
            yield "homing", Loop.BUSY, homing.found()
            yield "homing that finds nothing", Loop.SLEEP, homing.not_found()
            yield "calls while homing", Loop.BUSY, homing.disturbed()

    def press(self, *ends: str) -> Call:
        """
        Return what presses the switches at *ends*, those that there are, and lets go the others.
        """
        bits = sum(SWITCH_BITS[end] for end in ends if end in self.limits.switches)
        return Call(CallKind.PRESS, self.index, bits)

    def anew(self) -> Iterator[Action]:
        """
        Let go the switches, halt, forget what was, and begin in the middle of the range.
        """
        yield self.press()
        yield self.call(CallKind.HALT)
        yield self.call(CallKind.CLEAR_FAULT)
        yield self.call(CallKind.SET_POSITION, self.middle)

    def refused(self) -> Iterator[Action]:
        """
        Ask for all that is refused after a fault or while homing.
        """
        for kind in _MOVES:
            yield self.call(kind, self.middle)
        yield self.pace(3 * self.cruise_256)
        yield self.pace(self.cruise_256)
        yield self.call(CallKind.SET_POSITION, self.middle)
        yield self.call(CallKind.HOME)
        yield self.read

    def _emergencies(self) -> Iterator[Action]:
        """
        Stop at rest, before the first step, in a ramp and at the end, and clear the fault again.
        """
        for wait in (0, self.first // 2, 3 * self.first, self.clocks(9) - self.first // 2):
            yield from self.anew()
            if wait:
                yield self.call(CallKind.MOVE, 9)
                yield Wait(wait)
            yield self.call(CallKind.EMERGENCY_STOP)
            yield self.read
            yield from self.refused()
            yield Wait(2 * self.first)
            yield self.call(CallKind.HOLD)
            yield self.call(CallKind.RELEASE)
            yield self.call(CallKind.CLEAR_FAULT)
            yield self.read
            yield self.call(CallKind.MOVE, -2)
            yield Wait(self.clocks(3))
            yield self.read
        yield self.call(CallKind.EMERGENCY_STOP)
        yield self.call(CallKind.INIT)
        yield self.read

    def _switches(self) -> Iterator[Action]:
        """
        Run into each switch, stay on it, leave it, and pass by one that does not matter.
        """
        for run, end in _WAYS.items():
            other = "low" if end == "high" else "high"
            away = CallKind.RUN_FORWARD if end == "low" else CallKind.RUN_BACKWARD
            for before in (0, 5 * self.first, self.clocks(self.ramp_steps // 3)):
                yield from self.anew()
                yield self.call(run)
                yield Wait(before + self.first // 3)
                yield self.press(other)
                yield Wait(2 * self.first)
                yield self.press(end)
                yield Wait(2 * self.first)
                yield from self.refused()
                yield self.call(CallKind.CLEAR_FAULT)
                yield self.call(run)  # into it again
                yield Wait(2 * self.first)
                yield self.read
                yield self.call(CallKind.CLEAR_FAULT)
                yield self.call(away)
                yield Wait(2 * self.first)
                yield self.press(end, other)  # now the other one stops it
                yield Wait(2 * self.first)
                yield self.read
        yield from self.anew()

    def _every_point(self) -> Iterator[Action]:
        """
        Press a switch at many points of the first interval, and of one at speed.
        """
        for run, end in _WAYS.items():
            if end not in self.limits.switches:
                continue
            for base, length in ((0, self.first), (self.clocks(40), 2 * self.period)):
                for point in range(_POINTS):
                    yield from self.anew()
                    yield self.call(run)
                    yield Wait(base + length * point // _POINTS + 1)
                    yield self.press(end)
                    yield Wait(self.first + self.first // 4)
                    yield self.read
        yield from self.anew()

    def _beyond(self) -> Iterator[Action]:
        """
        Ask for places beyond the range, from within, from its ends and in flight.
        """
        yield from self.anew()
        for start in (self.middle, self.lowest, self.highest):
            yield self.call(CallKind.SET_POSITION, start)
            for steps in (self.lowest - 1, self.highest + 1, -FURTHEST - 1, FURTHEST):
                yield self.call(CallKind.MOVE_TO, steps)
                yield self.call(CallKind.QUEUE_MOVE_TO, steps)
                yield self.call(CallKind.SET_POSITION, steps)
                yield self.call(CallKind.MOVE, max(min(steps - start, FURTHEST), -FURTHEST - 1))
            for steps in (-FURTHEST - 1, FURTHEST):
                yield self.call(CallKind.MOVE, steps)
            yield self.read
        for run, name in _WAYS.items():
            end = self.lowest if name == "low" else self.highest
            yield self.call(CallKind.SET_POSITION, end)
            yield self.call(run)
            yield self.read
            away = -3 if end == self.highest else 3
            yield self.call(CallKind.SET_POSITION, end + away)
            yield self.call(run)
            yield Wait(self.first)
            yield self.call(CallKind.MOVE, -2 * away)
            yield self.call(CallKind.MOVE_TO, end - away)
            yield self.read
            yield Wait(self.clocks(3))
            yield self.read
        yield from self.anew()


class Homing:
    """
    The ways of *sketch* home, as *facts* have them, and how long they take.
    """

    def __init__(self, sketch: AtLimits, facts: HomingFacts) -> None:
        self.sketch = sketch
        self.facts = facts
        self.home = sketch.call(CallKind.HOME)
        self.other = "low" if facts.towards == "high" else "high"
        self.behind = sketch.ladder.levels[sketch.ladder.goal(facts.fast_256)].height + 1

    def found(self) -> Iterator[Action]:
        """
        Find the switch: far away, near, at once, and twice in a row.
        """
        sketch = self.sketch
        for steps in (3 * self.behind + 20, self.behind // 2 + 3, 1, 0):
            yield from sketch.anew()
            slow_256 = 4 * self.facts.fast_256
            yield sketch.pace(slow_256)
            yield from self._to_contact(steps)
            yield from self._back()
            yield from self._again()
            yield sketch.read
            yield sketch.call(CallKind.MOVE, self.behind)
            yield Wait(sketch.clocks(self.behind, slow_256))
            yield sketch.read
        yield sketch.call(CallKind.EMERGENCY_STOP)
        yield sketch.read
        yield sketch.call(CallKind.CLEAR_FAULT)
        yield sketch.read

    def not_found(self) -> Iterator[Action]:
        """
        Look for a switch that is not there, that stays pressed, or that is not seen again.
        """
        sketch, facts = self.sketch, self.facts
        search = self._clocks(facts.travel, facts.fast_256)
        if search < _LONGEST_SEARCH_CYCLES:
            yield from sketch.anew()
            yield self.home
            yield Wait(search)
            yield sketch.read
            yield from sketch.refused()
        for released in (False, True):
            yield from sketch.anew()
            yield from self._to_contact(3)
            if released:
                yield from self._back()
                yield Wait(self._clocks(2 * facts.back_off, facts.slow_256))
            else:
                yield Wait(3 * self._clocks(facts.back_off + self.behind, facts.fast_256))
            yield sketch.read
        yield from sketch.anew()

    def disturbed(self) -> Iterator[Action]:
        """
        Ask for other things on each way of homing, and end it there; the other switch does so, too.
        """
        sketch = self.sketch
        ends = (CallKind.STOP, CallKind.HALT, CallKind.EMERGENCY_STOP, CallKind.INIT, None)
        for ways in range(4):
            for kind in ends:
                yield from sketch.anew()
                yield sketch.pace(2 * sketch.cruise_256)
                yield from self._until(ways)
                yield from sketch.refused()
                if kind:
                    yield sketch.call(kind)
                    yield sketch.read
                else:
                    yield sketch.press(self.other)
                yield Wait(4 * sketch.first)
                yield sketch.read
                yield sketch.call(CallKind.HALT)
                yield sketch.call(CallKind.CLEAR_FAULT)
                yield sketch.call(CallKind.MOVE_TO, sketch.middle)
                yield Wait(2 * sketch.first)
                yield sketch.read
        yield from sketch.anew()

    def _until(self, ways: int) -> Iterator[Action]:
        """
        Go home until so many ways are over and the next one has begun.
        """
        sketch = self.sketch
        if ways == 0:
            yield self.home
        elif ways == 1:
            yield from self._to_contact(2)
            yield Wait(3 * sketch.first)
        elif ways == 2:  # noqa: PLR2004 - the approach
            yield from self._to_contact(2)
            yield from self._back()
        else:
            yield from self._to_contact(2)
            yield from self._back()
            yield from self._contact_again()
            yield Wait(3 * sketch.first)
        yield Wait(sketch.first // 2)

    def _to_contact(self, steps: int) -> Iterator[Action]:
        """
        Begin, and press the switch after so many steps, or before.
        """
        if steps == 0:
            yield self.sketch.press(self.facts.towards)
        yield self.home
        if steps:
            yield Wait(self._clocks(steps, self.facts.fast_256))
            yield self.sketch.press(self.facts.towards)
        yield self.sketch.read

    def _back(self) -> Iterator[Action]:
        """
        Come to rest behind the switch and leave it half-way back; wait until the approach begins.
        """
        back = self._clocks(self.facts.back_off + self.behind, self.facts.fast_256)
        yield Wait(self._clocks(self.behind, self.facts.fast_256) + back // 3)
        yield self.sketch.press()
        yield Wait(back)
        yield self.sketch.read

    def _contact_again(self) -> Iterator[Action]:
        yield Wait(self._clocks(self.facts.back_off // 2, self.facts.slow_256))
        yield self.sketch.press(self.facts.towards)

    def _again(self) -> Iterator[Action]:
        """
        See the switch on the approach, and leave it while parking.
        """
        yield from self._contact_again()
        yield Wait(2 * self.sketch.first)
        yield self.sketch.press()
        way = abs(self.facts.park - self.facts.position) + self.behind
        yield Wait(self._clocks(way, self.facts.fast_256))

    def _clocks(self, steps: int, pace_256: int) -> int:
        """
        Return how long a way of *steps* takes at that pace at most.
        """
        climb = Climb(self.sketch.ladder, pace_256)
        climb.begin(steps)
        total_256 = climb.interval_256
        for _ in range(steps):
            climb.step()
            total_256 += climb.interval_256
        return total_256 // FRACTIONS

"""
What an axis's variables say, and what holds of them whenever no code of the library runs.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any, Self

import z3

from stepgen.plan.end_stops import EndStops
from stepgen.verify.proof.memory import Place
from stepgen.verify.proof.numbers import wide
from stepgen.verify.proof.ramp import LAPPED_256, Ramp
from stepgen.verify.proof.source import Source
from stepgen.verify.proof.state import Claims

TOUCHED, COAST, ENDLESS, REVERSE, RUNNING, CLIMB, DESCEND, TURNING = (1 << bit for bit in range(8))
"""The bits of ``mode``: kTouched and so on."""

FAR = 1 << 30
"""Steps ahead of an axis that runs without an end: kFar."""

MOST_STEPS = 1 << 31
_ON_THE_WAY = 1 << 17  # two ramps, or a ramp and the steps at one speed: most of what is missing


@dataclass(frozen=True)
class AxisState:
    """
    The variables of *motor* at one moment.

    Args:
        values: The values by place.
        source: What the library declares.
        motor: The motor's name.
        ramp: What it climbs on.
        stops: Its limits, if it has such.
        releases: Whether its coils go off at rest, an interval after the last step.
        named: Gives a term a name.
    """

    values: Mapping[Place, Any]
    source: Source
    motor: str
    ramp: Ramp
    stops: EndStops | None
    releases: bool
    named: Callable[[Any], Any] = lambda value: value

    def of(self, name: str) -> Any:  # noqa: ANN401 - z3 has no types
        """
        Return a field as it is.
        """
        return self.values[f"{self.motor}Motion", name]

    def is_in(self, mode: int) -> Any:  # noqa: ANN401
        """
        Tell whether any bit of *mode* is set.
        """
        return self.of("mode") & mode != 0

    @property
    def count_place(self) -> Place:
        """
        Return where the step interrupt counts down.
        """
        return (self.source.operands[self.motor]["count"],)

    @property
    def count(self) -> Any:  # noqa: ANN401
        """
        Return how many steps of a level the interrupt still counts down.
        """
        return self.values[self.count_place]

    def counting(self, count: Any) -> Self:  # noqa: ANN401
        """
        Return the same with another *count*.
        """
        return replace(self, values={**self.values, self.count_place: count})

    @property
    def following(self) -> Any:  # noqa: ANN401
        """
        Return the steps of the levels that follow by themselves, 16 bits.
        """
        return _steps(self.of("levels"), self.of("length"))

    @property
    def left(self) -> Any:  # noqa: ANN401
        """
        Return the number of steps that are left of this way, as a whole number.
        """
        return self.named(wide(self.of("rest")) + wide(self.following) + wide(self.count))

    @property
    def position(self) -> Any:  # noqa: ANN401
        """
        Return the position modulo 2**32: the end less what is left.
        """
        left = z3.Extract(31, 0, self.left)
        return self.named(self.of("end") + z3.If(self.is_in(REVERSE), left, -left))

    @property
    def level(self) -> Any:  # noqa: ANN401
        """
        Return the number in its row of the level where the motor is.
        """
        rung, levels = self.of("rung"), self.of("levels")
        down = z3.If(self.is_in(DESCEND), rung + levels, rung)
        return z3.simplify(z3.If(self.is_in(CLIMB), rung - levels, down))

    @property
    def last_level(self) -> Any:  # noqa: ANN401
        """
        Return the number of the level to which the interrupt leads by itself.
        """
        rung = self.of("rung")
        return z3.simplify(z3.If(self.is_in(CLIMB), rung + 1, rung))

    @property
    def is_endless(self) -> Any:  # noqa: ANN401
        """
        Tell whether the present way has no end.
        """
        return z3.And(self.is_in(ENDLESS), z3.Not(self.is_in(TURNING)))

    @property
    def has_queue(self) -> bool:
        """
        Tell whether destinations can wait.
        """
        return f"{self.motor}Queue" in self.source.arrays

    @property
    def queued(self) -> Any:  # noqa: ANN401
        """
        Return how many destinations wait.
        """
        return self.values[(f"{self.motor}Queued",)] if self.has_queue else z3.BitVecVal(0, 8)

    @property
    def places(self) -> int:
        """
        Return how many destinations can wait.
        """
        return self.source.arrays[f"{self.motor}Queue"][1]

    def waiting(self, number: int) -> Any:  # noqa: ANN401
        """
        Return the destination that waits as *number*, the next one is 0.
        """
        first = z3.ZeroExt(8, self.values[(f"{self.motor}First",)])
        at = z3.URem(first + number, self.places)
        value = z3.BitVecVal(0, 32)
        for place in range(self.places):
            value = z3.If(at == place, self.values[f"{self.motor}Queue", str(place)], value)
        return value

    @property
    def towards_low(self) -> bool:
        """
        Tell whether it looks for home at the low end.
        """
        return bool(self.stops and self.stops.homing and self.stops.homing.towards == "low")

    def limit(self, name: str) -> Any:  # noqa: ANN401
        """
        Return what the variable *name* of its limits holds; None if it has none of that name.
        """
        return self.values.get((self.motor + name,))

    @property
    def target(self) -> Any:  # noqa: ANN401
        """
        Return where the motor is to be in the end; without an end where it is.
        """
        last = self.of("destination")
        for number in range(self.places if self.has_queue else 0):
            last = z3.If(self.queued == number + 1, self.waiting(number), last)
        return z3.If(self.is_in(ENDLESS), self.position, last)


def facts(state: AxisState) -> Iterator[Any]:
    """
    Yield what is true of the ramp where *state* is.
    """
    ramp, row, rung = state.ramp, state.of("row"), state.of("rung")
    yield from ramp.facts_of_row(row)
    for level in (state.level, rung):
        yield from ramp.facts(row, level)
    for more in (state.of("levels"), rung):
        yield from ramp.facts_of_levels(row, rung, more)
    yield from ramp.facts_of_height(state.of("goal"), row)


def invariant(state: AxisState) -> Claims:
    """
    Return what always holds of *state*, by its name.
    """
    running = state.is_in(RUNNING)
    moves = z3.Or(running, state.is_in(COAST))
    claims = {
        "it runs or it coasts": z3.Not(z3.And(running, state.is_in(COAST))),
        "1 to 255 steps are counted down while it moves": z3.Implies(moves, state.count != 0),
        "a level is as high as the motor may climb": state.ramp.is_level(state.of("goal")),
        "it coasts for laps, if at all": z3.Implies(
            state.is_in(COAST), z3.And(state.releases, state.of("lapsLeft") != 0)
        ),
        "at rest nothing is left": z3.Implies(z3.Not(running), z3.Extract(31, 0, state.left) == 0),
        "at rest no level follows": z3.Implies(z3.Not(running), state.of("levels") == 0),
        "at rest it is where it is to be": z3.Implies(
            z3.Not(running), state.of("end") == state.of("destination")
        ),
        "at rest no mode of a way is left": z3.Implies(
            z3.Not(running), z3.Not(state.is_in(ENDLESS | CLIMB | DESCEND | TURNING))
        ),
        "laps have a level of their own": z3.Implies(
            z3.And(moves, state.of("lapsLeft") != 0),
            z3.And(state.count == 1, state.of("levels") == 0),
        ),
    }
    whole = {says: z3.Implies(running, claim) for says, claim in of_way(state).items()}
    return claims | whole | _of_queue(state) | _of_homing(state)


def many_are_left(state: AxisState) -> Any:  # noqa: ANN401 - z3 has no types
    """
    Tell whether steps enough are left for all that comes before the end is put off again.

    A climb up to the goal takes no more from what is left than it adds to the height, a descent as
    much from both.
    """
    rest = wide(state.of("rest"))
    height = wide(state.ramp.height(state.of("row"), state.last_level))
    above = z3.UGT(height, wide(state.of("goal")))
    return z3.If(above, rest - height, rest + height) >= FAR - _ON_THE_WAY


def goes_far(state: AxisState) -> Any:  # noqa: ANN401 - z3 has no types
    """
    Tell whether a run without an end that comes to rest first is to go far from there, and back.
    """
    away = state.of("destination") - state.of("end")
    back = z3.If(state.is_in(REVERSE), away, -away)
    turns = z3.And(state.is_in(ENDLESS), state.is_in(TURNING))
    return z3.Implies(turns, z3.And(z3.UGE(back, FAR), z3.ULT(back, MOST_STEPS)))


def of_way(state: AxisState) -> Claims:
    """
    Return what holds of *state* while the axis runs.
    """
    ramp, row, rung = state.ramp, state.of("row"), state.of("rung")
    climbs, descends = state.is_in(CLIMB), state.is_in(DESCEND)
    ramps = z3.Or(climbs, descends)
    levels, length = state.of("levels"), state.of("length")
    rest, slope = state.of("rest"), ramp.slope(row)
    there = z3.And(z3.ULT(row, ramp.rows), z3.ULE(rung, ramp.levels(row)))
    climbed = z3.And(z3.ULT(rung, ramp.levels(row)), z3.ULE(levels, rung))
    walked = z3.ULT(wide(rung) + wide(levels), wide(ramp.levels(row)))
    lapped = z3.UGE(state.of("interval"), LAPPED_256)
    arrives = z3.And(z3.Not(state.is_in(ENDLESS | TURNING)))
    return {
        "it climbs or it descends": z3.Not(z3.And(climbs, descends)),
        "it is on the ramp": there,
        "its height is that of the level": state.of("height") == ramp.height(row, rung),
        "a level has 1 to 128 steps, a power of two": z3.Or(
            *(length == 1 << shift for shift in range(8))
        ),
        "a level of the ramp is as long as it is": z3.Implies(ramps, length == ramp.steps(row)),
        "steps are left of a level": z3.Implies(ramps, z3.ULE(state.count, length)),
        "no level has more than 128 steps": z3.ULE(state.count, 128),
        "it climbs no further than its row": z3.Implies(climbs, climbed),
        "it descends no further than its row": z3.Implies(descends, walked),
        "the change is the ramp's, up": z3.Implies(climbs, state.of("change") == -slope),
        "the change is the ramp's, down": z3.Implies(descends, state.of("change") == slope),
        "the interval is the level's": z3.Implies(
            ramps, state.of("interval") == ramp.interval(row, state.level)
        ),
        "levels that follow at one speed change nothing": z3.Implies(
            z3.And(z3.Not(ramps), levels != 0), state.of("change") == 0
        ),
        "the pace is the level's": z3.Implies(
            z3.Not(ramps), state.of("pace") == ramp.interval(row, rung)
        ),
        "there is room to come to rest": z3.UGE(rest, _wide32(ramp.height(row, state.last_level))),
        "at most 2**31 steps are left": state.left <= MOST_STEPS,
        "without an end, many steps are left": z3.Implies(state.is_endless, many_are_left(state)),
        "a run that turns goes far": goes_far(state),
        "an interval with laps has a level of its own": z3.Implies(
            lapped, z3.And(state.count == 1, levels == 0)
        ),
        "the way leads to the destination": z3.Implies(
            arrives, state.of("end") == state.of("destination")
        ),
    }


def _of_queue(state: AxisState) -> Claims:
    if not state.has_queue:
        return {}
    waits = state.queued != 0
    goes = z3.And(state.is_in(RUNNING), z3.Not(state.is_in(ENDLESS)))
    claims = {
        "the queue has so many places": z3.ULE(state.queued, state.places),
        "the first is one of them": z3.ULT(state.values[(f"{state.motor}First",)], state.places),
        "only behind a way with an end others wait": z3.Implies(waits, goes),
    }
    before = state.of("destination")
    for number in range(state.places):
        one = state.waiting(number)
        there = z3.UGT(state.queued, number)
        claims[f"destination {number} is not that before it"] = z3.Implies(there, one != before)
        before = one
    return claims


def _of_homing(state: AxisState) -> Claims:
    homing, goal = state.limit("Homing"), state.limit("Goal")
    if homing is None:
        return {}
    homes, looks = homing != 0, homing & 1 != 0
    no_end = state.is_in(ENDLESS | TURNING)
    on_a_way = z3.And(state.is_in(RUNNING), z3.Not(no_end), state.queued == 0)
    beyond = state.of("end") - state.limit("Contact")
    if state.towards_low:
        beyond = -beyond
    near = z3.And(beyond != 0, z3.ULE(beyond, _ON_THE_WAY))
    return {
        "the speed that homing keeps is a level": state.ramp.is_level(goal),
        "homing is on a way with an end, and nothing waits": z3.Implies(homes, on_a_way),
        "homing has four ways": z3.ULE(homing, 4),
        "it looks for the switch where that is": z3.Implies(
            looks, state.is_in(REVERSE) == state.towards_low
        ),
        "it comes to rest behind the switch that it has seen": z3.Implies(
            z3.And(looks, state.is_in(TOUCHED)), near
        ),
    }


def _steps(levels: Any, length: Any) -> Any:  # noqa: ANN401
    return z3.ZeroExt(8, levels) * z3.ZeroExt(8, length)


def _wide32(value: Any) -> Any:  # noqa: ANN401
    return z3.ZeroExt(32 - value.size(), value)

"""
What parts of an axis need and give, each proven by itself: others rely on that, and on no more.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import z3

from stepgen.verify.proof.axis_state import (
    CLIMB,
    COAST,
    DESCEND,
    ENDLESS,
    FAR,
    MOST_STEPS,
    REVERSE,
    RUNNING,
    TURNING,
    AxisState,
    goes_far,
    many_are_left,
    of_way,
)
from stepgen.verify.proof.numbers import wide, wide_signed
from stepgen.verify.proof.ramp import LAPPED_256

Said = Iterator[tuple[str, Any]]

LAP_TICKS = 1 << 14
_RAMPS = CLIMB | DESCEND


@dataclass(frozen=True)
class Call:
    """
    One call of a part: what was before, what is after, its arguments by name, and what it returns.

    Where it takes or returns a count, that is the state's.
    """

    before: AxisState
    after: AxisState
    arguments: Mapping[str, Any]
    result: Any


@dataclass(frozen=True)
class Part:
    """
    A function that others call, of which only this is known to them.

    Args:
        changes: The fields of the motion that it changes.
        needs: What must hold before it.
        gives: What holds after it.
        counts: Whether it returns the count.
        splits: Whether each mode and each length of a level has ways of its own.
    """

    changes: tuple[str, ...]
    needs: Callable[[AxisState, Mapping[str, Any]], Said]
    gives: Callable[[Call], Said]
    counts: bool = False
    splits: bool = False


def _is_there(state: AxisState) -> Any:  # noqa: ANN401 - z3 has no types
    row, rung = state.of("row"), state.of("rung")
    return z3.And(z3.ULT(row, state.ramp.rows), z3.ULE(rung, state.ramp.levels(row)))


def _needs_of_decide(state: AxisState, _: Mapping[str, Any]) -> Said:
    ramp, row, rung, rest = state.ramp, state.of("row"), state.of("rung"), state.of("rest")
    ends = z3.Not(state.is_in(ENDLESS | TURNING))
    runs = state.of("mode") & (RUNNING | _RAMPS) == RUNNING
    yield "it runs, and neither climbs nor descends", runs
    yield "it is on the ramp", _is_there(state)
    yield "its height is that of the level", state.of("height") == ramp.height(row, rung)
    yield "the pace is the level's", state.of("pace") == ramp.interval(row, rung)
    yield "a level is as high as the motor may climb", ramp.is_level(state.of("goal"))
    yield "there is room to come to rest", z3.UGE(rest, z3.ZeroExt(16, state.of("height")))
    yield "steps are left, at most 2**31", z3.And(rest != 0, z3.ULE(rest, MOST_STEPS))
    yield "without an end, many steps are left", z3.Implies(state.is_endless, many_are_left(state))
    yield "a run that turns goes far", goes_far(state)
    yield (
        "the way leads to the destination",
        z3.Implies(ends, state.of("end") == state.of("destination")),
    )


def _gives_of_decide(call: Call) -> Said:
    """
    Yield what the reference model decides at a level, and that it would at all that follow.
    """
    before, after, ramp = call.before, call.after, call.before.ramp
    row, rung = before.of("row"), before.of("rung")
    height, goal, rest = before.of("height"), before.of("goal"), before.of("rest")
    endless = before.is_endless
    at_end = z3.And(z3.Not(endless), rest == z3.ZeroExt(16, height))
    next_row = z3.If(rung == ramp.levels(row), row + 1, row)
    steps = wide(ramp.steps(next_row))
    room = wide(rest) - wide(height)
    down = z3.Or(z3.UGT(height, goal), at_end)
    up = z3.And(z3.Not(down), z3.ULT(height, goal), z3.Or(endless, room >= 2 * steps))
    flat = z3.And(z3.Not(down), z3.Not(up))
    there = after.of("row")
    yield "it descends as the model does", after.is_in(DESCEND) == down
    yield "it climbs as the model does", after.is_in(CLIMB) == up
    yield from of_way(after).items()
    yield "a step at least is counted down", after.count != 0
    kept = 0xFF & ~_RAMPS
    yield "no other mode changes", after.of("mode") & kept == before.of("mode") & kept
    lower = z3.If(down, wide(ramp.steps(there)), 0)
    level = wide(ramp.height(there, after.level))
    yield "the level is the next one", level == wide(height) - lower
    yield "the steps are those of the level", z3.Or(flat, after.count == ramp.steps(there))
    paces = z3.If(height == goal, before.of("cruise"), before.of("pace"))
    yield "one speed is the cruise or the pace", z3.Implies(flat, after.of("interval") == paces)
    yield "the pace is kept", after.of("pace") == before.of("pace")
    top = ramp.height(there, after.last_level)
    yield (
        "all levels that follow are climbed to the goal at most",
        z3.Implies(up, z3.ULE(top, goal)),
    )
    last = ramp.height(there, after.of("rung") + 1)
    yield (
        "all levels that follow are descended from above the goal, or to rest",
        z3.Implies(z3.And(down, z3.Not(at_end)), z3.UGT(last, goal)),
    )
    put_off = z3.And(flat, endless, z3.ULT(rest, FAR))
    more = z3.If(put_off, z3.BitVecVal(FAR, 32), z3.BitVecVal(0, 32))
    yield "what is left stays, or is far away", after.left == wide(rest) + wide(more)
    ahead = z3.If(before.is_in(REVERSE), -more, more)
    yield "the end stays, or is as far", after.of("end") == before.of("end") + ahead


def _needs_nothing(_: AxisState, __: Mapping[str, Any]) -> Said:
    yield from ()


def _gives_of_next_due(call: Call) -> Said:
    before, after = call.before, call.after
    interval, laps = before.of("interval"), wide(after.of("lapsLeft"))
    parts = z3.ZeroExt(1, before.of("dueFraction")) + z3.ZeroExt(1, z3.Extract(7, 0, interval))
    carry = z3.ZeroExt(15, z3.Extract(8, 8, parts))
    ticks = after.of("due") - before.of("due") - carry
    yield "1/256 clocks add up", after.of("dueFraction") == z3.Extract(7, 0, parts)
    whole = wide(ticks) + LAP_TICKS * laps == wide(z3.Extract(31, 8, interval))
    yield "ticks and laps make up the interval", whole
    yield "a match comes before the timer has gone half round", z3.ULT(ticks, 1 << 15)
    yield "a match before laps is far enough", z3.Implies(laps != 0, z3.UGE(ticks, LAP_TICKS))
    yield "long intervals have laps", (laps != 0) == z3.UGE(interval, LAPPED_256)
    yield "laps leave room for one more", z3.ULT(laps, 0xFFFF)
    yield "it returns what the channel is set to", call.result == after.of("due")


def _needs_of_end_level(state: AxisState, _: Mapping[str, Any]) -> Said:
    yield "it runs", state.is_in(RUNNING)
    yield "no level follows", state.of("levels") == 0
    yield from of_way(state.counting(z3.BitVecVal(1, 8))).items()


def _gives_of_end_level(call: Call) -> Said:
    before, after, ramp = call.before, call.after, call.before.ramp
    row, rung = after.of("row"), after.of("rung")
    kept = after.of("mode") == before.of("mode") & ~_RAMPS
    yield "it keeps its mode, but neither climbs nor descends", kept
    yield "it is on the ramp", _is_there(after)
    yield "its height is that of the level", after.of("height") == ramp.height(row, rung)
    led = ramp.height(before.of("row"), before.last_level)
    yield "the level is that to which the last one led", after.of("height") == led
    yield "the pace is the level's", after.of("pace") == ramp.interval(row, rung)
    yield "it tells whether steps are left", (call.result != 0) == (before.of("rest") != 0)


def _needs_of_redirect(state: AxisState, arguments: Mapping[str, Any]) -> Said:
    yield "it runs", state.is_in(RUNNING)
    yield "a step at least is counted down", state.count != 0
    yield from of_way(state).items()
    endless = arguments["endless"]
    away = arguments["destination"] - state.position
    far = z3.And(endless == ENDLESS, z3.Or(away == FAR, away == -z3.BitVecVal(FAR, 32)))
    yield "it is to end, or to go far", z3.Or(endless == 0, far)


def _gives_of_redirect(call: Call) -> Said:
    """
    Yield what the reference model makes of another destination.
    """
    before, after, ramp = call.before, call.after, call.before.ramp
    to, endless = call.arguments["destination"], call.arguments["endless"]
    kept = RUNNING | DESCEND | REVERSE | COAST
    yield "it keeps its direction", after.of("mode") & kept == before.of("mode") & kept
    yield "it has an end or none, as is asked for", after.of("mode") & ENDLESS == endless
    yield "a call makes no step", after.position == before.position
    yield "it goes there in the end", after.of("destination") == to
    way = to - before.position
    ahead = wide_signed(z3.If(before.is_in(REVERSE), -way, way))
    height, length = wide(ramp.height(before.of("row"), before.level)), wide(before.of("length"))
    climbs = z3.And(before.is_in(CLIMB), ahead >= height + length + wide(before.count))
    yield "it climbs on as the model does", after.is_in(CLIMB) == climbs
    same = z3.Or(climbs, before.is_in(DESCEND))
    count = z3.If(same, before.count, z3.BitVecVal(1, 8))
    yield "it goes on with its level, or ends it with the next step", after.count == count
    yield "the level stays", after.level == before.level
    yield "no level follows by itself", after.of("levels") == 0
    rest = height + wide(count)
    left = z3.If(ahead >= rest, ahead, rest)
    yield "as many steps are left as the model has", after.left == left
    yield "it turns where there is no room", after.is_in(TURNING) == (ahead < rest)
    yield "or comes to rest first", z3.Or(ahead < rest, after.of("end") == to)
    yield from of_way(after).items()


def _needs_of_position(state: AxisState, _: Mapping[str, Any]) -> Said:
    levels, length = state.of("levels"), state.of("length")
    yield "levels of 128 steps at most follow", z3.Or(levels == 0, z3.ULE(length, 128))


def _gives_of_position(call: Call) -> Said:
    yield "the position", call.result == call.before.position


PARTS = {
    "decide": Part(
        changes=(
            *("mode", "interval", "change", "length", "levels", "rest", "end"),
            *("row", "rung", "height"),
        ),
        needs=_needs_of_decide,
        gives=_gives_of_decide,
        counts=True,
    ),
    "nextDue": Part(
        changes=("lapsLeft", "due", "dueFraction"),
        needs=_needs_nothing,
        gives=_gives_of_next_due,
    ),
    "endLevel": Part(
        changes=("mode", "pace", "rung", "height"),
        needs=_needs_of_end_level,
        gives=_gives_of_end_level,
        splits=True,
    ),
    "redirect": Part(
        changes=("mode", "pace", "rung", "height", "levels", "rest", "end", "destination"),
        needs=_needs_of_redirect,
        gives=_gives_of_redirect,
        counts=True,
        splits=True,
    ),
    "positionOf": Part(
        changes=(),
        needs=_needs_of_position,
        gives=_gives_of_position,
    ),
}
"""The parts by their names."""


def goes_on(state: AxisState) -> Iterator[tuple[AxisState, Any]]:
    """
    Yield the states after a step that the interrupt makes by itself, each with when it does that.

    Those are the instructions of the generated interrupt: a step less of the level, or the next
    level, for which the lower three bytes of the change are added to those of the interval.
    """
    own = f"{state.motor}Motion"
    fast = z3.And(state.is_in(RUNNING), state.of("lapsLeft") == 0)
    within = {**state.values, state.count_place: state.count - 1}
    yield replace(state, values=within), z3.And(fast, state.count != 1)
    interval = state.of("interval")
    low = z3.Extract(23, 0, interval) + z3.Extract(23, 0, state.of("change"))
    beyond = {
        **state.values,
        state.count_place: state.of("length"),
        (own, "levels"): state.of("levels") - 1,
        (own, "interval"): z3.Concat(z3.Extract(31, 24, interval), low),
    }
    yield replace(state, values=beyond), z3.And(fast, state.count == 1, state.of("levels") != 0)

"""
What parts of an axis need and give, each proven by itself: others rely on that, and on no more.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import z3

from stepgen.verify.proof.axis_state import (
    CLIMB,
    DESCEND,
    ENDLESS,
    FAR,
    MOST_STEPS,
    REVERSE,
    RUNNING,
    TURNING,
    AxisState,
    of_way,
)
from stepgen.verify.proof.numbers import wide
from stepgen.verify.proof.ramp import LAPPED_256, Ramp

Said = Iterator[tuple[str, Any]]

LAP_TICKS = 1 << 14


@dataclass(frozen=True)
class Part:
    """
    A function that others call, of which only this is known to them.

    Args:
        changes: The fields of the motion that it changes, and ``count``.
        needs: What must hold before it.
        gives: What holds after it.
    """

    changes: tuple[str, ...]
    needs: Callable[[AxisState], Said]
    gives: Callable[[AxisState, AxisState], Said]


def _needs_of_decide(state: AxisState) -> Said:
    ramp, row, rung, rest = state.ramp, state.of("row"), state.of("rung"), state.of("rest")
    known = state.of("rungs") == ramp.levels(row)
    begins = z3.And(row == 0, rung == 0)
    there = z3.And(z3.ULT(row, ramp.rows), z3.ULE(rung, ramp.levels(row)))
    ends = z3.Not(state.is_in(ENDLESS | TURNING))
    yield (
        "it runs, and neither climbs nor descends",
        state.of("mode") & (RUNNING | CLIMB | DESCEND) == RUNNING,
    )
    yield "it is on the ramp", there
    yield "the levels of the row are those of the ramp", z3.Or(known, begins)
    yield "no row is all levels where it begins", z3.Implies(begins, state.of("rungs") != 0)
    yield "its height is that of the level", state.of("height") == ramp.height(row, rung)
    yield "the pace is the level's", state.of("pace") == ramp.interval(row, rung)
    yield "a level is as high as the motor may climb", ramp.is_level(state.of("goal"))
    yield "there is room to come to rest", z3.UGE(rest, z3.ZeroExt(16, state.of("height")))
    yield "steps are left, at most 2**31", z3.And(rest != 0, z3.ULE(rest, MOST_STEPS))
    yield (
        "the way leads to the destination",
        z3.Implies(ends, state.of("end") == state.of("destination")),
    )


def _gives_of_decide(before: AxisState, after: AxisState) -> Said:
    """
    Yield what the reference model decides at a level, and that it would at all that follow.
    """
    ramp, row, rung = before.ramp, before.of("row"), before.of("rung")
    height, goal, rest = before.of("height"), before.of("goal"), before.of("rest")
    endless = before.is_endless
    at_end = z3.And(z3.Not(endless), rest == z3.ZeroExt(16, height))
    next_row = z3.If(rung == ramp.levels(row), row + 1, row)
    steps = wide(ramp.steps(next_row))
    room = wide(rest) - wide(height)
    down = z3.Or(z3.UGT(height, goal), at_end)
    up = z3.And(z3.Not(down), z3.ULT(height, goal), z3.Or(endless, room >= 2 * steps))
    flat = z3.And(z3.Not(down), z3.Not(up))
    after_row = after.of("row")
    yield from of_way(after).items()
    yield "it descends as the model does", after.is_in(DESCEND) == down
    yield "it climbs as the model does", after.is_in(CLIMB) == up
    kept = 0xFF & ~(CLIMB | DESCEND)
    yield "no other mode changes", after.of("mode") & kept == before.of("mode") & kept
    lower = z3.If(down, wide(ramp.steps(after_row)), 0)
    yield "the level is the next one", wide(after.of("height")) == wide(height) - lower
    yield (
        "the steps are those of the level",
        z3.Implies(z3.Not(flat), after.count == ramp.steps(after_row)),
    )
    paces = z3.If(height == goal, before.of("cruise"), before.of("pace"))
    yield "one speed is the cruise or the pace", z3.Implies(flat, after.of("interval") == paces)
    yield "the pace is kept", after.of("pace") == before.of("pace")
    top = ramp.height(after_row, after.last_level)
    yield (
        "all levels that follow are climbed to the goal at most",
        z3.Implies(up, z3.ULE(top, goal)),
    )
    last = ramp.height(after_row, after.last_level + 1)
    yield (
        "all levels that follow are descended from above the goal, or to rest",
        z3.Implies(z3.And(down, z3.Not(at_end)), z3.UGT(last, goal)),
    )
    yield "no level is left that was begun", after.of("levels") == after.of("planned")
    more = z3.If(z3.And(endless, z3.ULT(rest, FAR)), z3.BitVecVal(FAR, 32), z3.BitVecVal(0, 32))
    yield "what is left stays, or is far away", after.left == wide(rest) + wide(more)
    ahead = z3.If(before.is_in(REVERSE), -more, more)
    yield "the end stays, or is as far", after.of("end") == before.of("end") + ahead


def _needs_nothing(_: AxisState) -> Said:
    yield from ()


def _gives_of_advance(before: AxisState, after: AxisState) -> Said:
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


PARTS = {
    "Decide": Part(
        changes=(
            *("mode", "interval", "change", "length", "levels", "planned", "rest", "end"),
            *("row", "rung", "rungs", "height", "count"),
        ),
        needs=_needs_of_decide,
        gives=_gives_of_decide,
    ),
    "Advance": Part(
        changes=("lapsLeft", "due", "dueFraction"),
        needs=_needs_nothing,
        gives=_gives_of_advance,
    ),
}
"""The parts by the end of their names."""


def row_of(ramp: Ramp, number: Any, steps: Any) -> dict[tuple[str, ...], Any]:  # noqa: ANN401
    """
    Return the parts of row *number* of levels of *steps*, as ``readRow`` reads them.
    """
    return {
        ("levels",): ramp.levels(number),
        ("steps",): steps,
        ("slope",): ramp.slope(number),
        ("share",): share_of(steps),
    }


def share_of(steps: Any) -> Any:  # noqa: ANN401
    """
    Return 256 divided by *steps*, a power of two, in 8 bits.
    """
    share = z3.BitVecVal(0, 8)
    for shift in range(1, 8):
        share = z3.If(steps == 1 << shift, z3.BitVecVal(1 << 8 - shift, 8), share)
    return share


def whole_levels(steps: Any, length: Any) -> Any:  # noqa: ANN401
    """
    Return how many levels of *length*, a power of two, are in *steps*, 16 bits.
    """
    levels = steps
    for shift in range(1, 8):
        levels = z3.If(length == 1 << shift, z3.LShR(steps, shift), levels)
    return levels


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

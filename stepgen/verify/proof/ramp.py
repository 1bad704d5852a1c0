"""
The ramp of an axis, row by row, for rows and levels that are not known.
"""

from collections.abc import Iterator
from typing import Any

import z3

from stepgen.reference.ladder import Ladder

LAPPED_256 = 32_768 << 8
"""An interval that is divided into laps, in 1/256 clocks."""

_BYTE, _WORD, _LONG = (z3.BitVecSort(bits) for bits in (8, 16, 32))
_LEVELS = z3.Function("levels", _BYTE, _BYTE)
_STEPS = z3.Function("steps", _BYTE, _BYTE)
_SLOPE = z3.Function("slope", _BYTE, _LONG)
_HEIGHT = z3.Function("height", _BYTE, _BYTE, _WORD)
_INTERVAL = z3.Function("interval", _BYTE, _BYTE, _LONG)
_SHIFTS = z3.Function("shifts", _BYTE, _BYTE)
_SLOW = z3.Function("laps", _BYTE, z3.BoolSort())
_IS_LEVEL = z3.Function("a level is so high", _WORD, z3.BoolSort())

_MOST_STEPS = 65_000
_MOST_LEVELS = 255
LENGTHS = tuple(1 << shift for shift in range(8))
"""The steps that a level can have."""


class Ramp:
    """
    A ladder as rows of levels: what each row is, and at which height and interval each level.

    All of these are functions of which z3 knows only what `facts` say for the rows and levels that
    are asked about. They hold for each: `check` goes over all of them.

    Args:
        ladder: The reference model's.
    """

    def __init__(self, ladder: Ladder) -> None:
        self.ladder = ladder

    @property
    def rows(self) -> int:
        """
        Return how many rows there are.
        """
        return len(self.ladder.rungs)

    @property
    def top(self) -> int:
        """
        Return the height of its top.
        """
        return self.ladder.levels[-1].height

    def levels(self, row: Any) -> Any:  # noqa: ANN401 - z3 has no types
        """
        Return the levels of *row*, 8 bits.
        """
        return _LEVELS(row)

    def steps(self, row: Any) -> Any:  # noqa: ANN401
        """
        Return the steps of each level of *row*, 8 bits.
        """
        return _STEPS(row)

    def shifts(self, row: Any) -> Any:  # noqa: ANN401
        """
        Return what the table has of *row* beside the levels and the slope, 8 bits.
        """
        return _SHIFTS(row)

    def slope(self, row: Any) -> Any:  # noqa: ANN401
        """
        Return by how much the interval changes between levels of *row*, 32 bits.
        """
        return _SLOPE(row)

    def height(self, row: Any, level: Any) -> Any:  # noqa: ANN401
        """
        Return the steps from level number *level* of *row* to rest, 16 bits.
        """
        return _HEIGHT(row, level)

    def interval(self, row: Any, level: Any) -> Any:  # noqa: ANN401
        """
        Return the interval of level number *level* of *row*, 32 bits.
        """
        return _INTERVAL(row, level)

    def is_level(self, height: Any) -> Any:  # noqa: ANN401
        """
        Tell whether a level begins at *height*, 16 bits.
        """
        return _IS_LEVEL(height)

    def facts_of_row(self, row: Any) -> Iterator[Any]:  # noqa: ANN401
        """
        Yield what is true of *row*, if there is such a row.
        """
        zero, levels = z3.BitVecVal(0, 8), self.levels(row)
        there = z3.ULT(row, self.rows)
        yield z3.Implies(there, levels != 0)
        yield z3.Implies(there, z3.Or(*(self.steps(row) == length for length in LENGTHS)))
        yield z3.Implies(there, self.steps(row) == 1 << (self.shifts(row) & 7))
        yield z3.Implies(
            z3.ULT(row, self.rows - 1),
            z3.And(
                self.interval(row, levels) == self.interval(row + 1, zero),
                self.height(row, levels) == self.height(row + 1, zero),
            ),
        )
        yield z3.Implies(there, z3.ULE(self.height(row, levels), self.top))
        yield z3.Implies(row == self.rows - 1, self.height(row, levels) == self.top)
        yield self.interval(zero, zero) == self.ladder.first_interval_256
        yield self.height(zero, zero) == 0
        yield self.levels(zero) == self.ladder.rungs[0].levels

    def facts(self, row: Any, level: Any) -> Iterator[Any]:  # noqa: ANN401
        """
        Yield what is true of level number *level* of *row*, if there is such a level.
        """
        there = z3.And(z3.ULT(row, self.rows), z3.ULT(level, self.levels(row)))
        here, slope = self.interval(row, level), self.slope(row)
        yield z3.Implies(
            there, z3.And(self.interval(row, level + 1) == here - slope, z3.ULE(slope, here))
        )
        yield z3.Implies(there, z3.ULE(here, self.ladder.first_interval_256))
        yield z3.Implies(there, z3.UGE(here, LAPPED_256) == _SLOW(row))
        yield z3.Implies(z3.And(there, _SLOW(row)), self.steps(row) == 1)
        high = self.height(row, level)
        above = high + z3.ZeroExt(8, self.steps(row))
        below_end = z3.ULE(above, self.height(row, self.levels(row)))
        next_one = self.height(row, level + 1) == above
        yield z3.Implies(there, z3.And(next_one, below_end, z3.ULT(high, above)))

    def facts_of_two(
        self,
        one: tuple[Any, Any],
        other: tuple[Any, Any],
    ) -> Iterator[Any]:
        """
        Yield what is true of two levels, each a row and a number, if *other* is next to *one*.

        It follows from the other facts, but z3 need not find that two names are neighbours.
        """
        row, level = one
        there = z3.And(z3.ULT(row, self.rows), z3.ULT(level, self.levels(row)))
        next_one = z3.And(other[0] == row, other[1] == level + 1)
        next_row = z3.And(level + 1 == self.levels(row), other[0] == row + 1, other[1] == 0)
        follows = z3.And(there, z3.Or(next_one, z3.And(next_row, z3.ULT(other[0], self.rows))))
        above = self.height(*one) + z3.ZeroExt(8, self.steps(row))
        yield z3.Implies(follows, self.height(*other) == above)
        yield z3.Implies(follows, self.interval(*other) == self.interval(*one) - self.slope(row))
        same = z3.And(other[0] == row, other[1] == level)
        last = z3.And(level == self.levels(row), other[0] == row + 1, other[1] == 0)
        last = z3.And(last, z3.ULT(other[0], self.rows))
        equal = z3.And(
            self.height(*other) == self.height(*one), self.interval(*other) == self.interval(*one)
        )
        yield z3.Implies(z3.Or(same, last), equal)

    def facts_of_levels(self, row: Any, level: Any, levels: Any) -> Iterator[Any]:  # noqa: ANN401
        """
        Yield how high the levels of *row* are that are so many *levels* above and below *level*.
        """
        steps = z3.ZeroExt(8, levels) * z3.ZeroExt(8, self.steps(row))
        high = self.height(row, level)
        there, last = z3.ULT(row, self.rows), self.levels(row)
        up = z3.And(there, z3.ULE(level, last), z3.ULE(levels, last - level))
        yield z3.Implies(up, self.height(row, level + levels) == high + steps)
        yield z3.Implies(up, z3.ULE(steps, z3.BitVecVal(_MOST_STEPS, 16) - high))
        down = z3.And(there, z3.ULE(level, last), z3.ULE(levels, level))
        yield z3.Implies(down, self.height(row, level - levels) == high - steps)
        yield z3.Implies(down, z3.ULE(steps, high))

    def facts_of_height(self, height: Any, row: Any) -> Iterator[Any]:  # noqa: ANN401
        """
        Yield what is true of a level that begins at *height*, seen from *row*.
        """
        bottom = self.height(row, z3.BitVecVal(0, 8))
        end = self.height(row, self.levels(row))
        part = z3.ZeroExt(8, self.steps(row) - 1)
        inside = (height - bottom) & part == 0
        seen = z3.Or(z3.ULE(height, bottom), z3.UGE(height, end), inside)
        known = z3.Implies(z3.ULT(row, self.rows), seen)
        yield z3.Implies(self.is_level(height), z3.And(z3.ULE(height, self.top), known))

    def entries(self, row: Any) -> Iterator[tuple[str, Any]]:  # noqa: ANN401
        """
        Yield what is in the table for *row*, by its name.
        """
        rungs = self.ladder.rungs
        yield "levels", _entry(row, [rung.levels for rung in rungs], 8)
        yield "stepsOf", _entry(row, [rung.steps for rung in rungs], 8)
        yield "slopeOf", _entry(row, [rung.slope_256 for rung in rungs], 32)

    def check(self) -> Iterator[str]:
        """
        Yield what is not true of the ramp though the facts say so.
        """
        levels = iter(self.ladder.levels)
        for number, rung in enumerate(self.ladder.rungs):
            row = [next(levels) for _ in range(rung.levels)]
            slow = {level.interval_256 >= LAPPED_256 for level in row}
            if len(slow) != 1:
                yield f"row {number} has levels with laps and without"
            if True in slow and rung.steps != 1:
                yield f"row {number} has levels of several steps, of laps"
            for level in row:
                if not 0 <= rung.slope_256 <= level.interval_256:
                    yield f"row {number} leads to less than no interval"
            if rung.steps not in LENGTHS:
                yield f"row {number} has levels of {rung.steps} steps"
            if not 1 <= rung.levels <= _MOST_LEVELS:
                yield f"row {number} has {rung.levels} levels"
        if self.ladder.levels[0].interval_256 >= 1 << 32:
            yield "its first interval is too long"
        if self.top > _MOST_STEPS:
            yield f"it is {self.top} steps high"


def _entry(row: Any, entries: list[int], bits: int) -> Any:  # noqa: ANN401
    value = z3.BitVecVal(entries[-1], bits)
    for number, entry in enumerate(entries[:-1]):
        value = z3.If(row == number, z3.BitVecVal(entry, bits), value)
    return value

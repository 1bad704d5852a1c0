"""
Ramps: the levels of speed that a motor climbs and descends, as a short table for its flash.

The step from r to r + 1 takes X(r) clocks, see `stepgen.plan.curves`. A *level* is an interval
that lasts for p steps; from one level to the next the interval changes by the slope of its *row*.
So a row of two numbers and a slope stands for hundreds of steps, and nothing is worked out while
the motor moves but one addition for each level.

A row is as long as its straight line stays close to X. The line lies as much above X in the middle
as it lies below at its ends, so that the errors of a row cancel out over its time.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from math import ceil

from stepgen.plan.curves import FRACTION, Curve, Speeds, plan_curve

MOST_STEPS = 65_000
"""How long a ramp can be: its steps are counted in 16 bits."""

MOST_ROWS = 255
"""How many rows a table can have: they are numbered in 8 bits."""

LONGEST_INTERVAL_CYCLES = (1 << 24) - 1
"""The longest interval: 24 bits before the point."""

_SLOW = 32_768 * FRACTION  # from here on an interval is divided into laps
SLOPE_BYTES = (0, 1, 2)
"""By how many bytes the 16 bits of a row's slope in flash are shifted."""

_LARGEST_UINT16 = 0xFFFF
_MOST_LEVELS = 255
_LONGEST_LEVEL_SHIFT = 7
_LEVELS_PER_RAMP = 128  # a level is no longer than so much of the ramp below it
_CURVE_TOLERANCE = Fraction(15, 10_000)  # how far a row's ends lie from X below its middle
_BELOW = Fraction(2, 3)  # of that, at the ends: a parabola's mean over its chord


@dataclass(frozen=True)
class Row:
    """
    Levels of equal length, whose intervals differ by the same amount.

    Args:
        levels: How many, 1 to 255.
        steps: The steps of each: a power of two, 1 to 128.
        slope: How much shorter each is than the one below, 16 bits,
        slope_bytes: shifted by so many bytes: 1/256 clocks, clocks, or 256 clocks.
    """

    levels: int
    steps: int
    slope: int
    slope_bytes: int = 0

    @property
    def slope_256(self) -> int:
        """
        Return the slope in 1/256 clocks.
        """
        return self.slope << 8 * self.slope_bytes


@dataclass(frozen=True)
class Ladder:
    """
    A ramp from its lowest level up.

    Args:
        first_interval_256: The interval of the lowest level, in 1/256 clocks.
        rows: Its rows, the lowest first.
        speeds: What the spec asks for.
    """

    first_interval_256: int
    rows: tuple[Row, ...]
    speeds: Speeds

    @property
    def steps(self) -> int:
        """
        Return how many steps lead to its top.
        """
        return sum(row.levels * row.steps for row in self.rows)

    def goal(self, interval_256: int) -> int:
        """
        Return the steps that lead to the last level whose interval is *interval_256* or longer.
        """
        interval, steps = self.first_interval_256, 0
        for row in self.rows:
            for _ in range(row.levels):
                interval -= row.slope_256
                if interval < interval_256:
                    return steps
                steps += row.steps
        return steps


def plan_ladder(f_cpu_hz: int, speeds: Speeds) -> Ladder | None:
    """
    Return the ramp of *speeds* on a chip of *f_cpu_hz*; None if it takes more than `MOST_STEPS`.
    """
    length = ceil(speeds.steps)
    if length > MOST_STEPS:
        return None
    curve = plan_curve(speeds, f_cpu_hz, length + 2 * _MOST_LEVELS)
    target = int(f_cpu_hz * FRACTION / speeds.cruise_sps)
    return Ladder(curve.intervals[0], tuple(_rows(curve, target)), speeds)


def _level_steps(curve: Curve, r: int) -> int:
    """
    Return how many steps a level has that begins at step *r*.
    """
    longest = curve.bases[r] // _LEVELS_PER_RAMP
    if curve.intervals[r] >= _SLOW or not longest:
        return 1
    return 1 << min(longest.bit_length() - 1, _LONGEST_LEVEL_SHIFT)


def _middle(curve: Curve, r: int, steps: int) -> int:
    """
    Return the interval in the middle of a level of *steps* that begins at step *r*.
    """
    last = min(r + steps - 1, len(curve.intervals) - 1)
    return (curve.intervals[min(r, last)] + curve.intervals[last]) // 2


def _levels_left(curve: Curve, r: int, steps: int) -> int:
    """
    Return how many levels of *steps* the curve has from step *r* on.
    """
    if curve.steps is not None:
        return ceil((curve.steps - r) / steps)
    return (len(curve.intervals) - 1 - r) // steps


def _rows(curve: Curve, target: int) -> Iterator[Row]:
    interval, r = curve.intervals[0], 0
    while interval > target and (curve.steps is None or r < curve.steps):
        # The line lies beside the curve, and what counts for laps is the line.
        steps = 1 if interval >= _SLOW else _level_steps(curve, r)
        row = _all_slow_or_none(_longest_row(curve, r, steps, interval), interval)
        yield row
        interval -= row.levels * row.slope_256
        r += row.levels * steps


def _all_slow_or_none(row: Row, interval: int) -> Row:
    """
    Return *row*, which begins with *interval*, without the levels behind the slow ones, if any are.
    """
    last = interval - (row.levels - 1) * row.slope_256
    if interval < _SLOW or last >= _SLOW:
        return row
    return replace(row, levels=(interval - _SLOW) // row.slope_256 + 1)


def _longest_row(curve: Curve, r: int, steps: int, interval: int) -> Row:
    """
    Return the longest row from step *r* on whose line stays within the tolerance of the curve.
    """
    low, high = 1, min(_MOST_LEVELS, _levels_left(curve, r, steps))
    while low < high:
        middle = (low + high + 1) // 2
        low, high = (middle, high) if _fits(curve, r, steps, middle) else (low, middle - 1)
    bow = _above(curve, r, steps, low, low // 2)
    end = r + low * steps
    wanted = _middle(curve, end, _level_steps(curve, min(end, len(curve.intervals) - 1)))
    drop = max(interval - wanted + int(_BELOW * bow), 0)
    for slope_bytes in SLOPE_BYTES:
        unit = low << 8 * slope_bytes
        slope = (2 * drop + unit) // (2 * unit)
        if slope <= _LARGEST_UINT16:
            break
    return Row(low, steps, slope, slope_bytes)


def _fits(curve: Curve, r: int, steps: int, levels: int) -> bool:
    """
    Tell whether a row of so many *levels* is straight enough, and all of it slow or all of it not.
    """
    end = r + levels * steps
    if curve.intervals[r] >= _SLOW > curve.intervals[end - 1]:
        return False
    if _level_steps(curve, end - 1) != steps:
        return False
    allowed = _CURVE_TOLERANCE * _middle(curve, end, steps)
    # Where an S bends the other way the line crosses it, and is farthest at the quarters.
    places = (levels * quarter // 4 for quarter in (1, 2, 3))
    return all(abs(_above(curve, r, steps, levels, place)) <= allowed for place in places)


def _above(curve: Curve, r: int, steps: int, levels: int, place: int) -> int:
    """
    Return how far the line from end to end lies above the curve at level *place*.
    """
    first, last = _middle(curve, r, steps), _middle(curve, r + levels * steps, steps)
    return first - (first - last) * place // levels - _middle(curve, r + place * steps, steps)

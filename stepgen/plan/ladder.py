"""
Ramps: the levels of speed that a motor climbs and descends, as a short table for its flash.

Without jerk a motor that starts with speed u has after r steps the speed v(r) = sqrt(u^2 + 2 a r),
and the step from r to r + 1 takes X(r) = 2 F / (v(r) + v(r + 1)) clocks. A *level* is an interval
that lasts for p steps; from one level to the next the interval changes by the slope of its *row*.
So a row of two numbers and a slope stands for hundreds of steps, and nothing is worked out while
the motor moves but one addition for each level.

A row is as long as its straight line stays close to X. The line lies as much above X in the middle
as it lies below at its ends, so that the errors of a row cancel out over its time.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from math import isqrt

FRACTION = 256
"""Parts of a clock in which intervals are counted."""

MOST_STEPS = 65_000
"""How long a ramp can be: its steps are counted in 16 bits."""

LONGEST_INTERVAL_CYCLES = (1 << 24) - 1
"""The longest interval: 24 bits before the point."""

_SLOW_CYCLES = 32_768  # from here on an interval is divided into laps
SLOPE_BYTES = (0, 1, 2)
"""By how many bytes the 16 bits of a row's slope in flash are shifted."""

_LARGEST_UINT16 = 0xFFFF
_MOST_LEVELS = 255
_LONGEST_LEVEL_SHIFT = 7
_LEVELS_PER_RAMP = 128  # a level is no longer than so much of the ramp below it
_CURVE_TOLERANCE = Fraction(15, 10_000)  # how far a row's ends lie from X below its middle
_BELOW = Fraction(2, 3)  # of that, at the ends: a parabola's mean over its chord
_SCALE_BITS = 24


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
        acceleration: In steps/s^2.
        start_sps: The speed from which the motor starts, 0 for one at rest.
    """

    first_interval_256: int
    rows: tuple[Row, ...]
    acceleration: Fraction
    start_sps: Fraction

    @property
    def steps(self) -> int:
        """
        Return how many steps lead to its top.
        """
        return sum(row.levels * row.steps for row in self.rows)

    def is_slow(self, number: int) -> bool:
        """
        Tell whether row *number* has intervals that are divided into laps.
        """
        below = sum(row.levels * row.slope_256 for row in self.rows[:number])
        return self.first_interval_256 - below >= _SLOW_CYCLES * FRACTION

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


def plan_ladder(
    f_cpu_hz: int, cruise_sps: Fraction, acceleration: Fraction, start_sps: Fraction
) -> Ladder | None:
    """
    Return the ramp up to *cruise_sps*; None if it takes more than `MOST_STEPS`.

    Args:
        f_cpu_hz: Clocks in a second.
        cruise_sps: The speed that its top reaches, above *start_sps*.
        acceleration: In steps/s^2, above 0.
        start_sps: The speed from which the motor starts.
    """
    length = -(-(cruise_sps**2 - start_sps**2) // (2 * acceleration))
    if length > MOST_STEPS:
        return None
    curve = _Curve(f_cpu_hz, acceleration, start_sps, int(length) + 2 * _MOST_LEVELS)
    first = curve.intervals[0]
    target = int(f_cpu_hz * FRACTION / cruise_sps)
    return Ladder(first, tuple(_rows(curve, first, target)), acceleration, start_sps)


class _Curve:
    """
    The intervals X(r) in 1/256 clocks, for each step of a ramp.
    """

    def __init__(
        self, f_cpu_hz: int, acceleration: Fraction, start_sps: Fraction, length: int
    ) -> None:
        square = start_sps**2
        parts = square.denominator * acceleration.denominator
        scale = 1 << 2 * _SCALE_BITS
        first, more = int(square * parts) * scale, int(2 * acceleration * parts) * scale
        speeds = [isqrt((first + more * r) // parts) for r in range(length + 1)]
        doubled = 2 * f_cpu_hz * FRACTION << _SCALE_BITS
        self.before = int(square / (2 * acceleration))
        self.intervals = [(2 * doubled // (low + high) + 1) // 2 for low, high in pairwise(speeds)]

    def level_steps(self, r: int) -> int:
        """
        Return how many steps a level has that begins at step *r*.
        """
        longest = (r + self.before) // _LEVELS_PER_RAMP
        if self.intervals[r] >= _SLOW_CYCLES * FRACTION or not longest:
            return 1
        return 1 << min(longest.bit_length() - 1, _LONGEST_LEVEL_SHIFT)

    def middle(self, r: int, steps: int) -> int:
        """
        Return the interval in the middle of a level of *steps* that begins at step *r*.
        """
        last = min(r + steps - 1, len(self.intervals) - 1)
        return (self.intervals[min(r, last)] + self.intervals[last]) // 2


def _rows(curve: _Curve, interval: int, target: int) -> Iterator[Row]:
    r = 0
    while interval > target:
        steps = curve.level_steps(r)
        row = _longest_row(curve, r, steps, interval)
        yield row
        interval -= row.levels * row.slope_256
        r += row.levels * steps


def _longest_row(curve: _Curve, r: int, steps: int, interval: int) -> Row:
    """
    Return the longest row from step *r* on whose line stays within the tolerance of the curve.
    """
    low, high = 1, min(_MOST_LEVELS, (len(curve.intervals) - 1 - r) // steps)
    while low < high:
        middle = (low + high + 1) // 2
        low, high = (middle, high) if _fits(curve, r, steps, middle) else (low, middle - 1)
    bow = _bow(curve, r, steps, low)
    end = r + low * steps
    wanted = curve.middle(end, curve.level_steps(min(end, len(curve.intervals) - 1)))
    drop = max(interval - wanted + int(_BELOW * bow), 0)
    for slope_bytes in SLOPE_BYTES:
        unit = low << 8 * slope_bytes
        slope = (2 * drop + unit) // (2 * unit)
        if slope <= _LARGEST_UINT16:
            break
    return Row(low, steps, slope, slope_bytes)


def _fits(curve: _Curve, r: int, steps: int, levels: int) -> bool:
    """
    Tell whether a row of so many *levels* is straight enough, and all of it slow or all of it not.
    """
    end = r + levels * steps
    slow = _SLOW_CYCLES * FRACTION
    if curve.intervals[r] >= slow > curve.intervals[end - 1]:
        return False
    if curve.level_steps(end - 1) != steps:
        return False
    return _bow(curve, r, steps, levels) <= _CURVE_TOLERANCE * curve.middle(end, steps)


def _bow(curve: _Curve, r: int, steps: int, levels: int) -> int:
    """
    Return how far the line from end to end lies above the curve, where it is farthest.
    """
    first, last = curve.middle(r, steps), curve.middle(r + levels * steps, steps)
    half = levels // 2
    return first - (first - last) * half // levels - curve.middle(r + half * steps, steps)

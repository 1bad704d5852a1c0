"""
The intervals of a ramp, step by step, as physics has them.
"""

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import pairwise
from math import ceil, isqrt, sqrt

FRACTION = 256
"""Parts of a clock in which intervals are counted."""

_SCALE_BITS = 24
_NEWTON_ROUNDS = 60
_LOOK_AHEAD = 127  # steps: the longest level
_EXACT = 1e-13  # of a time: far less than 1/256 clock in a second


@dataclass(frozen=True)
class Speeds:
    """
    What a spec asks of a ramp.

    Args:
        start_sps: The speed that the motor may take at once, 0 or more, in steps/s.
        cruise_sps: The speed that its top reaches, above *start_sps*.
        acceleration: In steps/s^2, above 0; with *jerk* the most.
        jerk: How fast the acceleration may change, in steps/s^3; None: at once.
    """

    start_sps: Fraction
    cruise_sps: Fraction
    acceleration: Fraction
    jerk: Fraction | None = None

    @cached_property
    def peak_acceleration(self) -> Fraction:
        """
        Return the highest acceleration that the ramp comes to.
        """
        rise = self.cruise_sps - self.start_sps
        if self.jerk is None or self.acceleration**2 <= self.jerk * rise:
            return self.acceleration
        return Fraction(sqrt(self.jerk * rise))

    @cached_property
    def steps(self) -> Fraction:
        """
        Return the steps that the ramp takes: its mean speed for as long as it lasts.
        """
        seconds = (self.cruise_sps - self.start_sps) / self.peak_acceleration
        if self.jerk is not None:
            seconds += self.peak_acceleration / self.jerk
        return (self.start_sps + self.cruise_sps) / 2 * seconds


@dataclass(frozen=True)
class Curve:
    """
    The intervals X(r) of a ramp and of a while beyond.

    Args:
        intervals: Those of the step from r to r + 1, in 1/256 clocks.
        bases: At each r, how long a ramp of even acceleration would be that speeds up as much there
            as this one: X(r) over twice what the next interval is shorter.
        steps: From which r on it is no faster any more; None if it goes on.
    """

    intervals: list[int]
    bases: list[int]
    steps: int | None


def plan_curve(speeds: Speeds, f_cpu_hz: int, steps: int) -> Curve:
    """
    Return the curve of *speeds* for so many *steps*.
    """
    if speeds.jerk is None:
        return _even(speeds, f_cpu_hz, steps)
    times = list(_times(speeds, steps + 1))
    clocks = f_cpu_hz * FRACTION
    intervals = [round((after - before) * clocks) for before, after in pairwise(times)]
    changes = [max(one - next_one, 1) for one, next_one in pairwise(intervals)]
    here = [one // (2 * change) for one, change in zip(intervals, [*changes, 1], strict=True)]
    # Where the acceleration rises, a level must be short enough for its end.
    bases = [min(one, here[min(r + _LOOK_AHEAD, steps - 1)]) for r, one in enumerate(here)]
    return Curve(intervals, bases, ceil(speeds.steps))


def _even(speeds: Speeds, f_cpu_hz: int, steps: int) -> Curve:
    """
    Return the curve without jerk: v(r)^2 = u^2 + 2 a r, and the mean speed of a step is exact.
    """
    square, acceleration = speeds.start_sps**2, speeds.acceleration
    parts = square.denominator * acceleration.denominator
    scale = 1 << 2 * _SCALE_BITS
    first, more = int(square * parts) * scale, int(2 * acceleration * parts) * scale
    roots = [isqrt((first + more * r) // parts) for r in range(steps + 1)]
    doubled = 2 * f_cpu_hz * FRACTION << _SCALE_BITS
    intervals = [(2 * doubled // (low + high) + 1) // 2 for low, high in pairwise(roots)]
    before = int(square / (2 * acceleration))
    return Curve(intervals, [r + before for r in range(steps)], None)


def _times(speeds: Speeds, steps: int) -> list[float]:
    """
    Return the seconds after which each of so many *steps* is made.

    The acceleration rises evenly for a / j seconds, stays, and falls as it rose: half a turn of the
    curve about its middle maps it onto itself.
    """
    start, cruise = float(speeds.start_sps), float(speeds.cruise_sps)
    peak, jerk = float(speeds.peak_acceleration), float(speeds.jerk or 0)
    whole = float(speeds.steps)
    duration = 2 * whole / (start + cruise)
    rising = peak / jerk
    bent = start * rising + jerk * rising**3 / 6  # steps until the acceleration is highest
    risen = start + peak * rising / 2  # and the speed then
    last = cruise * rising - jerk * rising**3 / 6  # steps while it falls again
    times = []
    time = left = 0.0
    for r in range(steps):
        if r <= bent:
            time = _cubic(r, start, jerk, time or rising)
        elif r < whole - last:
            ahead = r - bent
            time = rising + 2 * ahead / (risen + sqrt(risen**2 + 2 * peak * ahead))
        elif r < whole:
            left = _cubic(whole - r, cruise, -jerk, left or rising)
            time = duration - left
        else:
            time = duration + (r - whole) / cruise
        times.append(time)
    return times


def _cubic(way: float, speed: float, jerk: float, near: float) -> float:
    """
    Return the time t with v t + j t^3 / 6 = *way*, by Newton's method from *near* on, above 0.
    """
    if way == 0:
        return 0.0
    time = near
    for _ in range(_NEWTON_ROUNDS):
        slope = speed + jerk * time**2 / 2
        change = (way - speed * time - jerk * time**3 / 6) / slope
        time += change
        if abs(change) <= _EXACT * time:
            break
    return time

"""
The ramp that physics asks for, and how far a ladder is from it.

From rest, or from a start speed v0, with the acceleration a: after r steps the speed is
v(r) = sqrt(v0^2 + 2 * a * r), at most that of the cruise, and the next step takes
X(r) = 2 * F / (v(r) + v(r + 1)) clocks: exactly, but in the step that reaches the cruise.

With a jerk j the acceleration rises by j each second until it is a, or until half the speed is
gained, and falls as it rose. Then the way s(t) is a polynomial of the third degree in each of three
phases, and the times at which it comes to r and r + 1 steps, X(r) apart, are looked for by halving.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import pairwise
from math import isqrt

from stepgen.reference.ladder import Ladder
from stepgen.reference.timer import FRACTIONS

WORST_ERROR = Fraction(4, 1000)
"""How far speed and length of a ramp may be from what was asked for: 0.4 %."""

_ROOT_BITS = 64
_CLOCK_BITS = 64
_TIME_BITS = 48


@dataclass(frozen=True)
class Wish:
    """
    What the spec asks for.

    Args:
        f_cpu_hz: Clocks in a second.
        start_sps: The speed from which it begins, 0 or more, in steps/s.
        cruise_sps: The speed at which it ends.
        acceleration: The acceleration in steps/s^2, at most.
        jerk: How fast it may change, in steps/s^3; None: at once.
    """

    f_cpu_hz: int
    start_sps: Fraction
    cruise_sps: Fraction
    acceleration: Fraction
    jerk: Fraction | None = None

    @property
    def steps(self) -> Fraction:
        """
        Return the steps that it takes to come to the cruise.
        """
        if self.jerk is None:
            return (self.cruise_sps**2 - self.start_sps**2) / (2 * self.acceleration)
        bent, even = self._phases()
        return (self.start_sps + self.cruise_sps) / 2 * (2 * bent + even)

    def _phases(self) -> tuple[Fraction, Fraction]:
        """
        Return how many seconds the acceleration rises, as long as it falls, and how long it stays.
        """
        jerk = self.jerk or Fraction(0)
        gain = self.cruise_sps - self.start_sps
        if self.acceleration**2 <= jerk * gain:
            bent = self.acceleration / jerk
            return bent, gain / self.acceleration - bent
        square = gain / jerk
        root = isqrt((square.numerator << 2 * _ROOT_BITS) // square.denominator)
        return Fraction(root, 1 << _ROOT_BITS), Fraction(0)

    @cached_property
    def _course(self) -> list[tuple[int, tuple[int, int, int, int]]]:
        """
        Return of each phase its seconds, in 2^-48, and the polynomial of the way, in 2^-64 steps.
        """
        jerk = self.jerk or Fraction(0)
        bent, even = self._phases()
        way, speed, acceleration = Fraction(0), self.start_sps, Fraction(0)
        course = []
        for t, change in ((bent, jerk), (even, Fraction(0)), (bent, -jerk)):
            parts = (way, speed, acceleration / 2, change / 6)
            one, two, three, four = (part * (1 << _ROOT_BITS) // 1 for part in parts)
            course.append((int(t * (1 << _TIME_BITS)), (one, two, three, four)))
            way += speed * t + acceleration * t**2 / 2 + change * t**3 / 6
            speed += acceleration * t + change * t**2 / 2
            acceleration += change * t
        last = (way * (1 << _ROOT_BITS) // 1, speed * (1 << _ROOT_BITS) // 1, 0, 0)
        return [*course, (1 << 128, last)]

    def _way(self, time: int) -> int:
        """
        Return the steps, in 2^-64, that are made after so many seconds, in 2^-48.
        """
        course = iter(self._course)
        length, (way, speed, half, sixth) = next(course)
        while time > length:
            time -= length
            length, (way, speed, half, sixth) = next(course)
        cubic = ((sixth * time >> _TIME_BITS) + half) * time >> _TIME_BITS
        return way + ((cubic + speed) * time >> _TIME_BITS)

    def _moments(self) -> Iterator[Fraction]:
        """
        Yield the seconds, cut off to 2^-48, after which each number of steps is made, without end.
        """
        low, wanted = 0, 0
        step = 1 << _TIME_BITS
        while True:
            yield Fraction(low, 1 << _TIME_BITS)
            wanted += 1 << _ROOT_BITS
            high = low + 2 * step
            while self._way(high) < wanted:
                high += high - low
            before = low
            while high - low > 1:
                middle = (low + high) // 2
                low, high = (middle, high) if self._way(middle) < wanted else (low, middle)
            step = low - before

    def speed(self, steps: int) -> Fraction:
        """
        Return the speed after *steps*, cut off to 2^-64 steps/s: min(sqrt(v0^2 + 2ar), cruise).
        """
        square = self.start_sps**2 + 2 * self.acceleration * steps
        if square >= self.cruise_sps**2:
            return self.cruise_sps
        root = isqrt((square.numerator << 2 * _ROOT_BITS) // square.denominator)
        return Fraction(root, 1 << _ROOT_BITS)

    def intervals(self) -> Iterator[Fraction]:
        """
        Yield the interval after each number of steps, in clocks, without end.
        """
        if self.jerk is not None:
            for before, after in pairwise(self._moments()):
                yield self.f_cpu_hz * (after - before)
        steps, speed = 0, self.speed(0)
        while True:
            following = self.speed(steps + 1)
            yield 2 * self.f_cpu_hz / (speed + following)
            steps, speed = steps + 1, following


@dataclass(frozen=True)
class Errors:
    """
    How far a ladder is from the physics, on its way from rest to the cruise.

    Args:
        steps: How many steps that takes.
        speed: The worst relative error of the speed in any of them.
        ideal_clocks: How long all of them take ideally.
        late_clocks: How much longer they take, below 0 how much shorter.
    """

    steps: int
    speed: Fraction
    ideal_clocks: Fraction
    late_clocks: Fraction

    @property
    def time(self) -> Fraction:
        """
        Return the relative error of the time that the ramp takes.
        """
        return abs(self.late_clocks) / self.ideal_clocks


def errors(ladder: Ladder, cruise_256: int, wish: Wish) -> Errors:
    """
    Return how far *ladder* is from *wish* in each step until both have come to the cruise.

    Where the ladder is at its goal each step takes *cruise_256*.
    """
    worst = Fraction(0)
    ideal_256 = real_256 = 0
    steps = 0
    square = wish.steps
    real = _climbed(ladder, cruise_256)
    climb = ladder.levels[ladder.goal(cruise_256)].height
    for steps, (wanted, made) in enumerate(zip(wish.intervals(), real, strict=False)):
        if steps >= climb and steps >= square:
            break
        # In 1/256 clock and 2^-64 of it, so that the sums stay short.
        ideal = (wanted.numerator * FRACTIONS << _CLOCK_BITS) // wanted.denominator
        exact = made << _CLOCK_BITS
        # Speeds are to each other as the intervals the other way round.
        if abs(ideal - exact) * worst.denominator > worst.numerator * exact:
            worst = Fraction(abs(ideal - exact), exact)
        ideal_256 += ideal
        real_256 += exact
    unit = FRACTIONS << _CLOCK_BITS
    return Errors(steps, worst, Fraction(ideal_256, unit), Fraction(real_256 - ideal_256, unit))


def _climbed(ladder: Ladder, cruise_256: int) -> Iterator[int]:
    """
    Yield each interval from rest on of who climbs without an end.
    """
    for level in ladder.levels[: ladder.goal(cruise_256)]:
        for _ in range(level.steps):
            yield level.interval_256
    while True:
        yield cruise_256

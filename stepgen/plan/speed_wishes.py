"""
Speed changes the other way round: from two speeds and a time, a number of steps or of updates.

What is not said is chosen: updates at least 50 ms apart (the source's limit) and no closer than
the slowest steps; with halving, as many as it takes to halve the interval from start to end.
"""

from bisect import bisect_left
from dataclasses import dataclass
from fractions import Fraction
from math import ceil, fsum

from stepgen.errors import StepgenError
from stepgen.plan.rates import Clock
from stepgen.plan.speed_changes import (
    LARGEST_UINT16,
    Course,
    SpeedChange,
    check_uint16,
    plan_change,
)
from stepgen.plan.timings.fast_pwm import choose_setting
from stepgen.units import MILLISECONDS_PER_SECOND

_SMALLEST_CHOSEN_INTERVAL_MS = 50
_MOST_HALVINGS = 31
_TOLERATED = Fraction(1, 10)  # of the wanted time or steps: more is another wish
_BETWEEN = "milliseconds between updates"


@dataclass(frozen=True)
class Wish:
    """
    From one speed to another, and what else is fixed: two of the four, or one of the last two.

    Args:
        start_clocks: The virtual value at the start.
        end_clocks: The virtual value at the end.
        halving: Whether the modification is halved (faster) or doubled (slower).
        updates: The number of updates.
        interval_ms: The milliseconds between updates.
        duration_ms: The milliseconds until the last update.
        steps: The steps to be made until the last update.
    """

    start_clocks: int
    end_clocks: int
    halving: bool = False
    updates: int | None = None
    interval_ms: int | None = None
    duration_ms: Fraction | None = None
    steps: Fraction | None = None

    @property
    def difference_clocks(self) -> int:
        """
        Return how far apart the two virtual values are.
        """
        return abs(self.start_clocks - self.end_clocks)

    @property
    def faster(self) -> bool:
        """
        Tell whether the end is faster than the start.
        """
        return self.end_clocks < self.start_clocks

    def course(self, count: int) -> Course:
        """
        Return the course of *count* updates, 1 or more, that ends nearest without passing the end.

        Its modification m is the largest whose changes add up to at most the difference: m * count
        for equal changes, m + m/2 + m/4 ... when halved, m * (2^count - 1) when doubled.

        Raises:
            StepgenError: More halvings or doublings than 32 bits have.
        """
        if self.halving and count > _MOST_HALVINGS:
            raise StepgenError.of(
                f"{count} updates halve or double any modification out of its 32 bits; choose "
                f"at most {_MOST_HALVINGS}, or leave halving out"
            )
        if not self.halving:
            clocks = self.difference_clocks // count
        elif self.faster:
            clocks = largest_halved(self.difference_clocks, count)
        else:
            clocks = self.difference_clocks // ((1 << count) - 1)
        return Course(self.start_clocks, clocks, self.faster, self.halving, count)


def largest_halved(difference_clocks: int, count: int) -> int:
    """
    Return the largest m with m + m/2 + m/4 ... (*count* terms, truncated) <= the difference.

    Without truncation the sum is m * (2 - 2^(1 - count)); each term drops less than one clock.
    """
    clocks = (difference_clocks << (count - 1)) // ((1 << count) - 1)
    while sum((clocks + 1) >> halvings for halvings in range(count)) <= difference_clocks:
        clocks += 1
    return clocks


def plan_wish(wish: Wish, clock: Clock) -> SpeedChange:
    """
    Return the speed change that comes closest to *wish*.

    Raises:
        StepgenError: The wish is contradictory, says too little or cannot be had.
    """
    _check(wish)
    if wish.duration_ms is not None:
        count, interval_ms = _within_time(wish, wish.duration_ms, clock)
    elif wish.steps is not None:
        count, interval_ms = _within_steps(wish, wish.steps, clock)
    else:
        count, interval_ms = wish.updates or 0, wish.interval_ms or 0
    check_uint16(count, "updates")
    change = plan_change(wish.course(count), interval_ms, clock)
    _check_length(wish.duration_ms, change.end.due_ms, "milliseconds")
    _check_length(wish.steps, change.end.steps_made, "steps")
    return change


def _check_length(wanted: Fraction | None, planned: float, what: str) -> None:
    if wanted is not None and abs(planned - wanted) > max(1.0, float(wanted * _TOLERATED)):
        raise StepgenError.of(
            f"{float(wanted):.8g} {what} cannot be had so; the nearest would be {planned:.8g}. "
            "Choose that, other updates or another interval"
        )


def _check(wish: Wish) -> None:
    if not wish.difference_clocks:
        raise StepgenError.of(
            "start and end are the same speed; call motorSetSpeed(MOTOR_CTRL_DRV_EN, "
            f"{wish.start_clocks}UL)"
        )
    lengths = sum(value is not None for value in (wish.duration_ms, wish.steps))
    counts = sum(value is not None for value in (wish.updates, wish.interval_ms))
    if lengths + counts > 2 or lengths > 1:  # noqa: PLR2004 - two of them say all
        raise StepgenError.of(
            "the length is given more than once; give a time or a number of turns with at most "
            "one of updates and interval, or just those two"
        )
    if not lengths and counts < 2:  # noqa: PLR2004 - the same
        raise StepgenError.of(
            "how long the change takes is not said; give updates and interval, a time, or a "
            "number of turns"
        )
    if any(length is not None and length <= 0 for length in (wish.duration_ms, wish.steps)):
        raise StepgenError.of("a speed change takes more than no time and no turn; choose more")
    for value, what in ((wish.updates, "updates"), (wish.interval_ms, _BETWEEN)):
        if value is not None:
            check_uint16(value, what)


def _within_time(wish: Wish, duration_ms: Fraction, clock: Clock) -> tuple[int, int]:
    """
    Return the updates and the interval that end after *duration_ms*, to the millisecond.

    Of the numbers of updates that may be chosen, it takes the one that meets the time best, then
    the one that meets the end speed best, then the largest.
    """
    if wish.interval_ms is not None:
        return round(duration_ms / wish.interval_ms), wish.interval_ms
    if wish.updates is not None or wish.halving:
        count = wish.updates or _halvings(wish)
        return count, round(duration_ms / count)
    most = _within_limits(wish, int(duration_ms // _least_interval_ms(wish, clock)))

    def misses(count: int) -> tuple[Fraction, int, int]:
        missed_ms = abs(duration_ms - count * round(duration_ms / count))
        return missed_ms, wish.difference_clocks % count, -count

    count = min(range(most // 2 + 1, most + 1), key=misses)
    return count, round(duration_ms / count)


def _within_steps(wish: Wish, steps: Fraction, clock: Clock) -> tuple[int, int]:
    """
    Return the updates and the interval in which *steps* are made, as nearly as milliseconds allow.
    """
    if wish.interval_ms is not None:
        return _count_of_steps(wish, steps, wish.interval_ms, clock), wish.interval_ms
    if wish.updates is not None or wish.halving:
        count = wish.updates or _halvings(wish)
    else:
        most = _count_of_steps(wish, steps, _least_interval_ms(wish, clock), clock)
        # A tenth fewer updates do as well: those that meet the end speed best.
        some = range(most - most // 10, most + 1)
        count = min(some, key=lambda count: (wish.difference_clocks % count, -count))
    return count, round(float(steps) / _steps_per_ms(wish, count, clock))


def _count_of_steps(wish: Wish, steps: Fraction, interval_ms: int, clock: Clock) -> int:
    """
    Return the number of updates with which the steps made are nearest to *steps*.

    More updates of one interval make more steps, so it lies between two neighbours.
    """

    def made(count: int) -> float:
        return interval_ms * _steps_per_ms(wish, count, clock)

    halvings = wish.difference_clocks.bit_length() - 1  # more would leave no modification
    largest = _within_limits(wish, halvings if wish.halving else LARGEST_UINT16)
    above = bisect_left(range(1, largest), float(steps), key=made) + 1
    return min((max(1, above - 1), above), key=lambda count: abs(made(count) - float(steps)))


def _steps_per_ms(wish: Wish, count: int, clock: Clock) -> float:
    """
    Return the sum of the rates before each update: the steps made with updates each millisecond.
    """
    *before, _ = wish.course(count).virtuals()
    periods = (choose_setting(clocks).period_cycles for clocks in before)
    return fsum(float(clock.io_hz) / period for period in periods) / MILLISECONDS_PER_SECOND


def _least_interval_ms(wish: Wish, clock: Clock) -> int:
    """
    Return the interval for those who name none: never below 50 ms nor the slowest period.
    """
    slowest_clocks = max(wish.start_clocks, wish.end_clocks)
    period_ms = ceil(slowest_clocks * MILLISECONDS_PER_SECOND / clock.io_hz)
    return max(_SMALLEST_CHOSEN_INTERVAL_MS, min(period_ms, LARGEST_UINT16))


def _halvings(wish: Wish) -> int:
    """
    Return how often the longer interval must be halved to be no longer than the shorter one.
    """
    shorter, longer = sorted((wish.start_clocks, wish.end_clocks))
    return ((longer - 1) // shorter).bit_length()


def _within_limits(wish: Wish, count: int) -> int:
    return max(1, min(count, LARGEST_UINT16, wish.difference_clocks))

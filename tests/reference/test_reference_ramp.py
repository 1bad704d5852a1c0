"""
How far a ladder is from the physics: against ramps that can be worked out by hand.
"""

from fractions import Fraction
from itertools import islice
from math import sqrt

import pytest
from hypothesis import given
from hypothesis import strategies as st

from stepgen.reference.ladder import Ladder, Rung
from stepgen.reference.ramp import Wish, errors

F_CPU = 16_000_000
SQUARES = Wish(F_CPU, Fraction(0), Fraction(400), Fraction(5_000))


def test_the_first_interval_from_rest_is_that_of_free_fall() -> None:
    """
    From rest a step takes sqrt(2 / a) seconds: 0.02 s at 5000 steps/s^2.
    """
    first = next(SQUARES.intervals())

    assert float(first) == pytest.approx(320_000, rel=1e-15)


def test_steps_of_constant_acceleration_come_at_square_roots() -> None:
    """
    The moment of step n is sqrt(2n / a), so that the intervals up to it add up to that.
    """
    total = sum(islice(SQUARES.intervals(), 9))

    # sqrt(18 / 5000) = 0.06 s.
    assert float(total) == pytest.approx(960_000, rel=1e-15)


def test_at_the_cruise_intervals_stay() -> None:
    """
    400 steps/s are reached after 400^2 / (2 * 5000) = 16 steps.
    """
    intervals = list(islice(SQUARES.intervals(), 18))

    assert intervals[16:] == [40_000, 40_000]
    assert intervals[15] > 40_000


def test_a_start_speed_begins_in_mid_ramp() -> None:
    """
    v0 = 300: 300^2 / 10000 = 9 steps of the ramp from rest are left out.
    """
    wish = Wish(F_CPU, Fraction(300), Fraction(400), Fraction(5_000))

    assert list(islice(wish.intervals(), 9)) == list(islice(SQUARES.intervals(), 9, 18))


def test_a_ladder_of_the_exact_intervals_has_no_error_but_rounding() -> None:
    """
    Each interval within half of 1/256 clock: relative 1/512 of 40 000 at most.
    """
    exact = [round(256 * 320_000 * (sqrt(n + 1) - sqrt(n))) for n in range(16)]
    rungs = tuple(
        Rung(1, 1, first - second)
        for first, second in zip(exact, [*exact[1:], 40_000 << 8], strict=True)
    )

    found = errors(Ladder(exact[0], rungs), 40_000 << 8, SQUARES)

    assert found.steps == 16
    assert found.speed <= Fraction(1, 512 * 40_000)
    assert abs(found.late_clocks) <= Fraction(16, 512)


def test_an_error_of_one_interval_is_found() -> None:
    """
    One interval that is a hundredth too long: the speed is 1/101 too low, the time that much late.
    """
    exact = [round(256 * 320_000 * (sqrt(n + 1) - sqrt(n))) for n in range(16)]
    exact[7] = round(exact[7] * 1.01)
    rungs = tuple(
        Rung(1, 1, first - second)
        for first, second in zip(exact, [*exact[1:], 40_000 << 8], strict=True)
    )

    found = errors(Ladder(exact[0], rungs), 40_000 << 8, SQUARES)

    # Rounded to half of 1/256 clock of 58 456: 4e-8 of it.
    assert float(found.speed) == pytest.approx(1 / 101, abs=4e-8)
    # 320000 * (sqrt(8) - sqrt(7)) / 100 = 584.56 clocks; the ramp takes 1 280 000.
    assert float(found.late_clocks) == pytest.approx(584.56, abs=0.05)
    assert float(found.time) == pytest.approx(584.56 / 1_280_000, rel=1e-4)


def test_a_cruise_that_is_reached_too_early_is_found() -> None:
    """
    A ladder that jumps to the cruise from level 0: the second step is far too fast.
    """
    found = errors(Ladder(320_000 << 8, (Rung(1, 1, 280_000 << 8),)), 40_000 << 8, SQUARES)

    # Its ideal interval is 320000 * (sqrt(2) - 1) = 132548: 3.3137 times as long, 2.3137 too fast.
    assert float(found.speed) == pytest.approx(2.31371, rel=1e-5)
    assert found.steps == 16


def test_a_cruise_that_is_reached_too_late_is_found() -> None:
    """
    A ladder that stays at its first interval for 20 steps: then the ideal one is at 40 000.
    """
    found = errors(Ladder(320_000 << 8, (Rung(1, 32, 280_000 << 8),)), 40_000 << 8, SQUARES)

    assert found.steps == 32
    assert found.speed == Fraction(280_000, 320_000)


@given(st.integers(0, 10_000), st.integers(1, 10**7), st.integers(0, 10**6))
def test_speeds_are_cut_off_to_the_last_bit(start: int, acceleration: int, steps: int) -> None:
    """
    v^2 is v0^2 + 2ar, or less by less than one bit of v makes.
    """
    wish = Wish(F_CPU, Fraction(start), Fraction(10**9), Fraction(acceleration))

    speed = wish.speed(steps)

    square = start**2 + 2 * acceleration * steps
    assert speed**2 <= square < (speed + Fraction(1, 2**64)) ** 2

"""
The ramp of an axis against physics: one that is off is found, whatever the planner says of it.
"""

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from stepgen import api
from stepgen.plan.curves import Speeds
from stepgen.plan.ladder import Ladder, plan_ladder
from stepgen.plan.model import Plan
from stepgen.reference import ladder as reference
from stepgen.reference.ladder import Rung
from stepgen.reference.ramp import WORST_ERROR, Wish, errors
from stepgen.verify.ramps import judge_ramps
from stepgen.verify.report import Check, SpecReport

SPEC = Path(__file__).parents[2] / "specs" / "uno_trapezoid.yaml"


def judged(plan: Plan) -> Check:
    """
    Return the check of the only ramp of *plan*.
    """
    report = SpecReport("spec", "compiler", "simulator")
    judge_ramps(api.load(SPEC), plan, report)
    return report.checks[0]


def with_ladder(plan: Plan, ladder: Ladder) -> Plan:
    """
    Return *plan* with *ladder* for its motor.
    """
    motor = plan.motors[0]
    return replace(plan, motors=(replace(motor, motion=replace(motor.motion, ladder=ladder)),))


def test_the_planned_ramp_is_what_was_asked_for() -> None:
    """
    Its check has a name with the motor's, and says how far off it is.
    """
    check = judged(api.plan(SPEC))

    assert check.passed, check.detail
    assert check.name == "slide: the ramp against ideal physics"


def test_a_first_interval_that_is_half_a_percent_too_short_is_found() -> None:
    """
    The speed of the first step is too high by more than 0.4 %.
    """
    plan = api.plan(SPEC)
    ladder = plan.motors[0].motion.ladder
    assert ladder is not None
    # All levels become that much faster by the same number of clocks, the last ones by half.
    shorter = replace(ladder, first_interval_256=ladder.first_interval_256 * 995 // 1000)

    check = judged(with_ladder(plan, shorter))

    assert not check.passed
    assert "a speed of the ramp is" in check.detail
    assert "0.4% are allowed" in check.detail


def test_a_ramp_of_another_acceleration_is_found() -> None:
    """
    Without its last row it never comes near the cruise, to which it jumps.
    """
    plan = api.plan(SPEC)
    ladder = plan.motors[0].motion.ladder
    assert ladder is not None

    check = judged(with_ladder(plan, replace(ladder, rows=ladder.rows[:-2])))

    assert not check.passed


def test_a_motor_that_is_no_axis_has_no_such_check() -> None:
    """
    There is no ramp to judge.
    """
    path = SPEC.with_name("uno_compare_two.yaml")
    report = SpecReport("spec", "compiler", "simulator")

    judge_ramps(api.load(path), api.plan(path), report)

    assert report.checks == []


@pytest.mark.parametrize(
    ("start", "cruise", "acceleration", "jerk"),
    [
        (0, 10_000, 20_000, 100_000),
        (0, 10_000, 20_000, 20_000),  # the acceleration never comes to its highest
        (500, 16_000, 40_000, 100_000),
        (50, 2_000, 20_000, 20_000),
        (0, 300, 300, 300),
        (0, 4_000, 8_000, 1_000_000),  # nearly none of an S
    ],
)
def test_an_s_keeps_to_physics(start: int, cruise: int, acceleration: int, jerk: int) -> None:
    """
    Times that are looked for by halving, in integers, agree with those that Newton's method found.
    """
    numbers = [Fraction(number) for number in (start, cruise, acceleration, jerk)]
    ladder = plan_ladder(16_000_000, Speeds(*numbers))
    assert ladder is not None
    rungs = tuple(Rung(row.levels, row.steps, row.slope_256) for row in ladder.rows)
    climbed = reference.Ladder(ladder.first_interval_256, rungs)

    found = errors(climbed, 16_000_000 * 256 // cruise, Wish(16_000_000, *numbers))

    assert found.speed <= WORST_ERROR
    assert found.time <= Fraction(1, 10_000)


def test_the_first_step_of_an_s_is_the_cube_root() -> None:
    """
    From rest s = j t^3 / 6: with 48 000 steps/s^3 the first step takes 1/20 s.
    """
    speeds = Speeds(Fraction(0), Fraction(5_000), Fraction(20_000), Fraction(48_000))
    ladder = plan_ladder(16_000_000, speeds)

    assert ladder is not None
    assert ladder.first_interval_256 == 16_000_000 * 256 // 20


def test_an_s_takes_its_mean_speed_times_its_length() -> None:
    """
    From 0 to 10 000 steps/s: 0.2 s with rising acceleration, 0.3 s even, 0.2 s falling: 3500 steps.
    """
    numbers = [Fraction(number) for number in (0, 10_000, 20_000, 100_000)]

    assert Speeds(*numbers).steps == Wish(16_000_000, *numbers).steps == 3_500


@given(
    f_cpu_hz=st.sampled_from([8_000_000, 16_000_000]),
    start=st.integers(0, 500),
    rise=st.integers(50, 5_000),
    acceleration=st.integers(20, 4_000),
    jerk=st.none() | st.integers(500, 50_000),
)
def test_no_row_comes_to_laps_or_leaves_them(
    f_cpu_hz: int, start: int, rise: int, acceleration: int, jerk: int | None
) -> None:
    """
    An interval of 32768 clocks or more has laps, which begin and end with rows of their own steps.
    """
    bend = None if jerk is None else Fraction(jerk)
    speeds = Speeds(Fraction(start), Fraction(start + rise), Fraction(acceleration), bend)
    ladder = plan_ladder(f_cpu_hz, speeds)
    assume(ladder is not None)
    assert ladder is not None
    interval = ladder.first_interval_256
    for row in ladder.rows:
        last = interval - (row.levels - 1) * row.slope_256
        slow = 32_768 * 256
        assert (interval >= slow) == (last >= slow), row
        assert row.steps == 1 or interval < slow, row
        interval -= row.levels * row.slope_256

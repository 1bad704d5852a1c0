"""
The ramp of an axis against physics: one that is off is found, whatever the planner says of it.
"""

from dataclasses import replace
from pathlib import Path

from stepgen import api
from stepgen.plan.ladder import Ladder
from stepgen.plan.model import Plan
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

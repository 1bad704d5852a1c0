"""
The ramp of each axis against ideal physics: whatever the planner chose, it is what was asked for.
"""

from collections.abc import Iterator
from fractions import Fraction
from typing import Any

from stepgen.plan.model import Plan
from stepgen.reference.ramp import WORST_ERROR, Wish, errors
from stepgen.spec import LoadedSpec
from stepgen.verify.ladders import ladder_of
from stepgen.verify.report import SpecReport
from stepgen.verify.units import steps_in

_NAME = "the ramp against ideal physics"


def judge_ramps(loaded: LoadedSpec, plan: Plan, report: SpecReport) -> None:
    """
    Add to *report* how far the speeds and the length of each ramp are from what the spec asks for.

    No ramp may be further off than `stepgen.reference.ramp.WORST_ERROR`.
    """
    for planned in plan.motors:
        ladder = ladder_of(planned.motion)
        if ladder is None:
            continue
        asked: Any = loaded.spec.motors[planned.name].motion
        start, cruise, acceleration, jerk = (
            wanted.number * steps_in(wanted.unit, planned) if wanted else Fraction(0)
            for wanted in (asked.start_speed, asked.cruise_speed, asked.acceleration, asked.jerk)
        )
        wish = Wish(plan.board.f_cpu_hz, start, cruise, acceleration, jerk or None)
        found = errors(ladder, planned.motion.cruise_interval_256, wish)
        findings = tuple(_findings(found.speed, found.time))
        report.check(
            f"{planned.name}: {_NAME}",
            findings,
            f"{found.steps} steps, each within {float(found.speed):.4%} of its speed; the ramp is "
            f"{float(found.late_clocks):+.0f} clocks off, {float(found.time):.4%} of its length",
        )


def _findings(speed: Fraction, time: Fraction) -> Iterator[str]:
    for what, error in (("a speed of the ramp", speed), ("the length of the ramp", time)):
        if error > WORST_ERROR:
            yield f"{what} is {float(error):.4%} off; {float(WORST_ERROR):.1%} are allowed"

"""
What came out of a verification: in a few words, and check by check.
"""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from stepgen.datasheet.names import together
from stepgen.plan.model import MotorPlan, Plan

if TYPE_CHECKING:
    from stepgen.datasheet.report import Report


def outcome(report: "Report | None") -> str:
    """
    Return what came out of the verification, in a few words.
    """
    if report is None:
        return "not verified yet: run stepgen verify"
    failed = sum(not check.passed for check in report.checks)
    tools = f"{report.compiler} on {report.simulator}"
    if report.passed:
        return f"verified: {len(report.checks)} checks passed, {tools}"
    return f"FAILED: {failed} of {len(report.checks)} checks, {tools}"


def passed_checks(report: "Report | None", plan: Plan) -> Iterator[tuple[str, str]]:
    """
    Yield motors and the names of the checks that passed for each of them.

    Those of no motor come first, with "" instead; checks that several motors passed are told once.
    """
    passed = [check.name for check in report.checks if check.passed] if report else []
    motors = {motor.name: motor for motor in plan.motors}
    own, who = [], dict[str, dict[str, MotorPlan]]()
    for check in passed:
        name, _, what = check.partition(": ")
        if what and name in motors:
            who.setdefault(what, {})[name] = motors[name]
        else:
            own.append(check)
    if own:
        yield "", "; ".join(own)
    alike: dict[tuple[str, ...], list[str]] = {}
    for what, having in who.items():
        alike.setdefault(tuple(having), []).append(what)
    for names, checks in alike.items():
        yield together([motors[name] for name in names], plan), "; ".join(checks)

"""
The conformance suite: small programs with the outcome that the datasheet demands.

Each point is one demand. A simulator that does not meet a point is not used for a spec that
depends on it (see `needs`).
"""

from stepgen.verify.conformance.point import Point
from stepgen.verify.conformance.points import points
from stepgen.verify.conformance.suite import Verdict, judge, judge_all

__all__ = ["Point", "Verdict", "judge", "judge_all", "points"]

"""
How many steps the units of a spec are, for the oracle: without the planner's conversion.
"""

from fractions import Fraction

from stepgen.plan.model import MotorPlan


def steps_in(unit: str, motor: MotorPlan) -> Fraction:
    """
    Return how many steps of *motor* one of *unit* is.
    """
    if unit == "steps":
        return Fraction(1)
    per = motor.steps_per_mm if unit == "mm" else motor.steps_per_turn
    return Fraction(per or 0) / (360 if unit == "deg" else 1)

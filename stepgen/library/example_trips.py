"""
Where the example Home sends a motor that has found home.
"""

from dataclasses import dataclass

from stepgen.plan.end_stops import EndStops, HomingPlan
from stepgen.plan.model import MotorPlan

_DEFAULT_STEPS = 200


@dataclass(frozen=True)
class Trip:
    """
    The two places between which *motor* goes, and *where* these are.
    """

    motor: str
    title: str
    near: int
    far: int
    where: str


def example_trip(motor: MotorPlan) -> Trip | None:
    """
    Return the ways of *motor* between the ends of its range, or a turn to and from home.

    None for a motor that finds no home.
    """
    stops = motor.end_stops
    if stops is None or stops.homing is None:
        return None
    near, far, where = _places(motor, stops, stops.homing)
    return Trip(motor.name, motor.name[0].upper() + motor.name[1:], near, far, where)


def _places(motor: MotorPlan, stops: EndStops, homing: HomingPlan) -> tuple[int, int, str]:
    if stops.range:
        return *stops.range, "the ends of its range"
    steps = round(motor.steps_per_turn) if motor.steps_per_turn else _DEFAULT_STEPS
    away = steps if homing.towards == "low" else -steps
    way = "a turn" if motor.steps_per_turn else f"{steps} steps"
    return homing.park, homing.park + away, f"at home, and {way} from there"

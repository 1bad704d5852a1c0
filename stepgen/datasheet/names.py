"""
What motors are called: by name, by number where there is little room, together if it is all.
"""

from collections.abc import Iterator, Sequence

from stepgen.library.text import listed
from stepgen.plan.model import MotorPlan, Plan

_LONGEST_TAG = 16  # letters that two tags beside a Mega have room for
_FEW = 3


def together(motors: Sequence[MotorPlan], plan: Plan) -> str:
    """
    Return the names of *motors*; if these are all of many, just that.
    """
    if len(motors) == len(plan.motors) > _FEW:
        return "all motors"
    return listed([motor.name for motor in motors])


def tag_names(plan: Plan) -> tuple[str, ...]:
    """
    Return the name of each motor, or its number in the order of the spec.
    """
    names = tuple(motor.name for motor in plan.motors)
    if all(len(tag) <= _LONGEST_TAG for motor in plan.motors for tag in _tags(motor)):
        return names
    return tuple(f"{number}:" for number in range(1, len(names) + 1))


def numbered_names(plan: Plan) -> dict[str, str]:
    """
    Return what each motor is called in the table of motors: with its number, if tags have numbers.
    """
    names = [motor.name for motor in plan.motors]
    return {
        name: name if tag == name else f"{tag} {name}"
        for name, tag in zip(names, tag_names(plan), strict=True)
    }


def row_names(plan: Plan) -> dict[str, str]:
    """
    Return what each motor is called in other tables: by its number alone, if it is one of many.
    """
    if len(plan.motors) <= _FEW:
        return numbered_names(plan)
    return dict(zip((motor.name for motor in plan.motors), tag_names(plan), strict=True))


def _tags(motor: MotorPlan) -> Iterator[str]:
    yield from (f"{motor.name} {wire.signal}" for wire in motor.drive.every_wire)
    yield from (f"{motor.name} {switch.signal}" for switch in motor.end_switches)

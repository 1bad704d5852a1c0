"""
The view of enables that several drivers share: who needs them, and what users must know.
"""

from dataclasses import dataclass

from stepgen.library.text import comment_lines, hexadecimal, listed
from stepgen.plan.model import MotorPlan, Plan


@dataclass(frozen=True)
class Need:
    """
    A motor's bit in the variable that says who needs the shared enables, and the other motors.

    *anybody* is an expression: whether any of them all needs them.
    """

    mask: str
    inverse: str
    other: str
    others: tuple[str, ...]
    anybody: str


def need_of(motor: MotorPlan, plan: Plan) -> Need | None:
    """
    Return the bit of *motor*, None if its enables are its own.
    """
    names = _sharers(plan)
    if motor.name not in names:
        return None
    mask = 1 << names.index(motor.name)
    together = _with_its_enables(motor, plan)
    others = [name for name in together if name != motor.name]
    everyone = sum(1 << names.index(name) for name in together)
    anybody = "enablesNeeded"
    if len(together) < len(names):
        anybody += f" & {hexadecimal(everyone)}"
    inverse = hexadecimal(~mask & 0xFF)
    return Need(hexadecimal(mask), inverse, listed(others, "or"), tuple(others), anybody)


def needs_comment(plan: Plan) -> tuple[str, ...]:
    """
    Return what the variable of all needs is, as lines of a comment; none if no enables are shared.
    """
    names = _sharers(plan)
    bits = ", ".join(f"{hexadecimal(1 << index)} {name}" for index, name in enumerate(names))
    return comment_lines(
        f"Which motors need the enables that they share with others, a bit for each: {bits}. "
        "Enables stay active as long as one of those that share them does."
        if names
        else ""
    )


def sharing_note(motor: MotorPlan, need: Need | None, plan: Plan) -> str:
    """
    Return what users of *motor* must know about its enables; empty if they are its own.
    """
    if need is None:
        return ""
    return (
        f"{_enables(motor)} for {need.other} too: as long as one of these motors needs current, "
        "the coils of all have it, also those of one that was released. Call "
        f"{listed([f'{name}ShieldInit()' for name in _with_its_enables(motor, plan)])} before any "
        "of them moves."
    )


def sharing_rules(plan: Plan) -> tuple[str, ...]:
    """
    Return the same for the whole library, a rule for each group of motors with the same enables.
    """
    groups = {motor.drive.released: motor for motor in plan.motors if motor.drive.shared_enables}
    return tuple(
        f"{_enables(motor)} for {listed(_with_its_enables(motor, plan))}: as long as one of these "
        "motors needs current, the coils of all have it, also those of one that was released."
        for motor in groups.values()
    )


def _with_its_enables(motor: MotorPlan, plan: Plan) -> list[str]:
    return [other.name for other in plan.motors if other.drive.released == motor.drive.released]


def _sharers(plan: Plan) -> list[str]:
    return [motor.name for motor in plan.motors if motor.drive.shared_enables]


def _enables(motor: MotorPlan) -> str:
    labels = [wire.pin.label for wire in motor.drive.enables]
    return f"{listed(labels)} {'is the enable' if len(labels) == 1 else 'are the enables'}"

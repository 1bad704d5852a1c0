"""
The view of enables that two stacked shields share: who needs them, and what users must know.
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
        f"Which motors need the enables that both shields share, a bit for each: {bits}. The "
        "enables are HIGH as long as one of them does."
        if names
        else ""
    )


def sharing_note(motor: MotorPlan, need: Need | None) -> str:
    """
    Return what users of *motor* must know about its enables; empty if they are its own.
    """
    if need is None:
        return ""
    return (
        f"{_enables(motor)} are the enables of {need.other} too: as long as either motor needs "
        "current, the coils of both have it, also those of a motor that was released. Call "
        "ShieldInit() of both before either moves."
    )


def sharing_rule(plan: Plan) -> str:
    """
    Return the same for the whole library; empty if no enables are shared.
    """
    names = _sharers(plan)
    if not names:
        return ""
    first = next(motor for motor in plan.motors if motor.name in names)
    return (
        f"{_enables(first)} are the enables of both shields: as long as {listed(names, 'or')} "
        "needs current, the coils of both have it, also those of a motor that was released."
    )


def _with_its_enables(motor: MotorPlan, plan: Plan) -> list[str]:
    return [other.name for other in plan.motors if other.drive.released == motor.drive.released]


def _sharers(plan: Plan) -> list[str]:
    return [motor.name for motor in plan.motors if motor.drive.shared_enables]


def _enables(motor: MotorPlan) -> str:
    return listed([wire.pin.label for wire in motor.drive.enables])

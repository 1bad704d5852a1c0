"""
Speeds, accelerations, jerks, ways and places: in steps, or millimetres, degrees or turns.
"""

import re
from dataclasses import dataclass
from fractions import Fraction
from typing import Annotated, Any, Literal

from stepgen.spec.base import short_form
from stepgen.spec.turns import as_ratio

Unit = Literal["steps", "mm", "deg", "turns"]

_LENGTH_WORDS = re.compile(r"(?P<number>\S+) *(?P<unit>steps|mm|deg|turns)")
_WORDS = re.compile(r"(?P<number>\S+) *(?P<unit>steps|mm|deg|turns)(?P<per>/s(\^[23])?)")
_FARTHEST = (1 << 31) - 1
_NO_PLACE = "is no number of steps; write one, or such as 50 mm, -90 deg or 1.5 turns"


@dataclass(frozen=True)
class Quantity:
    """
    A number of a unit, or of it per second, squared or cubed: exactly as it was written.
    """

    number: Fraction
    unit: Unit = "steps"

    def __str__(self) -> str:
        """
        Return the number with its unit, without the seconds.
        """
        return f"{float(self.number):g} {self.unit}"


def _quantity(value: Any, per: str) -> Quantity:  # noqa: ANN401 - whatever the YAML held
    if isinstance(value, str) and " " in value.strip():
        words = _WORDS.fullmatch(value.strip())
        if words is None or words["per"] != per:
            raise ValueError(
                f"is no quantity; write steps{per} as a number, or such as 50 mm{per}, 90 deg{per} "
                f"or 1.5 turns{per}"
            )
        unit: Any = words["unit"]
        return Quantity(as_ratio(words["number"]), unit)
    return Quantity(as_ratio(value))


def _place(value: Any) -> Quantity:  # noqa: ANN401 - whatever the YAML held
    """
    Return where *value* is: a number with a sign, or 0.
    """
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        raise ValueError(_NO_PLACE)  # noqa: TRY004 - for pydantic
    words = _LENGTH_WORDS.fullmatch(str(value).strip() + ("" if _has_unit(value) else " steps"))
    if words is None:
        raise ValueError(_NO_PLACE)
    number = words["number"]
    sign = -1 if number.startswith("-") else 1
    size = number.removeprefix("-")
    is_zero = re.fullmatch(r"0+(\.0+)?", size)
    unit: Any = words["unit"]
    return Quantity(Fraction(0) if is_zero else sign * as_ratio(size, _FARTHEST), unit)


def _has_unit(value: float | str) -> bool:
    return isinstance(value, str) and " " in value.strip()


def _way(value: Any) -> Quantity:  # noqa: ANN401 - whatever the YAML held
    way = _place(value)
    if way.number <= 0:
        raise ValueError("is no way; write one above 0, such as 5 mm")
    return way


def _speed(value: Any) -> Quantity:  # noqa: ANN401 - whatever the YAML held
    return _quantity(value, "/s")


def _acceleration(value: Any) -> Quantity:  # noqa: ANN401 - whatever the YAML held
    return _quantity(value, "/s^2")


def _jerk(value: Any) -> Quantity:  # noqa: ANN401 - whatever the YAML held
    return _quantity(value, "/s^3")


Speed = Annotated[Quantity, short_form(_speed, int | float | str)]
"""A positive speed: a number of steps per second, or such as ``50 mm/s``."""

Acceleration = Annotated[Quantity, short_form(_acceleration, int | float | str)]
"""A positive acceleration: a number of steps/s^2, or such as ``500 mm/s^2``."""

Jerk = Annotated[Quantity, short_form(_jerk, int | float | str)]
"""A positive jerk: a number of steps/s^3, or such as ``2000 mm/s^3``."""

Place = Annotated[Quantity, short_form(_place, int | float | str)]
"""A position: a number of steps, or such as ``-2 mm``."""

Way = Annotated[Quantity, short_form(_way, int | float | str)]
"""How far, above 0: a number of steps, or such as ``5 mm``."""

"""
Steps in one turn: a whole number, or full steps of the motor times its gear.
"""

from decimal import Decimal
from fractions import Fraction
from typing import Annotated, Any

from pydantic import Field

from stepgen.spec.base import SpecModel, short_form

_LARGEST = 1_000_000


def _fraction(value: Any) -> Fraction:  # noqa: ANN401 - whatever the YAML held
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        raise ValueError("is no number; write 64, 63.68395 or a fraction such as 25792/405")  # noqa: TRY004 - for pydantic
    try:
        # A float's shortest text is what the user typed; its binary value is not.
        number = Fraction(value) if isinstance(value, str) else Fraction(Decimal(str(value)))
    except (ValueError, ArithmeticError):
        raise ValueError(
            "is no number; write 64, 63.68395 or a fraction such as 25792/405"
        ) from None
    if not 0 < number <= _LARGEST or number.denominator > _LARGEST:
        raise ValueError(f"is out of range; it must be above 0 and at most {_LARGEST}")
    return number


Ratio = Annotated[Fraction, short_form(_fraction, int | float | str)]
"""A positive ratio, kept exactly as it was written."""


class StepsPerTurn(SpecModel):
    """
    Full steps of the bare motor in one turn, and turns of the motor in one of the shaft.
    """

    full_steps: Annotated[int, Field(ge=1, le=_LARGEST)]
    """Full steps of the bare motor in one turn."""
    gear: Ratio = Fraction(1)
    """Turns of the motor in one of the shaft: 64, 63.68395 or 25792/405; kept exactly."""

    @property
    def exact(self) -> Fraction:
        """
        Return the full steps in one turn of the shaft, an exact fraction.
        """
        return self.full_steps * self.gear


def _as_steps(value: Any) -> Any:  # noqa: ANN401 - whatever the YAML held
    return {"full_steps": value} if isinstance(value, int) else value


Steps = Annotated[StepsPerTurn, short_form(_as_steps, StepsPerTurn | int)]

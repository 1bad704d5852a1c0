"""
Steps in one turn: a whole number, or full steps of the motor times its gear.
"""

import re
from decimal import Decimal
from fractions import Fraction
from typing import Annotated, Any, Self

from pydantic import AfterValidator, Field, model_validator

from stepgen.spec.base import SpecModel, short_form

_LARGEST = 1_000_000
_UINT32_MAX = 0xFFFF_FFFF
# As people write a gear. Fraction() takes more, such as 1e999999999, and then works for hours.
_RATIO = re.compile(r"[0-9]{1,12}(\.[0-9]{1,12}|/[0-9]{1,12})?")
_NO_NUMBER = "is no number; write 64, 63.68395 or a fraction such as 25792/405"


def as_ratio(value: Any, largest: int = _LARGEST) -> Fraction:  # noqa: ANN401 - whatever the YAML held
    """
    Return *value* exactly as it was written, up to *largest*.

    Raises:
        ValueError: It is no number above 0, or none of a size that can be computed with.
    """
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        raise ValueError(_NO_NUMBER)  # noqa: TRY004 - for pydantic
    if isinstance(value, str) and not _RATIO.fullmatch(value):
        raise ValueError(_NO_NUMBER)
    try:
        # A float's shortest text is what the user typed; its binary value is not.
        number = Fraction(value) if isinstance(value, str) else Fraction(Decimal(str(value)))
    except (ValueError, ArithmeticError):
        raise ValueError(_NO_NUMBER) from None
    if not 0 < number <= largest or number.denominator > _LARGEST:
        raise ValueError(f"is out of range; write one above 0 and at most {largest}")
    return number


Ratio = Annotated[Fraction, short_form(as_ratio, int | float | str)]
"""A positive ratio, kept exactly as it was written."""


def _computable(per_mm: Fraction) -> Fraction:
    """
    Return *per_mm* if 32-bit positions, speeds and ways times its parts always fit 64 bits.
    """
    nanometres = 1_000_000 / per_mm
    parts = (nanometres.numerator, nanometres.denominator, (per_mm / 1_000).numerator)
    if max(parts) > _UINT32_MAX:
        raise ValueError(
            "has more digits than the chip can compute with; write at most three behind the point, "
            "or a fraction such as 20000/127"
        )
    return per_mm


StepsPerMm = Annotated[Ratio, AfterValidator(_computable)]
"""Steps in a millimetre, such that no product of the metric functions overflows."""


class StepsPerTurn(SpecModel):
    """
    Full steps of the bare motor in one turn, and turns of the motor in one of the shaft.
    """

    full_steps: Annotated[int, Field(ge=1, le=_LARGEST)]
    """Full steps of the bare motor in one turn."""
    gear: Ratio = Fraction(1)
    """Turns of the motor in one of the shaft: 64, 63.68395 or 25792/405; kept exactly."""

    @model_validator(mode="after")
    def _a_turn_is_countable(self) -> Self:
        if self.exact > _LARGEST:
            raise ValueError("makes more than a million full steps in a turn; take a smaller gear")
        return self

    @property
    def exact(self) -> Fraction:
        """
        Return the full steps in one turn of the shaft, an exact fraction.
        """
        return self.full_steps * self.gear


def _as_steps(value: Any) -> Any:  # noqa: ANN401 - whatever the YAML held
    return {"full_steps": value} if isinstance(value, int) else value


Steps = Annotated[StepsPerTurn, short_form(_as_steps, StepsPerTurn | int)]

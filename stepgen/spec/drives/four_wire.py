"""
Four wires, one for each coil: a ULN2003, ULN2004, ULN2803 or any four switches.
"""

from collections import Counter
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from stepgen.spec.base import KindModel
from stepgen.spec.pins import PinName
from stepgen.spec.sequence import Sequence


class FourWire(KindModel):
    """
    Drive ``four-wire``: coils A, B, C and D in the order in which they follow each other.
    """

    kind: Literal["four-wire"] = "four-wire"
    pins: Annotated[tuple[PinName, PinName, PinName, PinName], Field(strict=False)]
    """Coils A, B, C and D, in the order in which they follow each other."""
    sequence: Sequence = "full"
    """`full`, `wave`, `half`, or an own table of patterns."""

    @model_validator(mode="after")
    def _coils_have_pins_of_their_own(self) -> Self:
        repeated = sorted(pin for pin, n in Counter(self.pins).items() if n > 1)
        if repeated:
            raise ValueError(
                f"pin {repeated[0]} drives two coils; give each of the four coils a pin of its own"
            )
        return self


SPEC = FourWire

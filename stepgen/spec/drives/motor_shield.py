"""
The Arduino Motor Shield (R3): an L298 on fixed pins, or a second one stacked upon it.
"""

from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from stepgen.spec.base import KindModel
from stepgen.spec.pins import PinName
from stepgen.spec.sequence import NamedSequence

_ENABLE_COUNT = 2


def _as_enables(value: Any) -> Any:  # noqa: ANN401 - whatever the YAML held
    if not isinstance(value, list | tuple) or len(value) != _ENABLE_COUNT:
        raise ValueError("are two pins, those of PWM A and PWM B; write them as [D5, D6]")
    return value


Enables = Annotated[tuple[PinName, PinName], Field(strict=False), BeforeValidator(_as_enables)]
"""The pins of a shield's PWM A and PWM B, which are the L298's enables."""


class MotorShield(KindModel):
    """
    Drive ``motor-shield``: PWM A D3, PWM B D11, DIR A D12, DIR B D13, brakes D9 and D8.

    ``stacked: true`` is the shield on top of another one: its D12 and D13 are cut and wired to
    D9 and D8, and the brake jumpers of both are cut, so that neither has brakes any more. Its
    enables are the lower shield's D3 and D11, unless they are cut as well and wired to the two
    pins of ``enables``.
    """

    kind: Literal["motor-shield"] = "motor-shield"
    sequence: NamedSequence = "full"
    """`full`, `wave` or `half`."""
    stacked: bool = False
    """Whether this is a second shield, on top of another one."""
    enables: Enables | None = None
    """The pins of PWM A and PWM B of a stacked shield whose D3 and D11 are cut."""

    @model_validator(mode="after")
    def _enables_are_rewired_on_top(self) -> Self:
        if self.enables is None:
            return self
        if not self.stacked:
            raise ValueError(
                "enables are for the shield on top, whose D3 and D11 are cut; add "
                "`stacked: true`, or remove them"
            )
        if len(set(self.enables)) < _ENABLE_COUNT:
            raise ValueError(
                f"pin {self.enables[0]} is both enables; give PWM A and PWM B a pin of its own each"
            )
        return self


SPEC = MotorShield

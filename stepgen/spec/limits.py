"""
Limits of an axis: switches at the ends of its way, the range that it keeps to, and homing.
"""

from fractions import Fraction
from typing import Annotated, Any, Literal, Self

from pydantic import Field, model_validator

from stepgen.spec.base import SpecModel, short_form
from stepgen.spec.pins import PinName
from stepgen.spec.quantities import Place, Quantity, Speed, Way

End = Literal["low", "high"]


class Switch(SpecModel):
    """
    A limit switch: its pin, and what that shows when the motor is there.
    """

    pin: PinName
    """The pin."""
    active: Literal["low", "high"] = "low"
    """Its level at the end of the way: `low` for a switch to ground that closes there, `high` for
    one that opens there, as a broken wire does."""
    pull_up: bool = True
    """Whether the chip pulls the pin up, as a switch to ground needs."""


def _as_switch(value: Any) -> Any:  # noqa: ANN401 - whatever the YAML held
    return {"pin": value} if isinstance(value, int | str) else value


SwitchEntry = Annotated[Switch, short_form(_as_switch, Switch | str | int)]
"""A switch; one that closes to ground may be just its pin."""


class Homing(SpecModel):
    """
    How an axis finds its place: fast to the switch, back off, and slowly to it once more.
    """

    towards: End = "low"
    """The end whose switch it looks for."""
    speed: Speed
    """How fast it looks for the switch: it comes to rest behind it, by its ramp."""
    slow_speed: Speed
    """How fast it comes to the switch the second time, which decides where that is."""
    back_off: Way
    """How far it goes back from the switch in between; there the switch must be off again."""
    travel: Way
    """How far it looks for the switch before it gives up."""
    position: Place = Quantity(Fraction(0))
    """What the place is called at which the switch is seen."""


class Limits(SpecModel):
    """
    What an axis keeps to: at least a switch or a range.
    """

    low: SwitchEntry | None = None
    """The switch at the low end, which a motor reaches backward; a pin, or pin, active, pull_up."""
    high: SwitchEntry | None = None
    """The switch at the high end, which it reaches forward."""
    range: Annotated[tuple[Place, Place], Field(strict=False)] | None = None
    """The lowest and the highest position that a move may have, such as [0, 180 mm]."""
    homing: Homing | None = None
    """How it finds the switch of an end, from which positions count."""

    @model_validator(mode="after")
    def _has_a_limit(self) -> Self:
        if self.low is None and self.high is None and self.range is None:
            raise ValueError(
                "limits nothing; give it a switch, such as `low: D9`, or `range: [0, 2000]`"
            )
        return self

    @model_validator(mode="after")
    def _homing_has_its_switch(self) -> Self:
        if self.homing and getattr(self, self.homing.towards) is None:
            end = self.homing.towards
            raise ValueError(
                f"has homing towards {end}, where no switch is; add one, such as `{end}: D9`, or "
                f"home towards the other end"
            )
        return self

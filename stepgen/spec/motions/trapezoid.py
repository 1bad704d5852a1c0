"""
Trapezoid: each move speeds up, cruises and slows down, with the functions of an axis.
"""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Annotated, ClassVar, Literal, Self

from pydantic import Field, model_validator

from stepgen.spec.base import KindModel
from stepgen.spec.turns import Ratio

MOST_QUEUED = 16


class Trapezoid(KindModel):
    """
    Motion ``trapezoid``: moves to positions, with ramps.
    """

    first: ClassVar[Mapping[str, int]] = MappingProxyType(
        {"cruise_speed": 1000, "acceleration": 2000}
    )
    kind: Literal["trapezoid"] = "trapezoid"
    cruise_speed: Ratio
    """The highest speed in steps per second, and the one that holds until the sketch sets one."""
    acceleration: Ratio
    """How fast it speeds up and slows down, in steps per second each second."""
    start_speed: Ratio | None = None
    """The speed in steps per second that it may take at once; without it a move begins from 0."""
    queue: Annotated[int, Field(ge=0, le=MOST_QUEUED)] = 0
    """How many moves can wait behind the present one; with 0 there is no function for it."""

    @model_validator(mode="after")
    def _speeds_up(self) -> Self:
        if self.start_speed is not None and self.start_speed >= self.cruise_speed:
            raise ValueError(
                f"start_speed {float(self.start_speed):g} is not below cruise_speed "
                f"{float(self.cruise_speed):g}; make it lower, or leave it out to begin from 0"
            )
        return self


SPEC = Trapezoid

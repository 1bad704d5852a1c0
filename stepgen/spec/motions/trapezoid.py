"""
Trapezoid: each move speeds up, cruises and slows down, with the functions of an axis.
"""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Annotated, ClassVar, Literal

from pydantic import Field

from stepgen.spec.base import KindModel
from stepgen.spec.quantities import Acceleration, Jerk, Speed

MOST_QUEUED = 16


class Trapezoid(KindModel):
    """
    Motion ``trapezoid``: moves to positions, with ramps.
    """

    first: ClassVar[Mapping[str, int]] = MappingProxyType(
        {"cruise_speed": 1000, "acceleration": 2000}
    )
    kind: Literal["trapezoid"] = "trapezoid"
    cruise_speed: Speed
    """The highest speed, in steps/s or such as ``50 mm/s``; it holds until the sketch sets one."""
    acceleration: Acceleration
    """How fast it speeds up and slows down, in steps/s^2 or such as ``500 mm/s^2``."""
    start_speed: Speed | None = None
    """The speed that it may take at once; without it a move begins from 0."""
    jerk: Jerk | None = None
    """How fast the acceleration may change, in steps/s^3 or such as ``2000 mm/s^3``."""
    queue: Annotated[int, Field(ge=0, le=MOST_QUEUED)] = 0
    """How many moves can wait behind the present one; with 0 there is no function for it."""


SPEC = Trapezoid

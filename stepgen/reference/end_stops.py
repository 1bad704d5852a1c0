"""
What keeps an axis within its limits: the facts, and what the model knows of them at a moment.
"""

from dataclasses import dataclass, field
from enum import IntEnum
from typing import Literal

End = Literal["low", "high"]


class Fault(IntEnum):
    """
    Why an axis moves no more until the fault is cleared.
    """

    NONE = 0
    LIMIT = 1
    HOMING = 2
    EMERGENCY = 3


class Leg(IntEnum):
    """
    The legs of homing, in their order; NONE while there is no homing.
    """

    NONE = 0
    SEEK = 1
    BACK_OFF = 2
    APPROACH = 3
    PARK = 4


@dataclass(frozen=True)
class HomingFacts:
    """
    How an axis finds home; ways and places in steps, intervals in 1/256 clock.

    Args:
        towards: The end whose switch it looks for.
        fast_256: The shortest interval of all legs but the approach; slow_256: that of the latter.
        back_off: How far before the first contact the approach begins.
        travel: How far it looks for the switch.
        position: What the place of the second contact is called.
        park: Where it comes to rest in the end.
    """

    towards: End
    fast_256: int
    slow_256: int
    back_off: int
    travel: int
    position: int
    park: int

    @property
    def there(self) -> int:
        """
        Return the direction towards the switch, +1 or -1.
        """
        return -1 if self.towards == "low" else 1


@dataclass(frozen=True)
class EndStopFacts:
    """
    The ends at which an axis has a switch, the range of its positions, and its homing.
    """

    switches: frozenset[End]
    range: tuple[int, int] | None = None
    homing: HomingFacts | None = None

    def allows(self, position: int) -> bool:
        """
        Tell whether *position* lies within the range, if there is one.
        """
        return self.range is None or self.range[0] <= position <= self.range[1]


@dataclass
class EndStopState:
    """
    What an axis knows of its limits.

    Args:
        pressed: The switches that are pressed.
        fault: Why it moves no more.
        homed: Whether its positions count from the switch.
        leg: The leg of homing that is under way.
        contact: Where the switch was seen last.
        seen: Whether it was seen on this leg.
        sketch_256: The shortest interval that the sketch had set before homing.
    """

    pressed: frozenset[str] = frozenset()
    fault: Fault = Fault.NONE
    homed: bool = False
    leg: Leg = Leg.NONE
    contact: int = 0
    seen: bool = False
    sketch_256: int = field(default=0)

    def leads_into(self, direction: int) -> bool:
        """
        Tell whether the switch at the end in *direction* is pressed, and has not been seen before.
        """
        return ("low" if direction < 0 else "high") in self.pressed and not self.seen

    @property
    def looks_for_switch(self) -> bool:
        """
        Tell whether the leg under way is to meet the switch.
        """
        return self.leg in {Leg.SEEK, Leg.APPROACH}

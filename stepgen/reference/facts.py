"""
What the model is told about a motor and about the chip that drives it.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from stepgen.reference.contract import MotionKind
from stepgen.reference.sequences import Pattern
from stepgen.reference.timer import FASTEST_CYCLES, SLOWEST_CYCLES

ServiceCycle = Callable[[int], int]


@dataclass(frozen=True)
class MotorFacts:
    """
    What the spec decides about a motor.

    Args:
        phases: The coil table, phase 0 first.
        coils_off: The pattern without current.
        minimum_cycles: The smallest virtual value that is accepted, 4 to 65535 * 1024.
        at_rest: Whether the coils stay on when the motor stops.
        motion: Whether its library has update events.
    """

    phases: tuple[Pattern, ...]
    coils_off: Pattern
    minimum_cycles: int
    at_rest: Literal["hold", "release"]
    motion: MotionKind = "constant"

    def __post_init__(self) -> None:
        if not FASTEST_CYCLES <= self.minimum_cycles <= SLOWEST_CYCLES:
            raise ValueError(f"minimum_cycles = {self.minimum_cycles} is out of range")


def served_at_once(deadline_cycle: int) -> int:
    """
    Return the deadline itself: the interrupt is taken without any delay.
    """
    return deadline_cycle

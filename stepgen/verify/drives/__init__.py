"""
What verification knows of each drive, read from the spec once more: one module per kind.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib import import_module

from stepgen.devices import Board, PortBit
from stepgen.reference.pulses import PulseFacts
from stepgen.reference.sequences import Pattern
from stepgen.spec.base import KindModel

Levels = Sequence[bool]
IsBetween = Callable[[Levels, Levels, Levels], bool]


@dataclass(frozen=True)
class DriveFacts:
    """
    The wires of a drive and what they may show.

    Args:
        wires: The port bit of each wire, in the model's order.
        phases: What they show in each phase; forward and backward where DIR says which.
        coils_off: What they show without current.
        is_between: Tells whether wires may show the third pattern on the way from the first to
            the second.
        pulse: What a driver with STEP and DIR asks for; None where the wires are coils.
    """

    wires: tuple[PortBit, ...]
    phases: tuple[Pattern, ...]
    coils_off: Pattern
    is_between: IsBetween
    pulse: PulseFacts | None = None

    def current_level(self, bit: PortBit) -> bool:
        """
        Return the level of the wire *bit*, one that switches coils off, with current.
        """
        return not self.coils_off.driven[self.wires.index(bit)]


def drive_facts(spec: KindModel, board: Board) -> DriveFacts:
    """
    Return what verification knows of the drive *spec* on *board*.
    """
    module = import_module(f"{__name__}.{spec.kind.replace('-', '_')}")
    facts: DriveFacts = module.facts(spec, board)
    return facts


def bits(names: Sequence[str], board: Board) -> tuple[PortBit, ...]:
    """
    Return the port bits of the pins called *names*.
    """
    pins = [board.find_pin(name) for name in names]
    return tuple(pin.bit for pin in pins if pin)

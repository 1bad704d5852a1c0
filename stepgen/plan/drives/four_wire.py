"""
Four wires, one for each coil, in the order in which the coils follow each other.
"""

from collections.abc import Sequence

from stepgen.devices import Board
from stepgen.plan.coils import CoilDrive, Pattern
from stepgen.plan.faults import Faults
from stepgen.plan.pins import missing_pin
from stepgen.plan.wires import Wire
from stepgen.spec.base import KindModel
from stepgen.spec.drives.four_wire import FourWire
from stepgen.spec.sequence import PatternTable

_NAMED = {
    "full": ("1100", "0110", "0011", "1001"),
    "wave": ("1000", "0100", "0010", "0001"),
    "half": ("1000", "1100", "0100", "0110", "0010", "0011", "0001", "1001"),
}


def plan(
    spec: FourWire, _beside: Sequence[KindModel], board: Board, faults: Faults
) -> CoilDrive | None:
    """
    Return the four wires and their phases, or None when a pin is not on *board*.
    """
    wires: list[Wire] = []
    for index, name in enumerate(spec.pins):
        pin = board.find_pin(name)
        if pin is None:
            faults.at("pins", index).report(missing_pin(name, board))
        elif pin in [wire.pin for wire in wires]:
            faults.at("pins", index).report(
                f"{name} is {pin.label} again; give each of the four coils a pin of its own"
            )
        else:
            wires.append(Wire(f"coil {'ABCD'[index]}", pin))
    if len(wires) < len(spec.pins):
        return None
    own = isinstance(spec.sequence, PatternTable)
    table = spec.sequence.patterns if isinstance(spec.sequence, PatternTable) else ()
    return CoilDrive(
        kind=spec.kind,
        title="four switches (ULN2003 and the like)",
        sequence="table" if own else str(spec.sequence),
        wires=tuple(wires),
        phases=tuple(_pattern(text) for text in table or _NAMED[str(spec.sequence)]),
        enables=(),
        quiet=(),
        released=tuple(wires),
    )


def _pattern(text: str) -> Pattern:
    return tuple(character == "1" for character in text)

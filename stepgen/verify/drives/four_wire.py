"""
Four wires, one for each coil.
"""

from stepgen.devices import Board
from stepgen.reference.sequences import coils_off, phases
from stepgen.spec.drives.four_wire import FourWire
from stepgen.spec.sequence import PatternTable
from stepgen.verify.drives import DriveFacts, Levels, bits


def facts(spec: FourWire, board: Board) -> DriveFacts:
    """
    Return its wires and coil table.
    """
    sequence = spec.sequence.patterns if isinstance(spec.sequence, PatternTable) else spec.sequence
    return DriveFacts(
        wires=bits(spec.pins, board),
        phases=phases("four-wire", sequence),
        coils_off=coils_off("four-wire"),
        is_between=is_between,
    )


def is_between(old: Levels, new: Levels, seen: Levels) -> bool:
    """
    Tell whether what is driven is driven in *old*, or all of it in *new*.
    """
    return any(
        all(not now or allowed for now, allowed in zip(seen, pattern, strict=True))
        for pattern in (old, new)
    )

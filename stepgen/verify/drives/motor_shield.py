"""
The motor shield: PWM A and B are enables, DIR A and B the directions of the currents.
"""

from stepgen.devices import Board
from stepgen.reference.sequences import coils_off, phases
from stepgen.spec.drives.motor_shield import MotorShield
from stepgen.verify.drives import DriveFacts, Levels, bits

_ENABLES = ("D3", "D11")
_DIRECTIONS = {False: ("D12", "D13"), True: ("D9", "D8")}  # of one stacked upon another: True


def facts(spec: MotorShield, board: Board) -> DriveFacts:
    """
    Return its wires and coil table.
    """
    return DriveFacts(
        wires=bits((*(spec.enables or _ENABLES), *_DIRECTIONS[spec.stacked]), board),
        phases=phases("motor-shield", spec.sequence),
        coils_off=coils_off("motor-shield"),
        is_between=is_between,
    )


def is_between(old: Levels, new: Levels, seen: Levels) -> bool:
    """
    Tell whether each coil is off, or has the current that it has in *old* or in *new*.
    """
    return all(_coil(seen, coil) in (None, _coil(old, coil), _coil(new, coil)) for coil in (0, 1))


def _coil(levels: Levels, coil: int) -> bool | None:
    """
    Return the direction of the current of *coil*, None without current.
    """
    return levels[2 + coil] if levels[coil] else None

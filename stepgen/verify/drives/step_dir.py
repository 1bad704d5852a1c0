"""
A driver with STEP, DIR and perhaps ENABLE.
"""

from stepgen.devices import SHIELDS, Board
from stepgen.reference.pulses import pulse_facts
from stepgen.spec.drives.step_dir import StepDir
from stepgen.verify.drives import DriveFacts, Levels, bits


def facts(spec: StepDir, board: Board) -> DriveFacts:
    """
    Return its wires and what they show; STEP comes first.
    """
    pulse = pulse_facts(spec, board.f_cpu_hz)
    return DriveFacts(
        wires=bits(_names(spec), board),
        phases=pulse.phases,
        coils_off=pulse.coils_off,
        is_between=is_between,
        pulse=pulse,
    )


def is_between(_old: Levels, new: Levels, seen: Levels) -> bool:
    """
    Tell whether *seen* differs from *new* in nothing but STEP: the pulse.
    """
    return tuple(seen[1:]) == tuple(new[1:])


def _names(spec: StepDir) -> tuple[str, ...]:
    if spec.socket:
        shield, _, place = spec.socket.strip().partition(" ")
        socket = SHIELDS[shield.lower()].sockets[place.strip().upper()]
        return (socket.step, socket.direction, socket.enable)
    enable = (spec.enable.pin,) if spec.enable else ()
    return (str(spec.step), str(spec.dir), *enable)

"""
The Arduino Motor Shield (R3), system 1's drive: an L298 with an enable for each coil.

Source: systems' electrical facts: PWM A and B are the L298's enables, DIR A and B choose the
direction of each coil's current, the brakes stay LOW.
"""

from stepgen.devices import Board
from stepgen.plan.coils import CoilDrive, Pattern, Wire
from stepgen.plan.faults import Faults
from stepgen.spec.drives.motor_shield import MotorShield

_ENABLES = (("PWM A", "D3"), ("PWM B", "D11"))
_DIRECTIONS = (("DIR A", "D12"), ("DIR B", "D13"))
_BRAKES = (("BRAKE A", "D9"), ("BRAKE B", "D8"))

# Current through the coils A and B: forward, backward or none.
_FULL = ("--", "+-", "++", "-+")
_HALF = ("--", "0-", "+-", "+0", "++", "0+", "-+", "-0")
_WAVE = ("0-", "+0", "0+", "-0")
_CURRENTS = {"full": _FULL, "half": _HALF, "wave": _WAVE}


def plan(spec: MotorShield, board: Board, faults: Faults) -> CoilDrive | None:
    """
    Return the shield's wires and phases on *board*.

    In full steps both coils always carry current, so the enables stand still and only the
    two DIR wires step. Half and wave steps switch coils off by their enables.
    """
    enables = _wires(_ENABLES, board, faults)
    directions = _wires(_DIRECTIONS, board, faults)
    quiet = _wires(_BRAKES, board, faults)
    if None in (*enables, *directions, *quiet):
        return None
    switches = spec.sequence != "full"
    currents = _CURRENTS[spec.sequence]
    return CoilDrive(
        kind=spec.kind,
        title="Arduino Motor Shield (L298)",
        sequence=spec.sequence,
        wires=(*_known(enables), *_known(directions)) if switches else _known(directions),
        phases=_switched(currents) if switches else tuple(_signs(pair) for pair in currents),
        enables=() if switches else _known(enables),
        quiet=_known(quiet),
        released=_known(enables),
    )


def _wires(
    signals: tuple[tuple[str, str], ...], board: Board, faults: Faults
) -> tuple[Wire | None, ...]:
    wires = []
    for signal, name in signals:
        pin = board.find_pin(name)
        if pin is None:
            faults.report(f"the {board.title} has no pin {name}, which the shield uses as {signal}")
        wires.append(Wire(signal, pin) if pin else None)
    return tuple(wires)


def _known(wires: tuple[Wire | None, ...]) -> tuple[Wire, ...]:
    return tuple(wire for wire in wires if wire)


def _signs(currents: str) -> Pattern:
    return tuple(current == "+" for current in currents)


def _switched(table: tuple[str, ...]) -> tuple[Pattern, ...]:
    """
    Return enables and signs; a coil that is off already shows the sign it had before.
    """
    phases = []
    for index, currents in enumerate(table):
        before = table[index - 1]
        signs = (now if now != "0" else old for now, old in zip(currents, before, strict=True))
        phases.append((*(current != "0" for current in currents), *_signs("".join(signs))))
    return tuple(phases)

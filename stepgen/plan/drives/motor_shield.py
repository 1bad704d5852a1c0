"""
The Arduino Motor Shield (R3), system 1's drive: an L298 with an enable for each coil.

Source: systems' electrical facts: PWM A and B are the L298's enables, DIR A and B choose the
direction of each coil's current, the brakes stay LOW. A second shield goes on top when its
D12 and D13 are cut and wired to D9 and D8, and the brake jumpers of both are cut.
"""

from collections.abc import Sequence

from stepgen.devices import Board
from stepgen.plan.coils import CoilDrive, Pattern
from stepgen.plan.faults import Faults
from stepgen.plan.pins import missing_pin
from stepgen.plan.wires import Wire
from stepgen.spec.base import KindModel
from stepgen.spec.drives.motor_shield import MotorShield

_ENABLES = ("D3", "D11")
_DIRECTIONS = ("D12", "D13")
_STACKED_DIRECTIONS = ("D9", "D8")
_BRAKES = ("D9", "D8")

# Current through the coils A and B: forward, backward or none.
_FULL = ("--", "+-", "++", "-+")
_HALF = ("--", "0-", "+-", "+0", "++", "0+", "-+", "-0")
_WAVE = ("0-", "+0", "0+", "-0")
_CURRENTS = {"full": _FULL, "half": _HALF, "wave": _WAVE}


def plan(
    spec: MotorShield, beside: Sequence[KindModel], board: Board, faults: Faults
) -> CoilDrive | None:
    """
    Return the shield's wires and phases on *board*.

    In full steps both coils always carry current, so the enables stand still and only the
    two DIR wires step. Half and wave steps switch coils off by their enables, which then must
    not be those of another shield too. Two shields in full steps may share them.
    """
    enables = _wires("PWM", spec.enables or _ENABLES, board, faults.at("enables"))
    directions = _wires("DIR", _STACKED_DIRECTIONS if spec.stacked else _DIRECTIONS, board, faults)
    quiet = _wires("BRAKE", _BRAKES if _has_brakes(spec, beside) else (), board, faults)
    if None in (*enables, *directions, *quiet) or not _differ(enables, directions, faults):
        return None
    switches = spec.sequence != "full"
    shares = _shares_enables(spec, beside)
    if shares and switches:
        faults.report(
            f"{spec.sequence} steps switch the coils by the enables, which two shields share "
            "here; take `sequence: full`, or give the stacked one enables of its own, "
            "`enables: [..]`"
        )
    currents = _CURRENTS[spec.sequence]
    return CoilDrive(
        kind=spec.kind,
        title=f"Arduino Motor Shield (L298){', stacked' if spec.stacked else ''}",
        sequence=spec.sequence,
        wires=(*_known(enables), *_known(directions)) if switches else _known(directions),
        phases=_switched(currents) if switches else tuple(_signs(pair) for pair in currents),
        enables=() if switches else _known(enables),
        quiet=_known(quiet),
        released=_known(enables),
        shared_enables=shares,
        pins_way_out="move the other one, since a shield's pins are fixed (a second shield goes "
        "on top with `stacked: true`)",
    )


def _shields(drives: Sequence[KindModel]) -> tuple[MotorShield, ...]:
    return tuple(drive for drive in drives if isinstance(drive, MotorShield))


def _has_brakes(spec: MotorShield, beside: Sequence[KindModel]) -> bool:
    """
    Tell whether D9 and D8 are brakes: no shield has any where one is stacked upon another.
    """
    return not any(shield.stacked for shield in (spec, *_shields(beside)))


def _shares_enables(spec: MotorShield, beside: Sequence[KindModel]) -> bool:
    """
    Tell whether *spec* is one of two shields, one of them stacked, on the enables D3 and D11.
    """
    return spec.enables is None and any(
        shield.enables is None and shield.stacked != spec.stacked for shield in _shields(beside)
    )


def _wires(
    signal: str, names: tuple[str, ...], board: Board, faults: Faults
) -> tuple[Wire | None, ...]:
    """
    Return the wires of coil A and coil B for *signal*; None after reporting a missing pin.
    """
    wires = []
    for index, name in enumerate(names):
        coil = "AB"[index]
        pin = board.find_pin(name)
        if pin is None:
            faults.at(index).report(f"{signal} {coil}: {missing_pin(name, board)}")
        wires.append(Wire(f"{signal} {coil}", pin) if pin else None)
    return tuple(wires)


def _differ(
    enables: tuple[Wire | None, ...], directions: tuple[Wire | None, ...], faults: Faults
) -> bool:
    """
    Tell whether the enables that the user gave have pins of their own; report which have not.
    """
    wires = _known(directions)
    found = len(faults.found)
    for index, wire in enumerate(_known(enables)):
        other = next((known for known in wires if known.pin == wire.pin), None)
        if other:
            faults.at("enables", index).report(
                f"{wire.pin.label} is {other.signal} of this shield already; take a free pin"
            )
        wires = (*wires, wire)
    return len(faults.found) == found


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

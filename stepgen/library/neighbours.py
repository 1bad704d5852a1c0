"""
What the example beside other libraries does with each of them, and on which pins.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass

from stepgen.devices import Board, Pin
from stepgen.library.rates_view import FRAME_BITS, lowest_baud
from stepgen.library.text import listed
from stepgen.plan.model import Plan
from stepgen.plan.uses import Use, accepted_uses

SERIAL_PINS = frozenset({"Serial RX", "Serial TX"})

_PINS_NEEDED = {"Servo": 1, "tone": 1, "SoftwareSerial": 2}
_SLOWEST_BAUD = 9600
_SPECIAL_USES = ("Serial", "SPI", "I2C", "LED")


@dataclass(frozen=True)
class PinView:
    """
    A pin, as a spec calls it and as a sketch does.
    """

    label: str
    number: str


@dataclass(frozen=True)
class Neighbour:
    """
    Another library of the sketch: its partial in ``templates/others/`` and what that prints.

    *baud* and *byte_us*, the time of a byte, are for SoftwareSerial.
    """

    name: str
    partial: str
    pins: tuple[PinView, ...]
    baud: int
    byte_us: int


def pin_view(pin: Pin) -> PinView:
    """
    Return *pin*; a sketch calls D5 just 5, and A8 A8.
    """
    return PinView(pin.label, pin.label.removeprefix("D"))


def spec_uses(plan: Plan) -> tuple[Use, ...]:
    """
    Return what the spec of *plan* names in ``uses``.
    """
    return accepted_uses(plan.uses, plan.board)


def neighbours(plan: Plan, speed_sps: int) -> tuple[tuple[Neighbour, ...], tuple[str, ...]]:
    """
    Return what the sketch uses beside motors at *speed_sps*, and why some of it is left out.

    Where the spec names no pins, the first ones that nobody has are taken.
    """
    found, reasons = [], []
    baud = lowest_baud(plan, speed_sps, _SLOWEST_BAUD)
    free = _free_pins(plan)
    for use in spec_uses(plan):
        missing = max(0, _PINS_NEEDED.get(use.name, 0) - len(use.pins))
        taken = [pin for pin, _ in zip(free, range(missing), strict=False)]
        if use.name == "millis":
            continue  # every sketch here uses it, and there is nothing to show
        if len(taken) < missing:
            reasons.append(f"{use.name} is left out here: no pin is free for it.")
        elif use.name == "SoftwareSerial" and baud is None:
            reasons.append(
                f"{use.name} is left out: for each byte it has interrupts off, too long here."
            )
        else:
            pins = tuple(pin_view(pin) for pin in (*use.pins, *taken))
            rate = baud or _SLOWEST_BAUD
            time_us = round(FRAME_BITS * 1_000_000 / rate)
            found.append(Neighbour(use.name, _partial(use.name), pins, rate, time_us))
    return tuple(found), tuple(reasons)


def serial_owner(plan: Plan) -> str:
    """
    Return who has a pin of Serial, such as ``motor pan has D1``; empty if both are free.
    """
    pins = ((f"motor {motor.name}", pin) for motor in plan.motors for pin in motor.pins)
    others = (
        (use.name, pin) for use in spec_uses(plan) if use.name != "Serial" for pin in use.pins
    )
    for owner, pin in (*pins, *others):
        if SERIAL_PINS & set(pin.uses):
            return f"{owner} has {pin.label}"
    return ""


def neighbour_names(found: tuple[Neighbour, ...]) -> str:
    """
    Return the names as prose, empty if there is none.
    """
    return listed([neighbour.name for neighbour in found]) if found else ""


def _partial(name: str) -> str:
    """
    Return the partial of a library: ``software_serial`` for SoftwareSerial, ``serial`` for Serial3.
    """
    return re.sub(r"(?<=[a-z])(?=[A-Z])", "_", name.rstrip("0123456789")).lower()


def _free_pins(plan: Plan) -> Iterator[Pin]:
    """
    Yield the pins that nothing has and that are for nothing special, those of port B first.

    SoftwareSerial receives on such pins only; all of port B can on every chip that there is
    (PCINT0 to PCINT7). Ports that belong to a motor are left alone.
    """
    owned = {w.pin.bit.port for m in plan.motors if m.owns_ports for w in m.drive.wires}
    taken = {pin.bit for motor in plan.motors for pin in motor.pins}
    taken |= {pin.bit for use in spec_uses(plan) for pin in use.pins}
    free = [p for p in _plain(plan.board) if p.bit not in taken and p.bit.port not in owned]
    yield from sorted(free, key=lambda pin: (pin.bit.port != "B", pin.number))


def _plain(board: Board) -> Iterator[Pin]:
    for pin in board.pins:
        if not any(use.startswith(_SPECIAL_USES) for use in pin.uses):
            yield pin

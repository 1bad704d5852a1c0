"""
Wires: signals of a drive and the pins that carry them.
"""

from dataclasses import dataclass

from stepgen.devices import Pin


@dataclass(frozen=True)
class Wire:
    """
    One signal of a drive: what it is called there, and the pin that carries it.

    An enable that is *active_low* drives the motor while its pin is LOW.
    """

    signal: str
    pin: Pin
    active_low: bool = False


def bits_by_port(wires: tuple[Wire, ...]) -> dict[str, int]:
    """
    Return the mask of *wires* on each port that they use, by the port's letter.
    """
    masks: dict[str, int] = {}
    for wire in wires:
        bit = wire.pin.bit
        masks[bit.port] = masks.get(bit.port, 0) | 1 << bit.bit
    return dict(sorted(masks.items()))

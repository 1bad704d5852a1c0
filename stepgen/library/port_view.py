"""
The view of bits of ports: masks, registers, and the statements that change them.
"""

from collections.abc import Iterator
from dataclasses import dataclass

from stepgen.devices import Mcu
from stepgen.library.text import hexadecimal
from stepgen.plan.wires import Wire, bits_by_port


@dataclass(frozen=True)
class Bits:
    """
    Bits of one port: its registers, the mask and what hangs on it.
    """

    port: str
    ddr: str
    mask: str
    inverse: str
    comment: str


@dataclass(frozen=True)
class Change:
    """
    A statement that changes bits of one port, and what hangs on them.
    """

    statement: str
    comment: str


def bit_groups(wires: tuple[Wire, ...], mcu: Mcu) -> tuple[Bits, ...]:
    """
    Return *wires* as one group of bits for each port.
    """
    groups = []
    for letter, mask in bits_by_port(wires).items():
        port = mcu.port(letter)
        here = [wire for wire in wires if wire.pin.bit.port == letter]
        signals = ", ".join(wire.signal for wire in here)
        groups.append(
            Bits(
                port=port.port.name,
                ddr=port.ddr.name,
                mask=hexadecimal(mask),
                inverse=hexadecimal(~mask & 0xFF),
                comment=f"  // {signals}",
            )
        )
    return tuple(groups)


def switched(wires: tuple[Wire, ...], mcu: Mcu, *, active: bool) -> tuple[Change, ...]:
    """
    Return what makes *wires* active or inactive: HIGH or LOW, the other way where they say so.
    """

    def changes() -> Iterator[Change]:
        for is_high in (False, True):
            there = tuple(wire for wire in wires if (active != wire.active_low) == is_high)
            for group in bit_groups(there, mcu):
                operation = f"|= {group.mask}" if is_high else f"&= {group.inverse}"
                yield Change(f"{group.port} {operation};", group.comment)

    return tuple(changes())

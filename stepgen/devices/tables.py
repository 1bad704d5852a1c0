"""
Short ways to write a datasheet's tables down, so that a person can check them at a glance.
"""

import re
from collections.abc import Mapping, Sequence

from stepgen.devices.model import Pin, Port, PortBit, Register, Timer8, Timer16, Vector

_PORT_BIT = re.compile(r"P([A-L])([0-7])")


def port_bit(name: str) -> PortBit:
    """
    Return the port bit that a datasheet calls *name*, such as ``PB4``.

    Raises:
        ValueError: *name* is no port bit.
    """
    match = _PORT_BIT.fullmatch(name)
    if match is None:
        raise ValueError(f"{name} is no port bit")
    return PortBit(match[1], int(match[2]))


def port(letter: str, pin_address: int, bits: Sequence[int]) -> Port:
    """
    Return a port whose PIN, DDR and PORT follow each other from *pin_address* (data space).
    """
    pin, ddr, output = (
        Register(f"{kind}{letter}", pin_address + offset)
        for offset, kind in enumerate(("PIN", "DDR", "PORT"))
    )
    return Port(letter, pin, ddr, output, tuple(bits))


def vectors(names: str) -> tuple[Vector, ...]:
    """
    Return the vectors 1, 2, 3 ... from *names*, separated by blanks, without ``_vect``.

    A "-" is a reserved one, which is left out.
    """
    return tuple(
        Vector(f"{name}_vect", number)
        for number, name in enumerate(names.split(), 1)
        if name != "-"
    )


def timer16(
    number: int,
    base: int,
    table: Sequence[Vector],
    outputs: Mapping[str, str],
    capture_input: str,
) -> Timer16:
    """
    Return a 16-bit timer, whose registers lie alike on every classic ATmega.

    From *base* on: TCCRnA, B, C, a gap, TCNTn, ICRn, OCRnA, OCRnB and, where *table* has a
    vector of channel C, OCRnC, two bytes each; TIMSKn is 0x6E + n and TIFRn 0x35 + n.

    Args:
        number: The n of TCCRnA.
        base: Data-space address of TCCRnA.
        table: The chip's vectors.
        outputs: Pin of each compare channel that has one, such as ``{"A": "PB1"}``.
        capture_input: Pin ICPn.
    """
    by_name = {vector.name: vector for vector in table}
    compc = by_name.get(f"TIMER{number}_COMPC_vect")
    return Timer16(
        number=number,
        tccra=Register(f"TCCR{number}A", base),
        tccrb=Register(f"TCCR{number}B", base + 1),
        tccrc=Register(f"TCCR{number}C", base + 2),
        tcnt=Register(f"TCNT{number}", base + 4),
        icr=Register(f"ICR{number}", base + 6),
        ocra=Register(f"OCR{number}A", base + 8),
        ocrb=Register(f"OCR{number}B", base + 10),
        ocrc=Register(f"OCR{number}C", base + 12) if compc else None,
        timsk=Register(f"TIMSK{number}", 0x6E + number),
        tifr=Register(f"TIFR{number}", 0x35 + number),
        capt=by_name[f"TIMER{number}_CAPT_vect"],
        compa=by_name[f"TIMER{number}_COMPA_vect"],
        compb=by_name[f"TIMER{number}_COMPB_vect"],
        compc=compc,
        ovf=by_name[f"TIMER{number}_OVF_vect"],
        outputs=tuple((channel, port_bit(name)) for channel, name in outputs.items()),
        capture_input=port_bit(capture_input),
    )


def timer2(table: Sequence[Vector], outputs: Mapping[str, str]) -> Timer8:
    """
    Return timer 2, whose registers lie alike on every classic ATmega.

    Args:
        table: The chip's vectors.
        outputs: Pin of each compare channel, such as ``{"A": "PB3", "B": "PD3"}``.
    """
    by_name = {vector.name: vector for vector in table}
    return Timer8(
        number=2,
        tccra=Register("TCCR2A", 0xB0),
        tccrb=Register("TCCR2B", 0xB1),
        tcnt=Register("TCNT2", 0xB2),
        ocra=Register("OCR2A", 0xB3),
        ocrb=Register("OCR2B", 0xB4),
        timsk=Register("TIMSK2", 0x70),
        tifr=Register("TIFR2", 0x37),
        compa=by_name["TIMER2_COMPA_vect"],
        compb=by_name["TIMER2_COMPB_vect"],
        ovf=by_name["TIMER2_OVF_vect"],
        outputs=tuple((channel, port_bit(name)) for channel, name in outputs.items()),
    )


def header_pins(table: str) -> tuple[Pin, ...]:
    """
    Return the pins 0, 1, 2 ... from *table*: a line ``label bit uses`` each.

    Uses are separated by commas: ``D11 PB3 SPI MOSI, PWM OC2A``. A label may have a second one
    behind a slash: ``D4/A6``.
    """
    rows = (line.split(maxsplit=2) for line in table.strip().splitlines())
    return tuple(_header_pin(number, *row) for number, row in enumerate(rows))


def _header_pin(number: int, labels: str, bit: str, *uses: str) -> Pin:
    label, *others = labels.split("/")
    return Pin(label, number, port_bit(bit), _uses(uses), tuple(others))


def _uses(column: Sequence[str]) -> tuple[str, ...]:
    return tuple(use.strip() for text in column for use in text.split(","))

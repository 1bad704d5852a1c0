"""
Chips: every fact agrees with avr-libc, the Arduino core or, for a few, the datasheet.
"""

import re
from dataclasses import fields

import pytest

from stepgen.devices import Board, Mcu, PortBit, Register, Timer, Vector

# Where the datasheets' chapters "Alternate Port Functions" put ICPn.
CAPTURE_INPUTS = {
    "atmega328p": {1: "PB0"},
    "atmega32u4": {1: "PD4", 3: "PC7"},
    "atmega1280": {1: "PD4", 3: "PE7", 4: "PL0", 5: "PL1"},
    "atmega2560": {1: "PD4", 3: "PE7", 4: "PL0", 5: "PL1"},
}
# Compare outputs that analogWrite() does not use, from the same chapters: the core gives the
# PB7 of the Mega and of the ATmega32U4 to OC0A.
OTHER_OUTPUTS: dict[str, set[tuple[int, str, str]]] = {
    "atmega328p": set(),
    "atmega32u4": {(1, "C", "PB7")},
    "atmega1280": {(1, "C", "PB7")},
    "atmega2560": {(1, "C", "PB7")},
}


def registers_of(timer: Timer) -> list[Register]:
    """
    Return all registers of *timer*.
    """
    values = [getattr(timer, field.name) for field in fields(timer)]
    return [value for value in values if isinstance(value, Register)]


def test_registers_stand_where_avr_libc_has_them(mcu: Mcu, libc_registers: dict[str, int]) -> None:
    """
    Every register has avr-libc's name and address; 16-bit ones that of their low byte.
    """
    registers = [*mcu.gpiors, mcu.sreg, mcu.clkpr]
    registers += [register for port in mcu.ports for register in (port.pin, port.ddr, port.port)]
    registers += [register for timer in mcu.timers for register in registers_of(timer)]

    assert {register.name: register.address for register in registers}.items() <= (
        libc_registers.items()
    )
    assert [register.name for register in mcu.gpiors] == ["GPIOR0", "GPIOR1", "GPIOR2"]
    assert (mcu.sreg.name, mcu.clkpr.name) == ("SREG", "CLKPR")


def test_all_ports_and_their_bits_are_listed(
    mcu: Mcu, libc_registers: dict[str, int], libc_numbers: dict[str, int]
) -> None:
    """
    The ports are those with a PORTx in avr-libc, and their bits those with a PORTxn or Pxn.
    """
    letters = sorted(name[4] for name in libc_registers if re.fullmatch(r"PORT[A-Z]", name))
    found = [re.fullmatch(r"P(?:ORT)?([A-L][0-7])", name) for name in libc_numbers]
    bits = sorted({f"P{match[1]}" for match in found if match})

    assert [port.letter for port in mcu.ports] == letters
    assert [PortBit(port.letter, bit).name for port in mcu.ports for bit in port.bits] == bits
    for port in mcu.ports:
        names = (port.pin.name, port.ddr.name, port.port.name)
        assert names == tuple(f"{kind}{port.letter}" for kind in ("PIN", "DDR", "PORT"))


def test_all_vectors_are_listed_with_their_numbers(mcu: Mcu, libc_vectors: dict[str, int]) -> None:
    """
    The vectors are exactly avr-libc's, in the order of their numbers.
    """
    assert {vector.name: vector.number for vector in mcu.vectors} == libc_vectors
    assert [vector.number for vector in mcu.vectors] == sorted(libc_vectors.values())


def test_all_16_bit_timers_are_listed(mcu: Mcu, libc_registers: dict[str, int]) -> None:
    """
    The 16-bit timers are those with an input capture register in avr-libc.
    """
    numbers = sorted(int(name[3]) for name in libc_registers if re.fullmatch(r"ICR\dH", name))

    assert [timer.number for timer in mcu.timers16] == numbers


def test_each_timer_has_its_own_registers_and_vectors(
    mcu: Mcu, libc_registers: dict[str, int], libc_vectors: dict[str, int]
) -> None:
    """
    Each field of a timer holds the register or vector of that name, and C only where it exists.
    """
    for timer in mcu.timers16:
        n = timer.number
        for field in ("tccra", "tccrb", "tccrc", "tcnt", "icr", "ocra", "ocrb", "ocrc"):
            name = re.sub(r"^(tccr|tcnt|icr|ocr)", rf"\g<1>{n}", field).upper()
            register = getattr(timer, field)
            assert (register and register.name) == (name if name in libc_registers else None)
        for field in ("capt", "compa", "compb", "compc", "ovf"):
            name = f"TIMER{n}_{field.upper()}_vect"
            vector = getattr(timer, field)
            assert (vector and vector.name) == (name if name in libc_vectors else None)
            assert vector is None or vector == mcu.vector(name)
        assert (timer.timsk.name, timer.tifr.name) == (f"TIMSK{n}", f"TIFR{n}")


def test_the_only_8_bit_timer_beside_the_cores_is_timer_2(
    mcu: Mcu, libc_registers: dict[str, int], libc_vectors: dict[str, int]
) -> None:
    """
    Timers without a high byte are 0, which counts milliseconds, and perhaps 2: all by their names.

    A timer is there if it has vectors: avr-libc gives the ATmega32U4 registers of a timer 2.
    """
    found = (re.fullmatch(r"TIMER(\d)_OVF_vect", name) for name in libc_vectors)
    numbers = {int(match[1]) for match in found if match}
    small = {number for number in numbers if f"TCNT{number}H" not in libc_registers}

    assert {timer.number for timer in mcu.timers8} == small - {0}
    assert small <= {0, 2}
    for timer in mcu.timers8:
        names = {field.name: getattr(timer, field.name) for field in fields(timer)}
        for field, value in names.items():
            if isinstance(value, Register):
                wanted = re.sub(r"^(tccr|tcnt|ocr|timsk|tifr)", r"\g<1>2", field).upper()
                assert value.name == wanted
            if isinstance(value, Vector):
                assert value.name == f"TIMER2_{field.upper()}_vect"
                assert value.number == libc_vectors[value.name]
    assert {mcu.timer8(2), mcu.timer8(0), mcu.timer8(1)} == {*mcu.timers8, None}


def test_timer_pins_are_those_of_the_core_and_the_datasheet(
    board: Board, pin_tables: dict[str, bytes], core_numbers: dict[str, int]
) -> None:
    """
    Compare outputs are those that analogWrite() uses, and the datasheet's others.
    """
    channels = {
        number: name[5:]
        for name, number in core_numbers.items()
        if re.match(r"TIMER\d[A-D]$", name)
    }
    used = {
        (int(channels[code][0]), channels[code][1], board.pins[number].bit.name)
        for number, code in enumerate(pin_tables["digital_pin_to_timer_PGM"])
        if code and int(channels[code][0]) in {timer.number for timer in board.mcu.timers}
    }
    outputs = {
        (timer.number, channel, bit.name)
        for timer in board.mcu.timers
        for channel, bit in timer.outputs
    }
    captures = {t.number: t.capture_input and t.capture_input.name for t in board.mcu.timers16}

    assert outputs == used | OTHER_OUTPUTS[board.mcu.name]
    assert captures == CAPTURE_INPUTS[board.mcu.name]


def test_chip_sizes_and_response_are_the_compilers(
    mcu: Mcu, libc_macros: dict[str, str], libc_numbers: dict[str, int]
) -> None:
    """
    Flash and RAM are avr-libc's; a program counter of three bytes answers a cycle later.
    """
    assert mcu.flash_bytes == libc_numbers["FLASHEND"] + 1
    assert mcu.ram_start == libc_numbers["RAMSTART"]
    end = libc_numbers.get("RAMEND")  # that of the ATmega32U4 is RAMSTART + RAMSIZE - 1
    assert mcu.ram_bytes == (end + 1 - mcu.ram_start if end else libc_numbers["RAMSIZE"])
    assert mcu.response_cycles == (5 if "__AVR_3_BYTE_PC__" in libc_macros else 4)
    assert mcu.macro in libc_macros
    assert mcu.macro == f"__AVR_{mcu.title}__"
    assert mcu.title.lower() == mcu.name


def test_registers_know_which_instructions_reach_them(mega: Board) -> None:
    """
    SBI reaches data addresses below 0x40, OUT those below 0x60, and STS the rest.
    """
    port_b, gpior1, port_h = (
        Register("PORTB", 0x25),
        Register("GPIOR1", 0x4A),
        mega.mcu.port("H"),
    )

    assert (port_b.io_address, port_b.in_io, port_b.bit_addressable) == (0x05, True, True)
    assert (gpior1.io_address, gpior1.in_io, gpior1.bit_addressable) == (0x2A, True, False)
    assert (port_h.port.in_io, port_h.port.bit_addressable) == (False, False)
    with pytest.raises(ValueError, match="PORTH at 0x102 has no I/O address"):
        _ = port_h.port.io_address


def test_what_a_chip_lacks_is_said(uno: Board) -> None:
    """
    An unknown port or vector is an error that names it; an 8-bit timer is no 16-bit timer.
    """
    with pytest.raises(KeyError, match="ATmega328P has no port A"):
        uno.mcu.port("A")
    with pytest.raises(KeyError, match="ATmega328P has no TIMER5_OVF_vect"):
        uno.mcu.vector("TIMER5_OVF_vect")
    assert uno.mcu.timer16(2) is None

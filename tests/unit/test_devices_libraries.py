"""
Other libraries of a sketch: what they take agrees with their object files.
"""

from collections.abc import Callable

import pytest

from stepgen.devices import SKETCH_LIBRARIES, Board, library_claims

# On a chip with USB, Serial is that.
USB_SOURCE = "cores/arduino/USBCore.cpp"
SERIAL_SOURCES = {
    "Serial": "cores/arduino/HardwareSerial0.cpp",
    "Serial1": "cores/arduino/HardwareSerial1.cpp",
    "Serial2": "cores/arduino/HardwareSerial2.cpp",
    "Serial3": "cores/arduino/HardwareSerial3.cpp",
}
LIBRARY_SOURCES = {
    "millis": "cores/arduino/wiring.c",
    "tone": "cores/arduino/Tone.cpp",
    "SPI": "libraries/SPI/src/SPI.cpp",
    "SoftwareSerial": "libraries/SoftwareSerial/src/SoftwareSerial.cpp",
    "Wire": "libraries/Wire/src/utility/twi.c",
    **SERIAL_SOURCES,
}


@pytest.mark.parametrize("name", LIBRARY_SOURCES)
def test_libraries_take_the_vectors_they_define(
    name: str, board: Board, vectors_defined_by: Callable[[str], set[int]]
) -> None:
    """
    The vectors of a library are those in its object file; where there are none, it is absent.
    """
    source = USB_SOURCE if board.mcu.has_usb and name == "Serial" else LIBRARY_SOURCES[name]
    defined = vectors_defined_by(source)
    claims = library_claims(name, board)

    if name in SERIAL_SOURCES and not defined:
        assert claims is None
    else:
        assert claims is not None
        assert {vector.number for vector in claims.vectors} == defined
        assert {f"TIMER{timer}" for timer in claims.timers} == {
            vector.name.split("_")[0] for vector in claims.vectors if "TIMER" in vector.name
        }


def test_libraries_take_the_pins_meant_for_them(board: Board) -> None:
    """
    Serial, SPI and Wire take the pins that the board marks as theirs; others take none.
    """
    kinds = {"SPI": "SPI", "Wire": "I2C"} | {name: name for name in SERIAL_SOURCES}
    for name in SKETCH_LIBRARIES:
        claims = library_claims(name, board)
        kind = kinds.get(name, "none")
        marked = {pin.bit for pin in board.pins for use in pin.uses if use.split()[0] == kind}
        assert claims is None or set(claims.pins) == marked


# The timers of each chip in the order of ServoTimers.h of arduino-libraries/Servo.
SERVO_TIMERS = {
    "atmega328p": (1,),
    "atmega32u4": (1,),
    "atmega1280": (5, 1, 3, 4),
    "atmega2560": (5, 1, 3, 4),
}


def test_servo_takes_timers_as_servos_are_attached(board: Board) -> None:
    """
    Servo takes timer 1 of the Uno; of the Mega 5, 1, 3, 4, with all four COMPA vectors.

    A timer is for 12 servos: SERVOS_PER_TIMER of Servo.h.
    """
    claims = library_claims("Servo", board)

    assert claims is not None
    assert claims.timers == SERVO_TIMERS[board.mcu.name]
    assert {vector.name for vector in claims.vectors} == {
        f"TIMER{timer}_COMPA_vect" for timer in claims.timers
    }
    assert claims.objects_per_timer == 12


def test_an_unknown_library_has_no_claims(uno: Board) -> None:
    """
    A name outside the table has no claims, and names are matched exactly.
    """
    assert library_claims("FastLED", uno) is None
    assert library_claims("servo", uno) is None

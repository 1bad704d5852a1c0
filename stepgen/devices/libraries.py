"""
What other libraries of a sketch take: timers, vectors and pins, board by board.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType

from stepgen.devices.model import Board, Mcu, PortBit, Vector

_SERVOS_PER_TIMER = 12


@dataclass(frozen=True)
class LibraryClaims:
    """
    What a library takes on one board.

    Args:
        name: What a spec's ``uses`` calls it.
        timers: Numbers of the timers it takes, in the order in which it takes them.
        vectors: The vectors it defines; all of them are taken as soon as it is linked.
        pins: The port bits it takes.
        objects_per_timer: None where all timers are taken at once. Otherwise the first timer
            goes with the first object, the next with each further *objects_per_timer*: 12
            servos take only the first of the Servo library's timers.
    """

    name: str
    timers: tuple[int, ...]
    vectors: tuple[Vector, ...]
    pins: tuple[PortBit, ...]
    objects_per_timer: int | None = None


@dataclass(frozen=True)
class SketchLibrary:
    """
    A library's needs, for any board.

    Args:
        timers: Numbers of the timers it takes.
        timer_event: The vector it takes of each timer: ``COMPA``, ``OVF``, or "" for none.
        vectors: Pattern of the other vectors it defines, or "" for none.
        pin_uses: The uses of a board's pins that are for it.
        objects_per_timer: As in `LibraryClaims`.
        of_mcu: The needs on the chips where they are different.
    """

    timers: tuple[int, ...] = ()
    timer_event: str = ""
    vectors: str = ""
    pin_uses: tuple[str, ...] = ()
    objects_per_timer: int | None = None
    of_mcu: "Mapping[str, SketchLibrary]" = field(default_factory=dict)


def _usart(port_name: str, digit: str) -> SketchLibrary:
    return SketchLibrary(
        vectors=rf"USART{digit}_(RX|UDRE)_vect",
        pin_uses=(f"{port_name} RX", f"{port_name} TX"),
    )


_SERVO = SketchLibrary(timers=(1,), timer_event="COMPA", objects_per_timer=_SERVOS_PER_TIMER)
_SERVO_OF_MEGAS = replace(_SERVO, timers=(5, 1, 3, 4))
_TONE = SketchLibrary(timers=(2,), timer_event="COMPA")  # and any pin
_USB = SketchLibrary(vectors="USB_(GEN|COM)_vect")  # the chip's own USB, which has no other pins


def _on(library: SketchLibrary, *mcus: str) -> Mapping[str, SketchLibrary]:
    return MappingProxyType(dict.fromkeys(mcus, library))


# Names that a sketch may list in `uses`. Sources: the Arduino AVR core 1.8 and, for Servo,
# ServoTimers.h and Servo.cpp of arduino-libraries/Servo (src/avr).
SKETCH_LIBRARIES: Mapping[str, SketchLibrary] = MappingProxyType(
    {
        "millis": SketchLibrary(timers=(0,), timer_event="OVF"),
        # A chip with one USART does not number it, or has it for Serial1.
        "Serial": replace(_usart("Serial", "0?"), of_mcu=_on(_USB, "atmega32u4")),
        "Serial1": _usart("Serial1", "1"),
        "Serial2": _usart("Serial2", "2"),
        "Serial3": _usart("Serial3", "3"),
        "Servo": replace(_SERVO, of_mcu=_on(_SERVO_OF_MEGAS, "atmega1280", "atmega2560")),
        "SoftwareSerial": SketchLibrary(vectors=r"PCINT\d_vect"),  # and any pins
        "SPI": SketchLibrary(pin_uses=("SPI SS", "SPI MOSI", "SPI MISO", "SPI SCK")),
        "tone": replace(_TONE, of_mcu=_on(replace(_TONE, timers=(3,)), "atmega32u4")),
        "Wire": SketchLibrary(vectors="TWI_vect", pin_uses=("I2C SDA", "I2C SCL")),
    }
)


def library_claims(name: str, board: Board) -> LibraryClaims | None:
    """
    Return what the library *name* takes on *board*.

    None where the name is not in `SKETCH_LIBRARIES`, or the board lacks what the library
    needs: there is no Serial1 on the Uno.
    """
    usual = SKETCH_LIBRARIES.get(name)
    if usual is None:
        return None
    library = usual.of_mcu.get(board.mcu.name, usual)
    timers = library.timers
    vectors = _vectors(library, board.mcu)
    pins = tuple(pin.bit for pin in board.pins if set(pin.uses) & set(library.pin_uses))
    wanted_events = len(timers) if library.timer_event else 0
    is_complete = len(pins) == len(library.pin_uses) and len(vectors) >= (
        wanted_events + bool(library.vectors)
    )
    if not is_complete:
        return None
    return LibraryClaims(name, timers, vectors, pins, library.objects_per_timer)


def _vectors(library: SketchLibrary, mcu: Mcu) -> tuple[Vector, ...]:
    """
    Return those vectors of *mcu* that *library* defines.
    """
    events = {f"TIMER{number}_{library.timer_event}_vect" for number in library.timers}
    return tuple(
        vector
        for vector in mcu.vectors
        if vector.name in events or re.fullmatch(library.vectors, vector.name)
    )

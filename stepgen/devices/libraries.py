"""
What other libraries of a sketch take: timers, vectors and pins, board by board.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
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
        timers: Numbers of the timers it takes on most chips.
        timers_of_mcu: The same for the chips where it is different.
        timer_event: The vector it takes of each timer: ``COMPA``, ``OVF``, or "" for none.
        vectors: Pattern of the other vectors it defines, or "" for none.
        pin_uses: The uses of a board's pins that are for it.
        objects_per_timer: As in `LibraryClaims`.
    """

    timers: tuple[int, ...] = ()
    timers_of_mcu: Mapping[str, tuple[int, ...]] = field(default_factory=dict)
    timer_event: str = ""
    vectors: str = ""
    pin_uses: tuple[str, ...] = ()
    objects_per_timer: int | None = None


def _usart(port_name: str, digit: str) -> SketchLibrary:
    return SketchLibrary(
        vectors=rf"USART{digit}_(RX|UDRE)_vect",
        pin_uses=(f"{port_name} RX", f"{port_name} TX"),
    )


# Names that a sketch may list in `uses`. Sources: the Arduino AVR core 1.8 and, for Servo,
# ServoTimers.h and Servo.cpp of arduino-libraries/Servo (src/avr).
SKETCH_LIBRARIES: Mapping[str, SketchLibrary] = MappingProxyType(
    {
        "millis": SketchLibrary(timers=(0,), timer_event="OVF"),
        "Serial": _usart("Serial", "0?"),  # a chip with one USART does not number it
        "Serial1": _usart("Serial1", "1"),
        "Serial2": _usart("Serial2", "2"),
        "Serial3": _usart("Serial3", "3"),
        "Servo": SketchLibrary(
            timers=(1,),
            timers_of_mcu=MappingProxyType(
                dict.fromkeys(("atmega1280", "atmega2560"), (5, 1, 3, 4))
            ),
            timer_event="COMPA",
            objects_per_timer=_SERVOS_PER_TIMER,
        ),
        "SoftwareSerial": SketchLibrary(vectors=r"PCINT\d_vect"),  # and any pins
        "SPI": SketchLibrary(pin_uses=("SPI SS", "SPI MOSI", "SPI MISO", "SPI SCK")),
        "tone": SketchLibrary(timers=(2,), timer_event="COMPA"),  # and any pin
        "Wire": SketchLibrary(vectors="TWI_vect", pin_uses=("I2C SDA", "I2C SCL")),
    }
)


def library_claims(name: str, board: Board) -> LibraryClaims | None:
    """
    Return what the library *name* takes on *board*.

    None where the name is not in `SKETCH_LIBRARIES`, or the board lacks what the library
    needs: there is no Serial1 on the Uno.
    """
    library = SKETCH_LIBRARIES.get(name)
    if library is None:
        return None
    timers = library.timers_of_mcu.get(board.mcu.name, library.timers)
    vectors = _vectors(library, timers, board.mcu)
    pins = tuple(pin.bit for pin in board.pins if set(pin.uses) & set(library.pin_uses))
    wanted_events = len(timers) if library.timer_event else 0
    is_complete = len(pins) == len(library.pin_uses) and len(vectors) >= (
        wanted_events + bool(library.vectors)
    )
    if not is_complete:
        return None
    return LibraryClaims(name, timers, vectors, pins, library.objects_per_timer)


def _vectors(library: SketchLibrary, timers: tuple[int, ...], mcu: Mcu) -> tuple[Vector, ...]:
    """
    Return those vectors of *mcu* that *library* defines when it takes *timers*.
    """
    events = {f"TIMER{number}_{library.timer_event}_vect" for number in timers}
    return tuple(
        vector
        for vector in mcu.vectors
        if vector.name in events or re.fullmatch(library.vectors, vector.name)
    )

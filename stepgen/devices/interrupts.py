"""
The interrupts of other libraries of a sketch: how long each takes at most, and how often it comes.

What a test compiles and bounds (tests/compile/test_library_interrupts.py) is proven; of the rest
*basis* says where the figure comes from.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from stepgen.devices.model import Mcu

_MILLIS_SPACING_CYCLES = 64 * 256  # timer 0: prescaler 64, 256 ticks

# A frame at 115200 baud lasts 10 bits. The core makes a bit of 136 clocks at 16 MHz, of 72 at 8,
# and a sender's stop bit may be cut short by up to half a bit: 9.5 bits are 80.75 and 85.5 us.
_SERIAL_SPACING_US = 80
# A frame of USB lasts 1 ms, give or take 500 ns (USB 2.0, 7.1.12); the chip's clock is a crystal.
_USB_FRAME_US = 999
_SERVO_PULSE_US = 544  # MIN_PULSE_WIDTH
_TONE_SPACING_US = 100  # 5 kHz: two interrupts a period
_SERVO_BASIS = (
    "estimated from a reduced copy of the interrupt of Servo 1.2, and a tenth more; Servo comes "
    "with no package, so no test repeats it"
)
_JUMP_TABLE_BASIS = "estimated from the ATmega328P's: digitalWrite() has a jump table more there"


@dataclass(frozen=True)
class LibraryInterrupt:
    """
    An interrupt of a library.

    Args:
        cause: What a report calls it.
        vector: Pattern of its vectors, in which ``{timer}`` stands for each timer it takes.
        cycles: The most it takes, response through RETI, on most chips.
        cycles_of_mcu: The same for the chips where it is another.
        spacing_us: Shortest time between two, in microseconds; 0 if *spacing_cycles* says it.
        spacing_cycles: The same in CPU cycles.
        at_once: How many can follow each other without that time between.
        apart_up_to: How many objects of the library on a timer keep that time nevertheless.
        waiting: How many can be waiting after a long time with interrupts off.
        basis: Where the figure comes from if no test proves it, and on which chips: () for all.
    """

    cause: str
    vector: str
    cycles: int
    cycles_of_mcu: Mapping[str, int] = field(default_factory=dict)
    spacing_us: int = 0
    spacing_cycles: int = 0
    at_once: int = 1
    apart_up_to: int = 0
    waiting: int = 1
    basis: str = ""
    unproven_on: tuple[str, ...] = ()

    def cycles_on(self, mcu: Mcu) -> int:
        """
        Return the most that it takes on *mcu*.
        """
        return self.cycles_of_mcu.get(mcu.name, self.cycles)

    def is_proven_on(self, mcu: Mcu) -> bool:
        """
        Tell whether a test proves the figure for *mcu*.
        """
        return not self.basis or bool(self.unproven_on and mcu.name not in self.unproven_on)

    def spacing_on(self, f_cpu_hz: int) -> int:
        """
        Return the shortest time between two in CPU cycles.
        """
        return self.spacing_cycles or self.spacing_us * f_cpu_hz // 1_000_000


@dataclass(frozen=True)
class UnboundInterrupt:
    """
    An interrupt, or a stretch with interrupts off, of a library for which there is no bound.

    Args:
        why: What makes it so, in words that follow the library's name.
        assumed: What *microseconds* assumes.
        vector: The vector that it is about; a chip without it has no such thing.
        microseconds: How long it has other interrupts wait then, beside *cycles*.
        cycles: What of it depends on the clock.
    """

    why: str
    assumed: str
    vector: str
    microseconds: int
    cycles: int


_MEGAS = ("atmega1280", "atmega2560")


def _on_megas(cycles: int) -> Mapping[str, int]:
    return MappingProxyType(dict.fromkeys(_MEGAS, cycles))


def _serial(name: str, digit: str) -> tuple[LibraryInterrupt, ...]:
    # The receiver holds two bytes and shifts in a third; the transmitter one, and one in its
    # buffer, which is free again at once where the other was.
    return (
        LibraryInterrupt(
            f"{name}, a byte received at 115200 baud",
            rf"USART{digit}_RX_vect",
            cycles=80,
            cycles_of_mcu=_on_megas(90),
            spacing_us=_SERIAL_SPACING_US,
            waiting=3,
        ),
        LibraryInterrupt(
            f"{name}, a byte sent at 115200 baud",
            rf"USART{digit}_UDRE_vect",
            cycles=140,
            cycles_of_mcu=_on_megas(145),
            spacing_us=_SERIAL_SPACING_US,
            at_once=2,
            waiting=2,
        ),
    )


# Verification proves its cycles for each program.
MILLIS = LibraryInterrupt(
    "the millis interrupt",
    "TIMER0_OVF_vect",
    cycles=110,
    spacing_cycles=_MILLIS_SPACING_CYCLES,
)

# On a chip with USB the core always has it on, whether the sketch uses Serial or not. It is plugged
# in or not: without a computer no frame begins.
USB_FRAME = LibraryInterrupt(
    "the USB interrupt of a frame",
    "USB_GEN_vect",
    cycles=140,
    spacing_us=_USB_FRAME_US,
)

CORE: Mapping[str, LibraryInterrupt] = MappingProxyType({"millis": MILLIS, "USB": USB_FRAME})
"""What the core has beside every sketch, on the chips that have these vectors."""

# What a spec's `uses` calls it -> its interrupts; what is not here has none. Sources: the Arduino
# AVR core 1.8 and, for Servo, arduino-libraries/Servo (src/avr).
INTERRUPTS: Mapping[str, tuple[LibraryInterrupt, ...]] = MappingProxyType(
    {
        "Serial": _serial("Serial", "0?"),
        "Serial1": _serial("Serial1", "1"),
        "Serial2": _serial("Serial2", "2"),
        "Serial3": _serial("Serial3", "3"),
        # Each pulse ends with one; where the refresh interval is over by then, the next follows it.
        "Servo": (
            LibraryInterrupt(
                "Servo, a pulse begun or ended",
                "TIMER{timer}_COMPA_vect",
                cycles=400,
                cycles_of_mcu=_on_megas(540),
                spacing_us=_SERVO_PULSE_US,
                at_once=2,
                apart_up_to=8,  # 8 pulses of 2400 us at most leave 800 of the 20 000
                basis=_SERVO_BASIS,
            ),
        ),
        "tone": (
            LibraryInterrupt(
                "tone() of up to 5 kHz",
                "TIMER{timer}_COMPA_vect",
                cycles=210,
                cycles_of_mcu=MappingProxyType({**_on_megas(300), "atmega32u4": 115}),
                spacing_us=_TONE_SPACING_US,
                basis=_JUMP_TABLE_BASIS,
                unproven_on=_MEGAS,
            ),
        ),
    }
)

# What a spec's `uses` calls it, or USB, which the core has on wherever the chip has it.
UNBOUND: Mapping[str, UnboundInterrupt] = MappingProxyType(
    {
        "USB": UnboundInterrupt(
            "waits in its interrupt for the computer while the board is plugged in and while a "
            "program there opens or closes the port",
            "1 ms, a frame",
            "USB_COM_vect",
            microseconds=1000,
            cycles=1000,
        ),
        "Serial": UnboundInterrupt(
            "keeps interrupts off while it copies what it sends over USB",
            "64 bytes at once, as many as there is room for",
            "USB_COM_vect",
            microseconds=0,
            # Counted in what both compilers make of USB_Send(): 8 a byte.
            cycles=64 * 8 + 40,
        ),
        "SoftwareSerial": UnboundInterrupt(
            "keeps interrupts off while it receives or sends a byte",
            "ten bit times at 9600 baud",
            "PCINT0_vect",
            microseconds=1042,
            cycles=150,
        ),
        "Wire": UnboundInterrupt(
            "waits in its interrupt for the bus, and calls there what onReceive() and onRequest() "
            "were given",
            "40 us, as a master on a bus of 100 kHz",
            "TWI_vect",
            microseconds=40,
            cycles=0,
        ),
    }
)

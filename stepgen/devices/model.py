"""
The types of the device layer: facts that datasheets and board drawings state.
"""

from dataclasses import dataclass
from typing import ClassVar

_IO_START = 0x20
_IO_END = 0x60
_BIT_ADDRESSABLE_END = 0x40


@dataclass(frozen=True, order=True)
class PortBit:
    """
    One bit, 0 to 7, of a port, named by an upper-case letter: ``PortBit("B", 4)`` is PB4.
    """

    port: str
    bit: int

    @property
    def name(self) -> str:
        """
        Return the datasheet's name, such as ``PB4``.
        """
        return f"P{self.port}{self.bit}"


@dataclass(frozen=True)
class Register:
    """
    One I/O register, by the name that datasheet and avr-libc give it.

    *address* is in data space, as LDS and STS use it; that of the low byte where it has two.
    """

    name: str
    address: int

    @property
    def in_io(self) -> bool:
        """
        Return whether IN and OUT reach the register (data-space address below 0x60).
        """
        return _IO_START <= self.address < _IO_END

    @property
    def bit_addressable(self) -> bool:
        """
        Return whether SBI, CBI, SBIS and SBIC reach the register (address below 0x40).
        """
        return _IO_START <= self.address < _BIT_ADDRESSABLE_END

    @property
    def io_address(self) -> int:
        """
        Return the address as IN and OUT use it: the data-space address less 0x20.

        Raises:
            ValueError: IN and OUT do not reach the register.
        """
        if not self.in_io:
            raise ValueError(f"{self.name} at {self.address:#x} has no I/O address")
        return self.address - _IO_START


@dataclass(frozen=True)
class Port:
    """
    One port: its input, direction and output register, and the bits that the chip has.

    Ones written to *pin* toggle the bits of *port*; *bits* ascend.
    """

    letter: str
    pin: Register
    ddr: Register
    port: Register
    bits: tuple[int, ...]


@dataclass(frozen=True)
class Vector:
    """
    One interrupt vector, as avr-libc's ISR() and ``_VECTOR(n)`` call it.

    ``Vector("TIMER1_OVF_vect", 13)``; reset is 0, and of two that wait the lower goes first.
    """

    name: str
    number: int


@dataclass(frozen=True)
class Timer16:
    """
    One 16-bit timer; what only some chips have (channel C, a capture pin) may be None.

    Args:
        number: The n of TCCRnA.
        tccra: Control register A; tccrb and tccrc likewise.
        tcnt: Counter, at the address of its low byte; icr and ocra to ocrc likewise.
        timsk: Interrupt mask register; tifr: interrupt flag register.
        capt: Input capture vector; also the "TOP reached" vector when ICR is TOP.
        compa: Compare match A vector; compb and compc likewise; ovf: overflow vector.
        outputs: Channel and pin of each compare output, such as ``("A", PB1)``.
        capture_input: Pin of the input capture, ICPn.
    """

    number: int
    tccra: Register
    tccrb: Register
    tccrc: Register
    tcnt: Register
    icr: Register
    ocra: Register
    ocrb: Register
    ocrc: Register | None
    timsk: Register
    tifr: Register
    capt: Vector
    compa: Vector
    compb: Vector
    compc: Vector | None
    ovf: Vector
    outputs: tuple[tuple[str, PortBit], ...]
    capture_input: PortBit | None

    prescalers: ClassVar[tuple[int, ...]] = (1, 8, 64, 256, 1024)
    """By clock select, from 1 on."""

    counter_bytes: ClassVar[int] = 2

    @property
    def compare_channels(self) -> dict[str, tuple[Register, Vector]]:
        """
        Return compare register and vector of each compare channel that the chip has.
        """
        rows = (
            ("A", self.ocra, self.compa),
            ("B", self.ocrb, self.compb),
            ("C", self.ocrc, self.compc),
        )
        return {name: (ocr, vector) for name, ocr, vector in rows if ocr and vector}


@dataclass(frozen=True)
class Timer8:
    """
    The 8-bit timer 2, which has a prescaler of its own and counts I/O clocks unless ASSR says else.

    Args:
        number: The n of TCCRnA.
        tccra: Control register A; tccrb likewise.
        tcnt: Counter; ocra and ocrb: compare registers.
        timsk: Interrupt mask register; tifr: interrupt flag register.
        compa: Compare match A vector; compb likewise; ovf: overflow vector.
        outputs: Channel and pin of each compare output, such as ``("A", PB3)``.
    """

    number: int
    tccra: Register
    tccrb: Register
    tcnt: Register
    ocra: Register
    ocrb: Register
    timsk: Register
    tifr: Register
    compa: Vector
    compb: Vector
    ovf: Vector
    outputs: tuple[tuple[str, PortBit], ...]

    prescalers: ClassVar[tuple[int, ...]] = (1, 8, 32, 64, 128, 256, 1024)
    """By clock select, from 1 on."""

    counter_bytes: ClassVar[int] = 1


Timer = Timer16 | Timer8


@dataclass(frozen=True)
class Mcu:
    """
    One microcontroller, as its datasheet describes it.

    Args:
        name: What ``avr-gcc -mmcu=`` takes, such as ``atmega328p``.
        title: How the datasheet writes it.
        macro: What avr-gcc defines for it, such as ``__AVR_ATmega328P__``.
        flash_bytes: All of the flash, boot section included.
        ram_bytes: Internal SRAM, from the data-space address ram_start on.
        response_cycles: Least from interrupt to vector: 4, or 5 where the PC has 22 bits.
        ports: All ports, by letter.
        timers16: All 16-bit timers, by number.
        timers8: The 8-bit timers that the core does not count its milliseconds with.
        vectors: All but reset, by number.
        gpiors: General purpose I/O registers 0 to 2; sreg: status; clkpr: clock prescaler.
    """

    name: str
    title: str
    macro: str
    flash_bytes: int
    ram_bytes: int
    ram_start: int
    response_cycles: int
    ports: tuple[Port, ...]
    timers16: tuple[Timer16, ...]
    timers8: tuple[Timer8, ...]
    vectors: tuple[Vector, ...]
    gpiors: tuple[Register, Register, Register]
    sreg: Register
    clkpr: Register

    @property
    def timers(self) -> tuple[Timer, ...]:
        """
        Return all timers but the core's, the 16-bit ones first.
        """
        return (*self.timers16, *self.timers8)

    def port(self, letter: str) -> Port:
        """
        Return the port called *letter*, upper case.

        Raises:
            KeyError: The chip has no such port.
        """
        found = [port for port in self.ports if port.letter == letter]
        if not found:
            raise KeyError(f"the {self.title} has no port {letter}")
        return found[0]

    def timer16(self, number: int) -> Timer16 | None:
        """
        Return the 16-bit timer *number*, or None where that timer is not there or has 8 bits.
        """
        return next((timer for timer in self.timers16 if timer.number == number), None)

    def timer8(self, number: int) -> Timer8 | None:
        """
        Return the 8-bit timer *number*, or None where it is not there, not free or has 16 bits.
        """
        return next((timer for timer in self.timers8 if timer.number == number), None)

    @property
    def has_usb(self) -> bool:
        """
        Tell whether it has USB of its own: Arduino's Serial then is that.
        """
        return any(vector.name == "USB_GEN_vect" for vector in self.vectors)

    def vector(self, name: str) -> Vector:
        """
        Return the vector that avr-libc calls *name*.

        Raises:
            KeyError: The chip has no such vector.
        """
        found = [vector for vector in self.vectors if vector.name == name]
        if not found:
            raise KeyError(f"the {self.title} has no {name}")
        return found[0]


@dataclass(frozen=True)
class Pin:
    """
    One header pin of a board.

    Args:
        label: What is printed beside it: ``D12`` or ``A8``.
        number: Arduino's digital pin number; A0 of the Uno is 14.
        bit: The port bit it is wired to.
        uses: What else it is for, as people look for it: ``Serial1 TX``, ``SPI SS``,
            ``I2C SDA``, ``LED``, ``INT0`` (the chip's number, which names the vector),
            ``PWM OC1A`` (what analogWrite() switches on).
        also: What else is printed beside it: the Leonardo's D4 is ``A6``, too.
    """

    label: str
    number: int
    bit: PortBit
    uses: tuple[str, ...] = ()
    also: tuple[str, ...] = ()

    @property
    def names(self) -> tuple[str, ...]:
        """
        Return all that the pin goes by: ``A0``, ``14``, ``D14`` and ``PC0``.
        """
        return (self.label, str(self.number), f"D{self.number}", self.bit.name, *self.also)


@dataclass(frozen=True)
class Board:
    """
    One board, as the Arduino core knows it.

    Args:
        name: What a spec calls it, such as ``uno``; title: what people call it.
        mcu: Its chip, clocked with f_cpu_hz.
        fqbn: Fully qualified board name, such as ``arduino:avr:uno``.
        variant: Folder of its ``pins_arduino.h`` in the core's ``variants``.
        core_define: What the core defines for it, such as ``ARDUINO_AVR_UNO``.
        pins: All header pins that are port bits, by number.
        analog_inputs: Labels of header pins that only analogRead() can use: they are no port bits.
        may_reset_for_ever: Whether a boot loader that the core has for it leaves the watchdog on
            after a reset by it, and so never comes to the sketch.
    """

    name: str
    title: str
    mcu: Mcu
    f_cpu_hz: int
    fqbn: str
    variant: str
    core_define: str
    pins: tuple[Pin, ...]
    analog_inputs: tuple[str, ...] = ()
    may_reset_for_ever: bool = False

    def find_pin(self, text: str) -> Pin | None:
        """
        Return the pin that has *text* among its `Pin.names`, in any case, or None.

        A port bit that no header pin carries, such as the Uno's PB6 (crystal), is not found.
        """
        wanted = text.upper()
        return next((pin for pin in self.pins if wanted in pin.names), None)

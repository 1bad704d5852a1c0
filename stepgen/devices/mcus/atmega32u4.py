"""
ATmega32U4: facts from Microchip's datasheet Atmel-7766 (ATmega16U4/32U4).

Timer 4 is left out: it has 10 bits, a PLL and registers of its own kind, and nothing here fits it.
There is no timer 2, although avr-libc's header has its registers.
"""

from stepgen.devices.model import Mcu, Register
from stepgen.devices.tables import port, timer16, vectors

# Section "Interrupt Vectors in ATmega16U4/ATmega32U4"; reset is number 0, - is reserved.
_VECTORS = vectors(
    """
    INT0 INT1 INT2 INT3 - - INT6 - PCINT0 USB_GEN USB_COM WDT - - -
    TIMER1_CAPT TIMER1_COMPA TIMER1_COMPB TIMER1_COMPC TIMER1_OVF
    TIMER0_COMPA TIMER0_COMPB TIMER0_OVF
    SPI_STC USART1_RX USART1_UDRE USART1_TX
    ANALOG_COMP ADC EE_READY
    TIMER3_CAPT TIMER3_COMPA TIMER3_COMPB TIMER3_COMPC TIMER3_OVF
    TWI SPM_READY
    TIMER4_COMPA TIMER4_COMPB TIMER4_COMPD TIMER4_OVF TIMER4_FPF
    """
)

MCU = Mcu(
    name="atmega32u4",
    title="ATmega32U4",
    macro="__AVR_ATmega32U4__",
    flash_bytes=32 * 1024,
    ram_bytes=2560,
    ram_start=0x100,
    # Section "Interrupt Response Time" says five cycles, in which the three bytes of the PC are
    # pushed. This chip has a PC of two: the text is that of the AT90USB1287. See the instruction
    # set manual (DS40002198), RETI: four cycles for a PC of 16 bits.
    response_cycles=4,
    ports=(
        port("B", 0x23, range(8)),
        port("C", 0x26, (6, 7)),
        port("D", 0x29, range(8)),
        port("E", 0x2C, (2, 6)),
        port("F", 0x2F, (0, 1, 4, 5, 6, 7)),
    ),
    timers16=(
        timer16(1, 0x80, _VECTORS, {"A": "PB5", "B": "PB6", "C": "PB7"}, "PD4"),
        timer16(3, 0x90, _VECTORS, {"A": "PC6"}, "PC7"),
    ),
    timers8=(),
    vectors=_VECTORS,
    gpiors=(Register("GPIOR0", 0x3E), Register("GPIOR1", 0x4A), Register("GPIOR2", 0x4B)),
    sreg=Register("SREG", 0x5F),
    clkpr=Register("CLKPR", 0x61),
)

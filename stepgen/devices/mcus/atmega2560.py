"""
ATmega2560: facts from Microchip's datasheet DS40002211 (formerly Atmel 2549).
"""

from stepgen.devices.model import Mcu, Register
from stepgen.devices.tables import port, timer2, timer16, vectors

# Section "Interrupt Vectors in ATmega640/1280/1281/2560/2561"; reset is number 0.
_VECTORS = vectors(
    """
    INT0 INT1 INT2 INT3 INT4 INT5 INT6 INT7 PCINT0 PCINT1 PCINT2 WDT
    TIMER2_COMPA TIMER2_COMPB TIMER2_OVF
    TIMER1_CAPT TIMER1_COMPA TIMER1_COMPB TIMER1_COMPC TIMER1_OVF
    TIMER0_COMPA TIMER0_COMPB TIMER0_OVF
    SPI_STC USART0_RX USART0_UDRE USART0_TX
    ANALOG_COMP ADC EE_READY
    TIMER3_CAPT TIMER3_COMPA TIMER3_COMPB TIMER3_COMPC TIMER3_OVF
    USART1_RX USART1_UDRE USART1_TX TWI SPM_READY
    TIMER4_CAPT TIMER4_COMPA TIMER4_COMPB TIMER4_COMPC TIMER4_OVF
    TIMER5_CAPT TIMER5_COMPA TIMER5_COMPB TIMER5_COMPC TIMER5_OVF
    USART2_RX USART2_UDRE USART2_TX USART3_RX USART3_UDRE USART3_TX
    """
)

MCU = Mcu(
    name="atmega2560",
    title="ATmega2560",
    macro="__AVR_ATmega2560__",
    flash_bytes=256 * 1024,
    ram_bytes=8 * 1024,
    ram_start=0x200,
    response_cycles=5,  # 22-bit program counter: three bytes to push
    ports=(
        port("A", 0x20, range(8)),
        port("B", 0x23, range(8)),
        port("C", 0x26, range(8)),
        port("D", 0x29, range(8)),
        port("E", 0x2C, range(8)),
        port("F", 0x2F, range(8)),
        port("G", 0x32, range(6)),
        port("H", 0x100, range(8)),  # H to L: beyond IN, OUT, SBI and CBI
        port("J", 0x103, range(8)),
        port("K", 0x106, range(8)),
        port("L", 0x109, range(8)),
    ),
    timers16=(
        timer16(1, 0x80, _VECTORS, {"A": "PB5", "B": "PB6", "C": "PB7"}, "PD4"),
        timer16(3, 0x90, _VECTORS, {"A": "PE3", "B": "PE4", "C": "PE5"}, "PE7"),
        timer16(4, 0xA0, _VECTORS, {"A": "PH3", "B": "PH4", "C": "PH5"}, "PL0"),
        timer16(5, 0x120, _VECTORS, {"A": "PL3", "B": "PL4", "C": "PL5"}, "PL1"),
    ),
    timers8=(timer2(_VECTORS, {"A": "PB4", "B": "PH6"}),),
    vectors=_VECTORS,
    gpiors=(Register("GPIOR0", 0x3E), Register("GPIOR1", 0x4A), Register("GPIOR2", 0x4B)),
    sreg=Register("SREG", 0x5F),
    clkpr=Register("CLKPR", 0x61),
)

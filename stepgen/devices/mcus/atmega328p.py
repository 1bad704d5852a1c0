"""
ATmega328P: facts from Microchip's datasheet DS40002061.
"""

from stepgen.devices.model import Mcu, Register
from stepgen.devices.tables import port, timer2, timer16, vectors

# Section "Interrupt Vectors in ATmega328P"; reset is number 0.
_VECTORS = vectors(
    """
    INT0 INT1 PCINT0 PCINT1 PCINT2 WDT
    TIMER2_COMPA TIMER2_COMPB TIMER2_OVF
    TIMER1_CAPT TIMER1_COMPA TIMER1_COMPB TIMER1_OVF
    TIMER0_COMPA TIMER0_COMPB TIMER0_OVF
    SPI_STC USART_RX USART_UDRE USART_TX
    ADC EE_READY ANALOG_COMP TWI SPM_READY
    """
)

MCU = Mcu(
    name="atmega328p",
    title="ATmega328P",
    macro="__AVR_ATmega328P__",
    flash_bytes=32 * 1024,
    ram_bytes=2 * 1024,
    ram_start=0x100,
    response_cycles=4,
    ports=(
        port("B", 0x23, range(8)),  # PB6 and PB7 carry the crystal
        port("C", 0x26, range(7)),  # PC6 is RESET
        port("D", 0x29, range(8)),
    ),
    timers16=(timer16(1, 0x80, _VECTORS, {"A": "PB1", "B": "PB2"}, "PB0"),),
    timers8=(timer2(_VECTORS, {"A": "PB3", "B": "PD3"}),),
    vectors=_VECTORS,
    gpiors=(Register("GPIOR0", 0x3E), Register("GPIOR1", 0x4A), Register("GPIOR2", 0x4B)),
    sreg=Register("SREG", 0x5F),
    clkpr=Register("CLKPR", 0x61),
)

"""
The Uno's pins, on most boards with an ATmega328P.

Not on a header: PB6 and PB7 (crystal), PC6 (RESET).
"""

from dataclasses import replace

from stepgen.devices.model import Pin
from stepgen.devices.tables import header_pins

PINS = header_pins(
    """
    D0   PD0  Serial RX
    D1   PD1  Serial TX
    D2   PD2  INT0
    D3   PD3  INT1, PWM OC2B
    D4   PD4
    D5   PD5  PWM OC0B
    D6   PD6  PWM OC0A
    D7   PD7
    D8   PB0
    D9   PB1  PWM OC1A
    D10  PB2  SPI SS, PWM OC1B
    D11  PB3  SPI MOSI, PWM OC2A
    D12  PB4  SPI MISO
    D13  PB5  SPI SCK, LED
    A0   PC0
    A1   PC1
    A2   PC2
    A3   PC3
    A4   PC4  I2C SDA
    A5   PC5  I2C SCL
    """
)

# The 32-pin packages of the ATmega328P have them, the Uno's 28 pins not: ADC6 and ADC7, behind no
# port.
EIGHT_ANALOG_INPUTS = ("A6", "A7")


def pins_with_led(label: str) -> tuple[Pin, ...]:
    """
    Return the same pins with the LED on the one called *label* instead of D13.
    """

    def uses(pin: Pin) -> tuple[str, ...]:
        others = tuple(use for use in pin.uses if use != "LED")
        return (*others, "LED") if pin.label == label else others

    return tuple(replace(pin, uses=uses(pin)) for pin in PINS)

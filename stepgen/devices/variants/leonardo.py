"""
The pins of the Leonardo and its relatives.

The core numbers the analog inputs A6 to A11 once more, 24 to 29. D14 to D17 are on the ICSP header
only, or on the Micro's own; D17 is the LED RX as well. Not on a header: PE2 (HWB), PD5 (LED TX).
"""

from stepgen.devices.tables import header_pins

PINS = header_pins(
    """
    D0       PD2  Serial1 RX, INT2
    D1       PD3  Serial1 TX, INT3
    D2       PD1  I2C SDA, INT1
    D3       PD0  I2C SCL, INT0, PWM OC0B
    D4/A6    PD4
    D5       PC6  PWM OC3A
    D6/A7    PD7  PWM OC4D
    D7       PE6  INT6
    D8/A8    PB4
    D9/A9    PB5  PWM OC1A
    D10/A10  PB6  PWM OC1B
    D11      PB7  PWM OC0A
    D12/A11  PD6
    D13      PC7  LED, PWM OC4A
    D14      PB3  SPI MISO
    D15      PB1  SPI SCK
    D16      PB2  SPI MOSI
    D17      PB0  SPI SS
    A0       PF7
    A1       PF6
    A2       PF5
    A3       PF4
    A4       PF1
    A5       PF0
    """
)

"""
The pins of the Mega and its relatives.

Not on a header: PD4 to PD6, PE2, PE6, PE7, PG3, PG4, PH2, PH7, PJ2 to PJ7.
"""

from stepgen.devices.tables import header_pins

PINS = header_pins(
    """
    D0   PE0  Serial RX
    D1   PE1  Serial TX
    D2   PE4  INT4, PWM OC3B
    D3   PE5  INT5, PWM OC3C
    D4   PG5  PWM OC0B
    D5   PE3  PWM OC3A
    D6   PH3  PWM OC4A
    D7   PH4  PWM OC4B
    D8   PH5  PWM OC4C
    D9   PH6  PWM OC2B
    D10  PB4  PWM OC2A
    D11  PB5  PWM OC1A
    D12  PB6  PWM OC1B
    D13  PB7  LED, PWM OC0A
    D14  PJ1  Serial3 TX
    D15  PJ0  Serial3 RX
    D16  PH1  Serial2 TX
    D17  PH0  Serial2 RX
    D18  PD3  Serial1 TX, INT3
    D19  PD2  Serial1 RX, INT2
    D20  PD1  I2C SDA, INT1
    D21  PD0  I2C SCL, INT0
    D22  PA0
    D23  PA1
    D24  PA2
    D25  PA3
    D26  PA4
    D27  PA5
    D28  PA6
    D29  PA7
    D30  PC7
    D31  PC6
    D32  PC5
    D33  PC4
    D34  PC3
    D35  PC2
    D36  PC1
    D37  PC0
    D38  PD7
    D39  PG2
    D40  PG1
    D41  PG0
    D42  PL7
    D43  PL6
    D44  PL5  PWM OC5C
    D45  PL4  PWM OC5B
    D46  PL3  PWM OC5A
    D47  PL2
    D48  PL1
    D49  PL0
    D50  PB3  SPI MISO
    D51  PB2  SPI MOSI
    D52  PB1  SPI SCK
    D53  PB0  SPI SS
    A0   PF0
    A1   PF1
    A2   PF2
    A3   PF3
    A4   PF4
    A5   PF5
    A6   PF6
    A7   PF7
    A8   PK0
    A9   PK1
    A10  PK2
    A11  PK3
    A12  PK4
    A13  PK5
    A14  PK6
    A15  PK7
    """
)

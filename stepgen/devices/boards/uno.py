"""
Arduino Uno (R1 to R3): pins from the Arduino core's ``variants/standard``.
"""

from stepgen.devices.mcus import atmega328p
from stepgen.devices.model import Board
from stepgen.devices.tables import header_pins

BOARD = Board(
    name="uno",
    title="Arduino Uno",
    mcu=atmega328p.MCU,
    f_cpu_hz=16_000_000,
    fqbn="arduino:avr:uno",
    variant="standard",
    core_define="ARDUINO_AVR_UNO",
    # Not on a header: PB6 and PB7 (crystal), PC6 (RESET).
    pins=header_pins(
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
    ),
)

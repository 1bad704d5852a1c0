"""
Arduino Duemilanove of 2009, with an ATmega328P.
"""

from stepgen.devices.mcus import atmega328p
from stepgen.devices.model import Board
from stepgen.devices.variants import standard

BOARD = Board(
    name="duemilanove",
    title="Arduino Duemilanove",
    mcu=atmega328p.MCU,
    f_cpu_hz=16_000_000,
    fqbn="arduino:avr:diecimila:cpu=atmega328",
    variant="standard",
    core_define="ARDUINO_AVR_DUEMILANOVE",
    pins=standard.PINS,
    may_reset_for_ever=True,  # by ATmegaBOOT
)

"""
Arduino Micro: a Leonardo without the headers for shields.
"""

from stepgen.devices.mcus import atmega32u4
from stepgen.devices.model import Board
from stepgen.devices.variants import leonardo

BOARD = Board(
    name="micro",
    title="Arduino Micro",
    mcu=atmega32u4.MCU,
    f_cpu_hz=16_000_000,
    fqbn="arduino:avr:micro",
    variant="micro",
    core_define="ARDUINO_AVR_MICRO",
    pins=leonardo.PINS,
)

"""
Arduino Leonardo: the USB connector is the chip's own.
"""

from stepgen.devices.mcus import atmega32u4
from stepgen.devices.model import Board
from stepgen.devices.variants import leonardo

BOARD = Board(
    name="leonardo",
    title="Arduino Leonardo",
    mcu=atmega32u4.MCU,
    f_cpu_hz=16_000_000,
    fqbn="arduino:avr:leonardo",
    variant="leonardo",
    core_define="ARDUINO_AVR_LEONARDO",
    pins=leonardo.PINS,
)

"""
Arduino Mega 2560.
"""

from stepgen.devices.mcus import atmega2560
from stepgen.devices.model import Board
from stepgen.devices.variants import mega

BOARD = Board(
    name="mega",
    title="Arduino Mega 2560",
    mcu=atmega2560.MCU,
    f_cpu_hz=16_000_000,
    fqbn="arduino:avr:mega:cpu=atmega2560",
    variant="mega",
    core_define="ARDUINO_AVR_MEGA2560",
    pins=mega.PINS,
)

"""
Arduino Mega of 2009, with an ATmega1280.
"""

from stepgen.devices.mcus import atmega1280
from stepgen.devices.model import Board
from stepgen.devices.variants import mega

BOARD = Board(
    name="mega1280",
    title="Arduino Mega 1280",
    mcu=atmega1280.MCU,
    f_cpu_hz=16_000_000,
    fqbn="arduino:avr:mega:cpu=atmega1280",
    variant="mega",
    core_define="ARDUINO_AVR_MEGA",
    pins=mega.PINS,
    may_reset_for_ever=True,  # by ATmegaBOOT
)

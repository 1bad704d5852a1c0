"""
Arduino Mega ADK: a Mega 2560 with a USB host.
"""

from stepgen.devices.mcus import atmega2560
from stepgen.devices.model import Board
from stepgen.devices.variants import mega

BOARD = Board(
    name="mega-adk",
    title="Arduino Mega ADK",
    mcu=atmega2560.MCU,
    f_cpu_hz=16_000_000,
    fqbn="arduino:avr:megaADK",
    variant="mega",
    core_define="ARDUINO_AVR_ADK",
    pins=mega.PINS,
)

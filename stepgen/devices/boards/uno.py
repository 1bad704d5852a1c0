"""
Arduino Uno (R1 to R3).
"""

from stepgen.devices.mcus import atmega328p
from stepgen.devices.model import Board
from stepgen.devices.variants import standard

BOARD = Board(
    name="uno",
    title="Arduino Uno",
    mcu=atmega328p.MCU,
    f_cpu_hz=16_000_000,
    fqbn="arduino:avr:uno",
    variant="standard",
    core_define="ARDUINO_AVR_UNO",
    pins=standard.PINS,
)

"""
Arduino UNO Mini, the limited edition of 2021.
"""

from stepgen.devices.mcus import atmega328p
from stepgen.devices.model import Board
from stepgen.devices.variants import standard

BOARD = Board(
    name="uno-mini",
    title="Arduino UNO Mini",
    mcu=atmega328p.MCU,
    f_cpu_hz=16_000_000,
    fqbn="arduino:avr:unomini",
    variant="standard",
    core_define="ARDUINO_AVR_UNO",
    pins=standard.PINS,
)

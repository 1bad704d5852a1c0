"""
Arduino Leonardo ETH: a Leonardo with a network controller on the ICSP header and D10.
"""

from stepgen.devices.mcus import atmega32u4
from stepgen.devices.model import Board
from stepgen.devices.variants import leonardo

BOARD = Board(
    name="leonardo-eth",
    title="Arduino Leonardo ETH",
    mcu=atmega32u4.MCU,
    f_cpu_hz=16_000_000,
    fqbn="arduino:avr:leonardoeth",
    variant="leonardo",
    core_define="ARDUINO_AVR_LEONARDO_ETH",
    pins=leonardo.PINS,
)

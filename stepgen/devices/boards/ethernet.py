"""
Arduino Ethernet: an Uno with a network controller on D10 to D13, its LED on D9.
"""

from stepgen.devices.mcus import atmega328p
from stepgen.devices.model import Board
from stepgen.devices.variants import standard

BOARD = Board(
    name="ethernet",
    title="Arduino Ethernet",
    mcu=atmega328p.MCU,
    f_cpu_hz=16_000_000,
    fqbn="arduino:avr:ethernet",
    variant="ethernet",
    core_define="ARDUINO_AVR_ETHERNET",
    pins=standard.pins_with_led("D9"),
)

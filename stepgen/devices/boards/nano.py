"""
Arduino Nano (ATmega328P, with the old bootloader or the new one).
"""

from stepgen.devices.mcus import atmega328p
from stepgen.devices.model import Board
from stepgen.devices.variants import standard

BOARD = Board(
    name="nano",
    title="Arduino Nano",
    mcu=atmega328p.MCU,
    f_cpu_hz=16_000_000,
    fqbn="arduino:avr:nano:cpu=atmega328",
    variant="eightanaloginputs",
    core_define="ARDUINO_AVR_NANO",
    pins=standard.PINS,
    analog_inputs=standard.EIGHT_ANALOG_INPUTS,
    may_reset_for_ever=True,  # by ATmegaBOOT
)

"""
Arduino Pro or Pro Mini of 5 V.
"""

from stepgen.devices.mcus import atmega328p
from stepgen.devices.model import Board
from stepgen.devices.variants import standard

BOARD = Board(
    name="pro-mini",
    title="Arduino Pro Mini 5 V",
    mcu=atmega328p.MCU,
    f_cpu_hz=16_000_000,
    fqbn="arduino:avr:pro:cpu=16MHzatmega328",
    variant="eightanaloginputs",
    core_define="ARDUINO_AVR_PRO",
    pins=standard.PINS,
    analog_inputs=standard.EIGHT_ANALOG_INPUTS,
    may_reset_for_ever=True,  # by ATmegaBOOT
)

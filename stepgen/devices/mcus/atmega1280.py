"""
ATmega1280: an ATmega2560 with half the flash, by the same datasheet (DS40002211).
"""

from dataclasses import replace

from stepgen.devices.mcus import atmega2560

MCU = replace(
    atmega2560.MCU,
    name="atmega1280",
    title="ATmega1280",
    macro="__AVR_ATmega1280__",
    flash_bytes=128 * 1024,
    response_cycles=4,  # 16-bit program counter: two bytes to push
)

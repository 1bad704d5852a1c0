"""
The bits and codes of the contract, and the verdict on a call (systems/1-motor-driver.md).
"""

from enum import IntEnum, IntFlag

from stepgen.reference.timer import SLOWEST_CYCLES


class Control(IntFlag):
    """
    The control bits of a library with motion ``constant``; it lacks every other one.
    """

    DRV_EN = 0x80
    ENDPOINT_MILLIS = 0x04
    DIRECTION = 0x01


ALL_CONTROL_BITS = 0xFF
CONSTANT_CONTROL_BITS = Control.DRV_EN | Control.ENDPOINT_MILLIS | Control.DIRECTION


class Status(IntFlag):
    """
    The status bits; a library without callbacks never sets those with CALLED.
    """

    FAULT = 0x01
    FAULT_CALLED = 0x02
    TIMER_DIV_ERROR = 0x04
    TIMER_DIV_CALLED = 0x08
    REACHED = 0x10
    REACH_CALLED = 0x20
    SPIN_FIXED = 0x40
    MISSED = 0x80


class Code(IntEnum):
    """
    What a call returns: below 0 refused, above 0 a warning.
    """

    FINE = 0
    NOT_DRIVEN = 1
    TOO_FAST = -1
    TOO_SLOW = -2
    CONTROL = -3
    RUNNING = -5


def stops(control: int, virtual_cycles: int) -> bool:
    """
    Tell whether the call is a stop: virtual 0 or no DRV_EN, whatever else it asks for.
    """
    return virtual_cycles == 0 or not control & Control.DRV_EN


def verdict(control: int, virtual_cycles: int, minimum_cycles: int) -> Code:
    """
    Return the code of a call of ``motorSetSpeed``: first stop, then control bits, then range.
    """
    if stops(control, virtual_cycles):
        return Code.FINE if virtual_cycles == 0 else Code.NOT_DRIVEN
    if control & ~CONSTANT_CONTROL_BITS & ALL_CONTROL_BITS:
        return Code.CONTROL
    if virtual_cycles < minimum_cycles:
        return Code.TOO_FAST
    return Code.TOO_SLOW if virtual_cycles > SLOWEST_CYCLES else Code.FINE


def fault_bits(code: Code) -> Status:
    """
    Return the status bits that a refused call sets, none for any other.
    """
    if code >= 0:
        return Status(0)
    range_codes = (Code.TOO_FAST, Code.TOO_SLOW)
    return Status.FAULT | Status.TIMER_DIV_ERROR if code in range_codes else Status.FAULT

"""
The verdict on a call, before it does anything (systems/1-motor-driver.md, Contract).
"""

from stepgen.reference.contract import CONTROL_BITS, Code, Control, Status
from stepgen.reference.facts import MotorFacts
from stepgen.reference.stimuli import SetSpeed


def stops(call: SetSpeed) -> bool:
    """
    Tell whether *call* is a stop: virtual 0 or no DRV_EN, whatever else it asks for.
    """
    return call.virtual_cycles == 0 or not call.control & Control.DRV_EN


def verdict(call: SetSpeed, facts: MotorFacts) -> Code:
    """
    Return the code of *call*: first stop, then control bits, then range, then update events.
    """
    if stops(call):
        return Code.FINE if call.virtual_cycles == 0 else Code.NOT_DRIVEN
    if call.control & ~CONTROL_BITS[facts.motion]:
        return Code.CONTROL
    if call.virtual_cycles < facts.minimum_cycles:
        return Code.TOO_FAST
    if call.virtual_cycles > facts.slowest_cycles:
        return Code.TOO_SLOW
    return Code.FINE if _has_whole_updates(call) else Code.UPDATE


def fault_bits(code: Code) -> Status:
    """
    Return the status bits that a refused call sets, none for any other.
    """
    if code >= 0:
        return Status(0)
    range_codes = (Code.TOO_FAST, Code.TOO_SLOW)
    return Status.FAULT | Status.TIMER_DIV_ERROR if code in range_codes else Status.FAULT


def _has_whole_updates(call: SetSpeed) -> bool:
    """
    Tell whether *call* has no update events, or neither modification, interval nor count is 0.
    """
    if not call.control & Control.SPEED_VARIABLE:
        return True
    return 0 not in (call.modification, call.update_interval, call.update_count)

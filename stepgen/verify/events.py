"""
What the harness records: one row per event, as api.h lays it out.
"""

from enum import IntEnum
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray


class Kind(IntEnum):
    """
    What happened; `source`, `value` and `cycle` mean something else for each.

    Cycles count CPU clocks since reset. A write carries the cycle at which its instruction
    is complete: `out` takes 1, `sts`, `st`, `sbi` and `cbi` take 2.
    """

    PORT = 1
    """PORTx or DDRx changed: data address, what it now holds (a toggle names PORTx)."""
    REGISTER = 2
    """A watched register was written: data address, byte."""
    MARK = 3
    """EEDR was written: data address, byte."""
    ISR_ENTER = 4
    """An interrupt is taken, before its response cycles: vector, interrupted byte address."""
    ISR_EXIT = 5
    """RETI is complete: vector, bytes of stack that this run of the ISR took."""
    UART = 6
    """A byte was given to a USART, or the computer took it over USB: address of UDRn or UEDATX."""
    MASKED = 7
    """The main program cleared the I flag (fine recording only)."""
    UNMASKED = 8
    """The main program set the I flag (fine recording only)."""
    RAISE = 9
    """An enabled flag of a timer but 0 came: vector, 1 if it was still raised (lost)."""
    RESET = 10
    """The watchdog reset the chip: address of MCUSR, what it holds from then on."""


Event: TypeAlias = np.void
"""One row; the fields are those of EVENT."""

EVENT = np.dtype(
    [
        ("cycle", "<i8"),
        ("since", "<i8"),
        ("masked_until", "<i8"),
        ("value", "<u4"),
        ("source", "<u2"),
        ("kind", "<u2"),
    ]
)
"""
Cycles are signed so that differences of them are plain numbers.
`since` is the cycle at which the flag was set (ISR_ENTER) or the ISR entered (ISR_EXIT).
`masked_until` (ISR_ENTER) is the cycle at which the I flag, or the interrupt's enable bit,
was last set between `since` and `cycle`; equal to `since` if both had been set before.
"""

Events: TypeAlias = NDArray[np.void]

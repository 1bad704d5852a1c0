"""
The periods that the chip's watchdog has.
"""

from typing import Annotated

from pydantic import AfterValidator, Field

WATCHDOG_MS = (15, 30, 60, 120, 250, 500, 1000, 2000, 4000, 8000)
"""As avr-libc names them: 2048 ticks of 128 kHz, which are 16 ms, and each next one twice that."""


def _is_a_period(period_ms: int) -> int:
    """
    Return *period_ms* if the watchdog has it; else say which are nearest, below and above.
    """
    if period_ms in WATCHDOG_MS:
        return period_ms
    below = [str(known) for known in WATCHDOG_MS if known < period_ms][-1:]
    above = [str(known) for known in WATCHDOG_MS if known > period_ms][:1]
    raise ValueError(f"is no period of the chip's watchdog; take {' or '.join(below + above)}")


WatchdogMs = Annotated[
    int,
    Field(json_schema_extra={"enum": list(WATCHDOG_MS)}),
    AfterValidator(_is_a_period),
]
"""One of WATCHDOG_MS."""

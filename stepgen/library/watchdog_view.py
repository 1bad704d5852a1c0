"""
The view of the watchdog, where the library has one.
"""

from dataclasses import dataclass

from stepgen.library.text import comment_lines, listed
from stepgen.plan.model import Plan
from stepgen.units import MILLISECONDS_PER_SECOND


@dataclass(frozen=True)
class Watchdog:
    """
    Its period in milliseconds, as avr-libc's constant, and what users must know.
    """

    millis: str
    constant: str
    comment: tuple[str, ...]


def watchdog_view(plan: Plan) -> Watchdog | None:
    """
    Return what the templates print about the watchdog of *plan*, None if it has none.
    """
    period_ms = plan.watchdog_ms
    if period_ms is None:
        return None
    inits = listed([f"{motor.name}ShieldInit()" for motor in plan.motors])
    return Watchdog(
        millis=str(period_ms),
        constant=_constant(period_ms),
        comment=comment_lines(
            f"The watchdog: once it is on, a sketch that has not fed it for {period_ms} ms is "
            f"taken to hang. The chip resets then: the motors' pins are inputs until {inits}, and "
            "setup() begins anew. Its oscillator is the chip's own, and up to a fifth fast or "
            "slow: feed it twice as often."
        ),
    )


def _constant(period_ms: int) -> str:
    """
    Return what avr-libc calls *period_ms*: WDTO_250MS, WDTO_1S.
    """
    if period_ms < MILLISECONDS_PER_SECOND:
        return f"WDTO_{period_ms}MS"
    return f"WDTO_{period_ms // MILLISECONDS_PER_SECOND}S"

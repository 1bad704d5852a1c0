"""
What the README says of speed: how fast each motor may be, and how long interrupts may be off.
"""

from collections.abc import Iterator
from dataclasses import dataclass

from stepgen.library.text import listed
from stepgen.plan.model import HeldOff, Plan, RateLimit

_PIXEL_US = 30  # 24 bits of 1.25 us
FRAME_BITS = 10  # of a byte of a UART: start, 8 data, stop
_BAUD_RATES = (300, 600, 1200, 2400, 4800, 9600, 19_200, 38_400, 57_600, 115_200)
_TICK_CYCLES = 64 * 256  # of millis


@dataclass(frozen=True)
class HeldRow:
    """
    A row of the table: a rate, and what the sketch may do at it.
    """

    rate: str
    stretch: str
    pixels: str
    baud: str


def speeds(plan: Plan) -> Iterator[str]:
    """
    Yield how fast each motor may be, a line each, and what the library accepts.
    """
    for motor in plan.motors:
        *slower, last = plan.rates[motor.name]
        alone = f" ({int(slower[0].steps_per_second)} {slower[0].beside})"
        shown = alone if slower[0].period_cycles < last.period_cycles else ""
        yield (
            f"`{motor.name}`: up to {int(last.steps_per_second)} steps/s {last.beside}{shown}; "
            f"{last.cause}{_caution(last)}."
        )
    highest = plan.board.f_cpu_hz // plan.minimum_period_cycles
    yield f"The library refuses more than {highest} steps/s, for any of its motors."


def _caution(limit: RateLimit) -> str:
    names = tuple(limit.unproven)
    return f"; the cycles of {listed(names)} are not proven" if names else ""


def held_rows(plan: Plan) -> Iterator[HeldRow]:
    """
    Yield the rows of the table of stretches with interrupts off.
    """
    for held in plan.held_off:
        allowed_us = microseconds(held, plan)
        frame = _lowest_baud(held, plan)
        yield HeldRow(
            f"{int(held.steps_per_second)}",
            f"{int(allowed_us)} us",
            str(int(allowed_us // _PIXEL_US)),
            f"{frame}" if frame else "none",
        )


def lowest_baud(plan: Plan, steps_per_second: int, at_least: int) -> int | None:
    """
    Return the lowest usual baud at which SoftwareSerial loses no step at that rate, or None.
    """
    held = next((h for h in plan.held_off if h.steps_per_second >= steps_per_second), None)
    baud = _lowest_baud(held, plan) if held else None
    return max(baud, at_least) if baud else None


def _lowest_baud(held: HeldOff, plan: Plan) -> int | None:
    allowed_us = microseconds(held, plan)
    return next((b for b in _BAUD_RATES if FRAME_BITS * 1e6 / b <= allowed_us), None)


def lateness(plan: Plan) -> str:
    """
    Return how late steps are after a stretch with interrupts off.
    """
    f_cpu = plan.board.f_cpu_hz
    more = max(held.late_cycles - held.stretch_cycles for held in plan.held_off)
    return (
        f"A step that falls due meanwhile is late by the length of the stretch and "
        f"{-(-more * 1_000_000 // f_cpu)} us at most; those after it are on time again. Stretches "
        f"that follow each other at once count as one. With interrupts off for more than "
        f"{_TICK_CYCLES * 1e3 / f_cpu:.1f} ms `millis()` goes behind."
    )


def microseconds(held: HeldOff, plan: Plan) -> float:
    """
    Return how long the sketch may have interrupts off.
    """
    return held.stretch_cycles * 1e6 / plan.board.f_cpu_hz

"""
STEP and DIR: what a driver's inputs show, and the times that its datasheet asks for.

Wires: STEP, DIR and, if there is one, ENABLE. Between two steps STEP is LOW; a step is one pulse on
it. DIR is LOW forward and HIGH backward, from the call that turns the motor round on.
"""

from dataclasses import dataclass, replace
from typing import Any, Self

from stepgen.devices import DRIVERS
from stepgen.reference.sequences import Pattern

# A pulse may be longer than the driver needs by what an interrupt does in it anyhow.
_LONGER_CYCLES = 16
# On a 16-bit timer that runs through it reads and writes the timer meanwhile.
_LONGER_AT_COMPARE_CYCLES = 48
# That of an axis may begin a level, 43 cycles, and set the timer once more for a late step, 25.
_LONGER_ON_A_RAMP_CYCLES = _LONGER_AT_COMPARE_CYCLES + 68
_NS_IN_A_SECOND = 1_000_000_000
# The first interval is cut off to a whole tick, and can be one tick short: 1024 cycles each.
_WAKE_MARGIN_CYCLES = 2048
_NEVER_SHORTER_CYCLES = {"fast-pwm": 640, "ctc": 640, "compare": 2048, "wide-compare": 100}
"""Intervals that every motor of a timing has at least: a driver that is quicker need not wait."""


@dataclass(frozen=True)
class PulseFacts:
    """
    What a driver asks of its inputs, in CPU cycles.

    Args:
        high: How long STEP is HIGH at least; longest_high: and at most.
        low: How long it is LOW between two pulses, at least.
        setup: From a change of DIR to the rising edge; hold: from that to a change of DIR.
        enable: From ENABLE to the first rising edge.
        enabled_level: The level of ENABLE that drives the motor, None without ENABLE.
    """

    high: int
    longest_high: int
    low: int
    setup: int
    hold: int
    enable: int
    enabled_level: bool | None

    @property
    def phases(self) -> tuple[Pattern, Pattern]:
        """
        Return what the wires show after a step forward, and after one backward.
        """
        enable = () if self.enabled_level is None else (self.enabled_level,)
        care = (True, True, *(True for _ in enable))
        return Pattern((False, False, *enable), care), Pattern((False, True, *enable), care)

    @property
    def coils_off(self) -> Pattern:
        """
        Return what they show without current: DIR may be either.
        """
        if self.enabled_level is None:
            return Pattern((False, False), (True, False))
        return Pattern((False, False, not self.enabled_level), (True, False, True))

    def with_timing(self, timing: str, *, has_ramps: bool) -> Self:
        """
        Return the same for a motor of that *timing*, whose interrupt may do more within a pulse.
        """
        if timing != "wide-compare":
            return self
        longer = _LONGER_ON_A_RAMP_CYCLES if has_ramps else _LONGER_AT_COMPARE_CYCLES
        return replace(self, longest_high=self.high + longer)

    def wake_cycles(self, timing: str) -> int:
        """
        Return how long the first interval from rest must be asked for, 0 where any will do.
        """
        if self.enabled_level is None or self.enable <= _NEVER_SHORTER_CYCLES[timing]:
            return 0
        return self.enable + _WAKE_MARGIN_CYCLES


def pulse_facts(drive: Any, f_cpu_hz: int) -> PulseFacts:  # noqa: ANN401 - a step-dir drive
    """
    Return what the driver of *drive* asks for; times that the spec gives win.
    """
    known = DRIVERS[drive.driver.lower()] if drive.driver else None

    def at_least(field: str) -> int:
        given: float | None = getattr(drive.times, f"{field}_us")
        nanoseconds: int = getattr(known.times, f"{field}_ns") if known else 0
        if given is not None:
            nanoseconds = round(given * 1000)
        return -(-nanoseconds * f_cpu_hz // _NS_IN_A_SECOND)

    is_low = not drive.enable or drive.enable.active != "high"
    high = at_least("step_high")
    return PulseFacts(
        high=high,
        longest_high=high + _LONGER_CYCLES,
        low=at_least("step_low"),
        setup=at_least("dir_setup"),
        hold=at_least("dir_hold"),
        enable=at_least("enable"),
        enabled_level=not is_low if drive.enable or drive.socket else None,
    )

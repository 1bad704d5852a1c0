"""
The 16-bit timers in fast PWM mode 15 and CTC, timers that run through, the datasheet's way.

Sources: ATmega328P and ATmega2560 datasheets, "16-bit Timer/Counter", sections "Fast PWM
Mode", "Timer/Counter Timing Diagrams" and "Using the Output Compare Unit", and
"Timer/Counter0 and Timer/Counter1 Prescalers", "Internal Clock Source".
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

from stepgen.reference.contract import TimingKind

PRESCALERS = (1, 8, 64, 256, 1024)
COMPARE_PRESCALER = 8
COUNTER_STATES = 65_536
HALF_ROUND_CYCLES = COUNTER_STATES // 2
LAP_CYCLES = COUNTER_STATES // 4
FRACTIONS = 256  # of a clock, in the intervals of an axis
SLOWEST_CYCLES = 65_535 * 1024
FASTEST_CYCLES = 4  # mode 15 has at least 2 bits: OCRnA = 3 is the smallest TOP


@dataclass(frozen=True)
class TimerSetting:
    """
    A prescaler and the number of timer ticks in one period.

    Args:
        prescaler: CPU cycles in one timer tick: 1, 8, 64, 256 or 1024.
        period_ticks: Timer ticks between two steps; of fast PWM, between two overflows, 1 to 65535.
    """

    prescaler: int
    period_ticks: int

    @property
    def top(self) -> int:
        """
        Return OCRnA: the counter shows 0 to TOP, which are TOP + 1 values.
        """
        return self.period_ticks - 1

    @property
    def period_cycles(self) -> int:
        """
        Return the CPU cycles between two overflows: prescaler * (TOP + 1).
        """
        return self.prescaler * self.period_ticks


def timer_setting(virtual_cycles: int) -> TimerSetting:
    """
    Return the setting for *virtual_cycles* between two steps, 1 to 65535 * 1024.

    The smallest prescaler p with virtual_cycles // p < 65536; the remainder is truncated:
    period = p * (virtual_cycles // p).

    Raises:
        ValueError: Out of range.
    """
    if not 1 <= virtual_cycles <= SLOWEST_CYCLES:
        raise ValueError(f"{virtual_cycles} cycles are not within 1 to {SLOWEST_CYCLES}")
    fitting = (p for p in PRESCALERS if virtual_cycles // p < COUNTER_STATES)
    prescaler = next(fitting)
    return TimerSetting(prescaler, virtual_cycles // prescaler)


def through_running_setting(virtual_cycles: int) -> TimerSetting:
    """
    Return the setting of the timing ``compare`` for *virtual_cycles*, 8 to 65535 * 1024.

    Its timer has one prescaler for all speeds, 8, and counts as many ticks as the period has; the
    remainder is truncated. That the counter has 8 bits shows nowhere: steps are due at multiples of
    the period after the first, whose ticks are counted like those of any timer.

    Raises:
        ValueError: Out of range.
    """
    if not COMPARE_PRESCALER <= virtual_cycles <= SLOWEST_CYCLES:
        raise ValueError(f"{virtual_cycles} cycles are not within 8 to {SLOWEST_CYCLES}")
    return TimerSetting(COMPARE_PRESCALER, virtual_cycles // COMPARE_PRESCALER)


def unscaled_setting(virtual_cycles: int) -> TimerSetting:
    """
    Return the setting of timing ``compare`` on a 16-bit timer, for 1 clock or more.

    There is no prescaler, so nothing is cut off: each interval has as many clocks as it was given.
    Its laps are counted, so that the counter sets no limit; the spec does.

    Raises:
        ValueError: Less than 1.
    """
    if virtual_cycles < 1:
        raise ValueError(f"{virtual_cycles} cycles are less than 1")
    return TimerSetting(1, virtual_cycles)


def first_match_cycles(interval_cycles: int) -> int:
    """
    Return how long after a step its channel on a 16-bit timer matches next.

    Up to 32 767 clocks that is the next step. From there on the matches lie 16 384 clocks apart,
    counted back from the next step, and the first comes 16 384 clocks after the step or later.
    """
    if interval_cycles < HALF_ROUND_CYCLES:
        return interval_cycles
    return LAP_CYCLES + interval_cycles % LAP_CYCLES


SETTINGS: Mapping[TimingKind, Callable[[int], TimerSetting]] = MappingProxyType(
    {
        "fast-pwm": timer_setting,
        "ctc": timer_setting,
        "compare": through_running_setting,
        "wide-compare": unscaled_setting,
    }
)
"""What each timing makes of a virtual value."""


def first_tick_cycle(clock_on_cycle: int, prescaler: int) -> int:
    """
    Return when the counter first counts after its clock was selected at *clock_on_cycle*.

    The prescaler is a counter that runs free from reset, so its taps give a tick at each
    multiple of the prescaler in absolute cycles; the first one strictly after the write.
    """
    return (clock_on_cycle // prescaler + 1) * prescaler


def first_overflow_cycle(clock_on_cycle: int, tcnt: int, setting: TimerSetting) -> int:
    """
    Return when TOV, in CTC OCFnA, is set first after the clock was selected with *tcnt*.

    With f the first tick: the counter shows tcnt + 1 from f on, tcnt + n from
    f + (n - 1) * p on, hence TOP from f + (TOP - tcnt - 1) * p on. One tick later, at
    f + (TOP - tcnt) * p, it goes from TOP to BOTTOM, and in fast PWM this same edge sets TOV
    and loads OCRnA from its buffer (timing diagrams "no Prescaling" and "with Prescaler":
    TOVn rises where TCNTn goes from TOP to BOTTOM). From then on one period is TOP + 1 ticks.

    A counter at or past TOP misses it: a write of TCNT blocks the compare match of the
    next tick ("do not write the TCNT1 equal to TOP in PWM modes with variable TOP values [...]
    the counter will continue to 0xFFFF"). It then rolls over without TOV, which mode 15
    sets at TOP only, and needs 65536 ticks more.

    Args:
        clock_on_cycle: The cycle of the write to TCCRnB.
        tcnt: What the counter holds then, 0 to 65535.
        setting: Prescaler and TOP in force.
    """
    ticks_below_top = setting.top - tcnt
    if ticks_below_top <= 0:
        ticks_below_top += COUNTER_STATES
    first = first_tick_cycle(clock_on_cycle, setting.prescaler)
    return first + ticks_below_top * setting.prescaler

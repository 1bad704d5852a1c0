"""
Rates: from steps per second, RPM or a virtual value to the timer's registers and back.

Source: system 1, chapter 6 (the calculator) and chapter 8 (RPM against TOP).
"""

from dataclasses import dataclass
from fractions import Fraction

from stepgen.errors import StepgenError
from stepgen.plan.timings.fast_pwm import LARGEST_PERIOD_CYCLES, choose_setting
from stepgen.units import (
    SECONDS_PER_MINUTE,
    deviation_ppm,
    steps_per_second,
    turns_per_minute,
)

SMALLEST_PERIOD_CLOCKS = 640
"""Shortest period of any library: 25 000 steps/s at 16 MHz. One with several motors needs more."""

CLKPR_DIVIDERS = (1, 2, 4, 8, 16, 32, 64, 128, 256)
TABLE_VIRTUALS_CLOCKS = range(1_000, 51_001, 1_000)
_LARGEST_F_CPU_HZ = 20_000_000
_PPM_PER_PERCENT = 10_000


@dataclass(frozen=True)
class Clock:
    """
    What turns I/O clocks into seconds, and steps into turns.

    Args:
        f_cpu_hz: The oscillator.
        clkpr: The divider in the CLKPR register: 1, 2, 4 ... 256.
        steps_per_turn: Steps in one turn of the shaft, above 0.

    Raises:
        StepgenError: No clock that an AVR can have, or no steps in a turn.
    """

    f_cpu_hz: int = 16_000_000
    clkpr: int = 1
    steps_per_turn: Fraction = Fraction(200)

    def __post_init__(self) -> None:
        if not 1 <= self.f_cpu_hz <= _LARGEST_F_CPU_HZ:
            raise StepgenError.of(
                f"the oscillator is from 1 to {_LARGEST_F_CPU_HZ} Hz; most boards "
                "have 16000000, a Pro Mini of 3.3 V has 8000000",
                text=str(self.f_cpu_hz),
            )
        if self.clkpr not in CLKPR_DIVIDERS:
            known = ", ".join(map(str, CLKPR_DIVIDERS))
            raise StepgenError.of(
                f"CLKPR divides by {known} only; the Arduino core leaves it at 1",
                text=str(self.clkpr),
            )
        if self.steps_per_turn <= 0:
            raise StepgenError.of("a turn has more than 0 steps", text=str(self.steps_per_turn))

    @property
    def io_hz(self) -> Fraction:
        """
        Return the I/O clocks in a second: oscillator / CLKPR divider.
        """
        return Fraction(self.f_cpu_hz, self.clkpr)

    def rate_sps(self, period_clocks: int) -> Fraction:
        """
        Return the rate of one step each *period_clocks*.
        """
        return steps_per_second(self.f_cpu_hz, period_clocks * self.clkpr)

    def rpm(self, rate_sps: Fraction) -> Fraction:
        """
        Return *rate_sps* in turns per minute.
        """
        return turns_per_minute(rate_sps, self.steps_per_turn)

    def rate_of_rpm(self, rpm: Fraction) -> Fraction:
        """
        Return the rate in steps per second at *rpm*.
        """
        return rpm * self.steps_per_turn / SECONDS_PER_MINUTE


@dataclass(frozen=True)
class Rate:
    """
    A wanted rate and what the timer makes of it.

    Args:
        wanted_sps: The wanted rate; in whole steps where ``motorTimerCalcPerSecond`` counts so.
        wanted_rpm: The RPM that were asked for, or None.
        virtual_clocks: The virtual timer TOP: I/O clocks between two steps.
        prescaler: The timer's prescaler.
        timer_value: Timer ticks in one period, as the source counts its TOP.
        compare: What the compare register OCRnA gets: timer_value - 1.
        period_clocks: The period on the wire, prescaler * timer_value.
        real_sps: The rate of that period.
        deviation_percent: real_sps against wanted_sps.
        rpm: real_sps in turns per minute.
        rpm_deviation_percent: rpm against wanted_rpm, or None.
        turns_per_second: real_sps in turns per second.
    """

    wanted_sps: Fraction
    wanted_rpm: Fraction | None
    virtual_clocks: int
    prescaler: int
    timer_value: int
    compare: int
    period_clocks: int
    real_sps: Fraction
    deviation_percent: Fraction
    rpm: Fraction
    rpm_deviation_percent: Fraction | None
    turns_per_second: Fraction

    @property
    def interval_percent(self) -> Fraction:
        """
        Return the real interval in percent of the virtual value.
        """
        return Fraction(100 * self.period_clocks, self.virtual_clocks)

    @property
    def call(self) -> str:
        """
        Return the call of ``motorSetSpeed`` as C++ text to paste.
        """
        return f"motorSetSpeed(MOTOR_CTRL_DRV_EN, {self.virtual_clocks}UL);"


def rate_of_virtual(
    virtual_clocks: int,
    clock: Clock,
    wanted_sps: Fraction | None = None,
    wanted_rpm: Fraction | None = None,
) -> Rate:
    """
    Return what the timer makes of *virtual_clocks* I/O clocks between two steps.

    Raises:
        StepgenError: Below 640 or above 65535 * 1024 clocks.
    """
    check_period(virtual_clocks, clock)
    setting = choose_setting(virtual_clocks)
    real_sps = clock.rate_sps(setting.period_cycles)
    wanted = clock.rate_sps(virtual_clocks) if wanted_sps is None else wanted_sps
    rpm = clock.rpm(real_sps)
    return Rate(
        wanted_sps=wanted,
        wanted_rpm=wanted_rpm,
        virtual_clocks=virtual_clocks,
        prescaler=setting.prescaler,
        timer_value=setting.top + 1,
        compare=setting.top,
        period_clocks=setting.period_cycles,
        real_sps=real_sps,
        deviation_percent=deviation_ppm(real_sps, wanted) / _PPM_PER_PERCENT,
        rpm=rpm,
        rpm_deviation_percent=wanted_rpm and deviation_ppm(rpm, wanted_rpm) / _PPM_PER_PERCENT,
        turns_per_second=real_sps / clock.steps_per_turn,
    )


def rate_of_steps(wanted_sps: Fraction, clock: Clock, wanted_rpm: Fraction | None = None) -> Rate:
    """
    Return the timer's rate for *wanted_sps*: virtual value = I/O clock // wanted_sps.

    Raises:
        StepgenError: Too fast or too slow for the timer.
    """
    return rate_of_virtual(virtual_of(wanted_sps, clock), clock, wanted_sps, wanted_rpm)


def rates_of_rpm(wanted_rpm: Fraction, clock: Clock) -> tuple[Rate, ...]:
    """
    Return the rate as ``motorTimerCalcPerSecond`` makes it and, where it differs, the exact one.

    That function takes whole steps per second: 10 RPM at 200 steps are 33, not 33.3. Below one
    step a second it is no help, and only the exact rate is returned.

    Raises:
        StepgenError: Too fast or too slow for the timer.
    """
    exact_sps = clock.rate_of_rpm(wanted_rpm)
    whole_sps = Fraction(int(exact_sps))
    rates = sorted({exact_sps, whole_sps} - {Fraction(0)})
    return tuple(rate_of_steps(rate_sps, clock, wanted_rpm) for rate_sps in rates)


def virtual_of(rate_sps: Fraction, clock: Clock) -> int:
    """
    Return the virtual value of a rate, I/O clock // rate, the remainder dropped.

    Raises:
        StepgenError: Not above 0, or out of the timer's range.
    """
    if rate_sps <= 0:
        raise StepgenError.of(f"a speed is above 0; {_range(clock)}")
    virtual_clocks = int(clock.io_hz // rate_sps)
    check_period(virtual_clocks, clock)
    return virtual_clocks


def check_period(virtual_clocks: int, clock: Clock) -> None:
    """
    Refuse a virtual value that no library can take.

    Raises:
        StepgenError: Below 640 or above 65535 * 1024 clocks.
    """
    if virtual_clocks < SMALLEST_PERIOD_CLOCKS:
        raise StepgenError.of(
            f"{virtual_clocks} clocks between two steps are too fast; the smallest period is "
            f"{SMALLEST_PERIOD_CLOCKS} clocks: {_range(clock)}"
        )
    if virtual_clocks > LARGEST_PERIOD_CYCLES:
        raise StepgenError.of(
            f"{virtual_clocks} clocks between two steps are too slow; the largest period is "
            f"{LARGEST_PERIOD_CYCLES} clocks: {_range(clock)}"
        )


def _range(clock: Clock) -> str:
    slowest_sps = clock.rate_sps(LARGEST_PERIOD_CYCLES)
    fastest_sps = clock.rate_sps(SMALLEST_PERIOD_CLOCKS)
    return (
        f"choose from {float(slowest_sps):.4g} to {float(fastest_sps):.6g} steps/s, "
        f"{float(clock.rpm(slowest_sps)):.4g} to {float(clock.rpm(fastest_sps)):.6g} RPM"
    )

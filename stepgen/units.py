"""
Units of the field: hertz, CPU cycles, timer ticks, steps, and their conversions.
"""

from fractions import Fraction

MILLISECONDS_PER_SECOND = 1_000
MICROSECONDS_PER_SECOND = 1_000_000
SECONDS_PER_MINUTE = 60


def steps_per_second(f_cpu_hz: int, period_cycles: int) -> Fraction:
    """
    Return the exact step rate of one step each *period_cycles*, 1 or more.
    """
    return Fraction(f_cpu_hz, period_cycles)


def turns_per_minute(rate_sps: Fraction, steps_per_turn: Fraction) -> Fraction:
    """
    Return the speed in RPM of *rate_sps* with *steps_per_turn* steps in one turn.
    """
    return rate_sps / steps_per_turn * SECONDS_PER_MINUTE


def deviation_ppm(real: Fraction, wanted: Fraction) -> Fraction:
    """
    Return how far *real* is from *wanted*, in parts per million of *wanted* (not 0).
    """
    return (real - wanted) / wanted * 1_000_000

"""
The physics the user asked for, and how far the integer model may be from it.

At a fixed speed the ideal motor makes one step each v / f_cpu seconds, exactly. The timer's
period is p * (v // p) cycles with the prescaler p: never longer than v, and less than p
cycles shorter. After k intervals it is thus ahead by k * (v mod p) cycles, less than k * p.
"""

from fractions import Fraction

from stepgen.units import steps_per_second


def ideal_rate_sps(f_cpu_hz: int, virtual_cycles: int) -> Fraction:
    """
    Return the rate that was asked for: f_cpu / v steps per second.
    """
    return steps_per_second(f_cpu_hz, virtual_cycles)


def ideal_step_cycles(intervals: int, virtual_cycles: int) -> int:
    """
    Return how many cycles *intervals* ideal intervals last: k * v.
    """
    return intervals * virtual_cycles


def ideal_step_seconds(intervals: int, virtual_cycles: int, f_cpu_hz: int) -> Fraction:
    """
    Return how many seconds *intervals* ideal intervals last: k * v / f_cpu.
    """
    return Fraction(ideal_step_cycles(intervals, virtual_cycles), f_cpu_hz)


def lead_bound_cycles(intervals: int, prescaler: int) -> int:
    """
    Return k * p: the real step is never late and less than this early after k >= 1 intervals.

    Measured from a step (or from any overflow of the timer).
    """
    return intervals * prescaler


def lead_bound_from_start_cycles(intervals: int, prescaler: int) -> int:
    """
    Return (k + 1) * p: the same, measured from the moment the clock was switched on at 0.

    The prescaler runs free, so that the first tick comes 1 to p cycles after the clock is on and
    the first interval is up to p - 1 cycles shorter than a period.
    """
    return (intervals + 1) * prescaler


def ideal_halvings_cycles(modification: int, updates: int) -> Fraction:
    """
    Return the sum of n >= 1 changes m, m / 2, m / 4 ...: m * (2 - 2^(1 - n)).

    The integer model truncates each halving: what it has after k of them is less than 1 below
    m / 2^k, so that its sum is never more than this one and at most n - 1 less.
    """
    return modification * (2 - Fraction(2, 2**updates))

"""
The Arduino core's clock: what millis() returns.

Source: ``wiring.c`` of the Arduino AVR core, the constants MILLIS_INC, FRACT_INC and FRACT_MAX.
"""

_OVERFLOW_CYCLES = 64 * 256  # timer 0 counts 256 ticks of 64 clocks


def millis_after(overflows: int, f_cpu_hz: int) -> int:
    """
    Return the milliseconds that the core has counted after *overflows* of timer 0.

    An overflow lasts u = 64 * 256 / (f_cpu / 1 MHz) microseconds: u // 1000 milliseconds, and
    u % 1000 // 8 of the 125 parts that make one more as soon as they are together. At 16 MHz u
    is 1024, so millis() goes on by 1, now and then by 2; at 8 MHz u is 2048, and it goes on by
    2, now and then by 3.
    """
    microseconds = _OVERFLOW_CYCLES // (f_cpu_hz // 1_000_000)
    whole, rest = divmod(microseconds, 1000)
    return overflows * whole + overflows * (rest // 8) // 125

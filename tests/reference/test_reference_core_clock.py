"""
The core's milliseconds, against overflows added up by hand from wiring.c.
"""

from fractions import Fraction

import pytest

from stepgen.reference.core_clock import millis_after


@pytest.mark.parametrize(
    ("overflows", "milliseconds"),
    [
        (0, 0),
        (1, 1),  # 1.024 ms: MILLIS_INC 1, FRACT_INC 3 of FRACT_MAX 125
        (41, 41),  # 41 * 3 = 123 parts
        (42, 43),  # 126 parts: one millisecond more, and 1 part is left
        (83, 84),  # 1 + 41 * 3 = 124 parts
        (84, 86),  # 127 parts
        (125, 128),  # 125 * 1.024 ms
        (125_000, 128_000),
    ],
)
def test_milliseconds_at_16_mhz(overflows: int, milliseconds: int) -> None:
    """
    An overflow is 1 ms, and of each 41 or 42 one is 2.
    """
    assert millis_after(overflows, 16_000_000) == milliseconds


@pytest.mark.parametrize(
    ("overflows", "milliseconds"),
    [
        (0, 0),
        (1, 2),  # 2.048 ms: MILLIS_INC 2, FRACT_INC 6 of FRACT_MAX 125
        (20, 40),  # 20 * 6 = 120 parts
        (21, 43),  # 126 parts: one millisecond more, and 1 part is left
        (41, 83),  # 1 + 20 * 6 = 121 parts
        (42, 86),  # 127 parts
        (125, 256),  # 125 * 2.048 ms
        (125_000, 256_000),
    ],
)
def test_milliseconds_at_8_mhz(overflows: int, milliseconds: int) -> None:
    """
    An overflow is 2 ms, and of each 20 or 21 one is 3.
    """
    assert millis_after(overflows, 8_000_000) == milliseconds


@pytest.mark.parametrize(("f_cpu_hz", "whole_ms"), [(16_000_000, 1), (8_000_000, 2)])
def test_a_limit_ends_within_a_jump_of_the_clock(f_cpu_hz: int, whole_ms: int) -> None:
    """
    A limit is off by an overflow and 1 ms early at most, or by an overflow's whole ms late.

    Early if it starts just before an overflow, when the clock is behind by that and by all but
    what makes a millisecond. Late if it starts just behind one, and ends one ms past its end
    or, at 8 MHz, with a jump of 3 ms, two. The overflows repeat after 125.
    """
    overflow_ms = Fraction(64 * 256 * 1000, f_cpu_hz)
    errors = []
    for start in range(1, 126):
        for counted in (start - 1, start):
            for limit in range(1, 60):
                end = start
                while millis_after(end, f_cpu_hz) - millis_after(counted, f_cpu_hz) < limit:
                    end += 1
                errors.append((end - start) * overflow_ms - limit)

    assert -overflow_ms - 1 < min(errors) < -whole_ms - 1
    assert whole_ms - 0.1 < max(errors) < whole_ms + 0.1

"""
The planner's timer settings, against arithmetic done by hand from the datasheet.
"""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from stepgen.plan.timings.fast_pwm import LARGEST_PERIOD_CYCLES, choose_setting


@pytest.mark.parametrize(
    ("period_cycles", "prescaler", "timer_value"),
    [
        # The source's calculator (systems/1-motor-driver.md): TOP + 1 is its "timer value".
        (88_888, 8, 11_111),  # 180 steps/s
        (484_848, 8, 60_606),  # 33 steps/s
        (926_533, 64, 14_477),  # 926533 / 64 = 14477.08
        # Either side of each prescaler's largest value, 65535.
        (65_535, 1, 65_535),
        (65_536, 8, 8_192),
        (524_287, 8, 65_535),  # 524287 / 8 = 65535.9
        (524_288, 64, 8_192),
        (4_194_303, 64, 65_535),
        (4_194_304, 256, 16_384),
        (16_777_215, 256, 65_535),
        (16_777_216, 1024, 16_384),
        # The ends of the range: mode 15 needs TOP 1 at least, and 65535 * 1024 is the most.
        (2, 1, 2),
        (640, 1, 640),  # 25 000 steps/s at 16 MHz
        (67_107_840, 1024, 65_535),
    ],
)
def test_the_finest_setting_is_taken(period_cycles: int, prescaler: int, timer_value: int) -> None:
    """
    The smallest prescaler that fits 16 bits is taken, and TOP is one less than the ticks.
    """
    setting = choose_setting(period_cycles)

    assert (setting.prescaler, setting.top) == (prescaler, timer_value - 1)


@pytest.mark.parametrize("period_cycles", [-1, 0, 1, 67_107_841])
def test_what_no_timer_can_do_is_refused(period_cycles: int) -> None:
    """
    Below two ticks and beyond 4.19 s at 16 MHz there is no setting.
    """
    with pytest.raises(ValueError, match="are not within 2 to 67107840"):
        choose_setting(period_cycles)


@given(st.integers(2, LARGEST_PERIOD_CYCLES))
def test_a_period_is_never_longer_than_asked_for(period_cycles: int) -> None:
    """
    The remainder is dropped: the real period is shorter by less than one tick.
    """
    setting = choose_setting(period_cycles)

    assert 0 <= period_cycles - setting.period_cycles < setting.prescaler
    assert 1 <= setting.top <= 65_534

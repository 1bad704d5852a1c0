"""
Timer arithmetic against literals of the datasheet and the source's calculator.
"""

from collections.abc import Callable

import pytest

from stepgen.reference.facts import MotorFacts
from stepgen.reference.sequences import coils_off, phases
from stepgen.reference.timer import (
    TimerSetting,
    first_overflow_cycle,
    first_tick_cycle,
    through_running_setting,
    timer_setting,
)


@pytest.mark.parametrize(
    ("virtual_cycles", "prescaler", "period_ticks", "period_cycles"),
    [
        (640, 1, 640, 640),
        (65_535, 1, 65_535, 65_535),
        (65_536, 8, 8192, 65_536),
        (88_888, 8, 11_111, 88_888),  # 180 steps/s, source's calculator
        (484_848, 8, 60_606, 484_848),  # 10 RPM, source's calculator
        (524_287, 8, 65_535, 524_280),
        (524_288, 64, 8192, 524_288),
        (926_533, 64, 14_477, 926_528),  # source's calculator
        (4_194_303, 64, 65_535, 4_194_240),
        (4_194_304, 256, 16_384, 4_194_304),
        (16_777_215, 256, 65_535, 16_776_960),
        (16_777_216, 1024, 16_384, 16_777_216),
        (67_107_840, 1024, 65_535, 67_107_840),
    ],
)
def test_smallest_prescaler_that_fits(
    virtual_cycles: int, prescaler: int, period_ticks: int, period_cycles: int
) -> None:
    """
    The smallest prescaler with v / p < 65536 is taken and the remainder truncated.
    """
    setting = timer_setting(virtual_cycles)

    assert (setting.prescaler, setting.period_ticks) == (prescaler, period_ticks)
    assert (setting.top, setting.period_cycles) == (period_ticks - 1, period_cycles)


@pytest.mark.parametrize("virtual_cycles", [0, -1, 67_107_841])
def test_values_outside_the_range_have_no_setting(virtual_cycles: int) -> None:
    """
    Nothing is set for 0 or beyond 65535 * 1024 cycles.
    """
    with pytest.raises(ValueError, match="not within 1 to 67107840"):
        timer_setting(virtual_cycles)


@pytest.mark.parametrize(
    ("clock_on_cycle", "prescaler", "tick_cycle"),
    [(0, 1, 1), (7, 1, 8), (7, 8, 8), (8, 8, 16), (1023, 1024, 1024), (1024, 1024, 2048)],
)
def test_ticks_are_multiples_of_the_prescaler(
    clock_on_cycle: int, prescaler: int, tick_cycle: int
) -> None:
    """
    The first tick is the next multiple of the prescaler strictly after the write.
    """
    assert first_tick_cycle(clock_on_cycle, prescaler) == tick_cycle


@pytest.mark.parametrize(
    ("tcnt", "overflow_cycle"),
    [
        # v = 80, TOP = 79, p = 1, clock on at 0, first tick at 1: 0 -> 1 at 1, 79 -> 0 at 80.
        (0, 80),
        (78, 2),  # 78 -> 79 at 1, 79 -> 0 at 2
        (79, 65_537),  # blocked: 79 -> 80 at 1, 65535 -> 0 at 65457, 79 -> 0 at 65537
        (80, 65_536),  # past it: 80 -> 81 at 1, 65535 -> 0 at 65456, 79 -> 0 at 65536
        (65_535, 81),  # 65535 -> 0 at 1 without TOV, 79 -> 0 at 81
    ],
)
def test_overflow_is_the_tick_from_top_to_bottom(tcnt: int, overflow_cycle: int) -> None:
    """
    TOV rises with the tick that takes the counter from TOP to 0; at or past TOP it misses.
    """
    assert first_overflow_cycle(0, tcnt, timer_setting(80)) == overflow_cycle


@pytest.mark.parametrize(
    ("setting", "slowest"),
    [
        (timer_setting, TimerSetting(1024, 65_535)),
        (through_running_setting, TimerSetting(8, 8_388_480)),
    ],
)
def test_the_range_of_virtual_values_ends_where_it_says(
    setting: Callable[[int], TimerSetting], slowest: TimerSetting
) -> None:
    """
    A tick of the finest prescaler is the fastest, 65535 * 1024 cycles the slowest.
    """
    prescaler = slowest.prescaler if setting is through_running_setting else 1

    assert setting(prescaler) == TimerSetting(prescaler, 1)
    assert setting(65_535 * 1024) == slowest
    for beyond in (prescaler - 1, 65_535 * 1024 + 1):
        with pytest.raises(ValueError, match="not within"):
            setting(beyond)


@pytest.mark.parametrize("cycles", [4, 65_535 * 1024])
def test_the_least_virtual_value_can_be_at_either_end(cycles: int) -> None:
    """
    Mode 15 has a TOP of 3 at least; one beyond either end is refused.
    """
    coils = (phases("four-wire", "full"), coils_off("four-wire"))

    assert MotorFacts(*coils, cycles, "hold").minimum_cycles == cycles
    with pytest.raises(ValueError, match="out of range"):
        MotorFacts(*coils, 3 if cycles == 4 else cycles + 1, "hold")

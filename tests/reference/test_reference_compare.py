"""
Traces of a motor on timer 2, derived by hand from the datasheet and the contract.

In every derivation: n the period in ticks of 8 cycles, n = v / 8 cut off, f the first tick, which
is the next multiple of 8 after the clock was switched on. The counter has left as many values as
there were ticks, so the n-th tick, at f + (n - 1) * 8, ends the first interval; then n * 8 each.
"""

import pytest

from stepgen.reference.facts import MotorFacts
from stepgen.reference.prediction import predict
from stepgen.reference.sequences import coils_off, phases
from stepgen.reference.stimuli import ClockOn, SetSpeed, Stimulus
from stepgen.reference.timer import through_running_setting

FACTS = MotorFacts(
    phases("four-wire", "full"), coils_off("four-wire"), 2048, "hold", timing="compare"
)


def _steps(stimuli: list[Stimulus], until_cycle: int) -> list[int]:
    edges = predict(FACTS, stimuli, until_cycle).edges
    return [edge.deadline_cycle for edge in edges if edge.kind == "step"]


@pytest.mark.parametrize(
    ("virtual_cycles", "clock_on", "deadline_cycles"),
    [
        # n = 256. f = 1008; 1008 + 255 * 8 = 3048; then 2048 each.
        (2_048, 1_001, [3_048, 5_096, 7_144]),
        # 20003 / 8 = 2500.4, n = 2500. f = 1008; 1008 + 2499 * 8 = 21000; then 20000 each.
        (20_003, 1_007, [21_000, 41_000]),
        # The clock comes on with a tick, at 1008: that tick is gone, f = 1016.
        (20_003, 1_008, [21_008, 41_008]),
        # The slowest: n = 65535 * 128 = 8388480. 1008 + 8388479 * 8 = 67108840; then 67107840.
        (67_107_840, 1_001, [67_108_840, 134_216_680]),
    ],
)
def test_steps_come_with_whole_ticks_of_8_cycles(
    virtual_cycles: int, clock_on: int, deadline_cycles: list[int]
) -> None:
    """
    Every speed has the same prescaler, and the laps of the 8-bit counter show nowhere.
    """
    stimuli: list[Stimulus] = [SetSpeed(1000, 0x80, virtual_cycles), ClockOn(clock_on, 8, 0)]

    assert _steps(stimuli, deadline_cycles[-1]) == deadline_cycles


def test_a_change_of_speed_begins_with_the_next_step() -> None:
    """
    The interval in progress ends as it was; nothing sets the timer, whatever the two speeds are.
    """
    # n = 2500: 21000, 41000. The call at 41001 lets 61000 be; n = 300000 / 8 = 37500: 361000.
    stimuli: list[Stimulus] = [
        SetSpeed(1000, 0x80, 20_000),
        ClockOn(1_001, 8, 0),
        SetSpeed(41_001, 0x80, 300_007),
    ]

    assert _steps(stimuli, 661_000) == [21_000, 41_000, 61_000, 361_000, 661_000]


@pytest.mark.parametrize("virtual_cycles", [0, 7, 65_535 * 1024 + 1])
def test_a_period_out_of_range_has_no_setting(virtual_cycles: int) -> None:
    """
    At least one tick, and at most what fast PWM can do.
    """
    with pytest.raises(ValueError, match="not within 8 to 67107840"):
        through_running_setting(virtual_cycles)

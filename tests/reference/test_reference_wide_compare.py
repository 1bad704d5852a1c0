"""
Traces of a motor on a channel of a 16-bit timer, by hand from datasheet and contract.

In every derivation: v the period in cycles, of which none is cut off; the call sets the channel so
that it matches *ahead* cycles after the write. Up to v = 32 767 that match is the first step. From
32 768 on matches lie 16 384 cycles apart, counted back from the step, and the first comes
16 384 + v mod 16 384 cycles after the interval began.
"""

import pytest

from stepgen.reference.contract import Code
from stepgen.reference.facts import MotorFacts
from stepgen.reference.integer import MotorModel
from stepgen.reference.sequences import coils_off, phases
from stepgen.reference.stimuli import ChannelSet, SetSpeed, Stimulus
from stepgen.reference.timer import first_match_cycles, unscaled_setting

FACTS = MotorFacts(
    phases("four-wire", "full"),
    coils_off("four-wire"),
    200,
    "hold",
    timing="wide-compare",
    sees_passed=True,
    slowest_cycles=4_800_000_000,
)


def _steps(stimuli: list[Stimulus], until_cycle: int) -> list[int]:
    model = MotorModel(FACTS)
    for stimulus in stimuli:
        model.apply(stimulus)
    return [edge.deadline_cycle for edge in model.advance(until_cycle) if edge.kind == "step"]


@pytest.mark.parametrize(
    ("virtual_cycles", "ahead", "deadline_cycles"),
    [
        # Set at 1020: 1020 + 990 = 2010; then each 1000.
        (1_000, 990, [2_010, 3_010, 4_010]),
        # The longest without laps: 1020 + 32757 = 33777, 33777 + 32767 = 66544.
        (32_767, 32_757, [33_777, 66_544]),
        # 32768 = 16384 + 1 lap. First match 1020 + 16374 = 17394, step 16384 later: 33778.
        (32_768, 16_374, [33_778, 66_546]),
        # 100003 = 6 * 16384 + 1699: first 16384 + 1699 = 18083, then 5 laps, 81920.
        # Set 10 cycles after the start: 1020 + 18073 = 19093; 19093 + 81920 = 101013; + 100003.
        (100_003, 18_073, [101_013, 201_016]),
        # 65536 = 4 * 16384: first 16384, then 3 laps: 1020 + 16374 + 49152 = 66546; + 65536.
        (65_536, 16_374, [66_546, 132_082]),
        # The slowest, 65535 * 1024 = 67107840 = 4095 * 16384 + 15360: first 31744, 4094 laps.
        # 1020 + 31734 + 4094 * 16384 = 67108850.
        (67_107_840, 31_734, [67_108_850]),
        # A step each 300 s: 4800000000 = 292968 * 16384 + 12288: first 28672, then 292967 laps.
        # 1020 + 28662 + 292967 * 16384 = 4800001010; + 4800000000.
        (4_800_000_000, 28_662, [4_800_001_010, 9_600_001_010]),
    ],
)
def test_steps_come_with_whole_cycles(
    virtual_cycles: int, ahead: int, deadline_cycles: list[int]
) -> None:
    """
    No speed has a prescaler, and laps of the counter show nowhere.
    """
    stimuli: list[Stimulus] = [SetSpeed(1_000, 0x80, virtual_cycles), ChannelSet(1_020, ahead)]

    assert _steps(stimuli, deadline_cycles[-1]) == deadline_cycles


def test_a_change_of_speed_begins_with_the_next_step() -> None:
    """
    The interval in progress ends as it was, also where the new one has laps or the old one had.
    """
    # 1020 + 19990 = 21010, 41010. The call at 41011 lets 61010 be; then 300007 each: 361017. The
    # call at 361018 lets 661024 be; then 500 each.
    stimuli: list[Stimulus] = [
        SetSpeed(1_000, 0x80, 20_000),
        ChannelSet(1_020, 19_990),
        SetSpeed(41_011, 0x80, 300_007),
        SetSpeed(361_018, 0x80, 500),
    ]

    steps = _steps(stimuli, 662_024)

    assert steps == [21_010, 41_010, 61_010, 361_017, 661_024, 661_524, 662_024]


@pytest.mark.parametrize(
    ("set_cycle", "missed"),
    [
        (2_550, 0),  # the next step is due at 3010
        (3_009, 0),  # at the clock after that which sets the channel it matches
        (3_010, 1),  # that clock is gone
        (3_400, 1),
    ],
)
def test_a_step_that_is_due_before_its_channel_is_set_is_missed(
    set_cycle: int, missed: int
) -> None:
    """
    A channel matches from the clock after the one that sets it; a step that is due by then counts.
    """
    sets = {2_010: set_cycle}
    model = MotorModel(FACTS, set_cycle=lambda deadline: sets.get(deadline, deadline + 40))
    model.apply(SetSpeed(1_000, 0x80, 1_000))
    model.apply(ChannelSet(1_020, 990))

    steps = [edge.deadline_cycle for edge in model.advance(4_010)]

    assert steps[-3:] == [2_010, 3_010, 4_010]
    assert model.overruns == missed
    assert bool(model.status & 0x80) == bool(missed)


def test_a_long_interval_is_never_missed() -> None:
    """
    Its next match is that of a lap, which is served at once too, but makes no step.
    """
    model = MotorModel(FACTS, set_cycle=lambda deadline: deadline + 33_000)
    model.apply(SetSpeed(1_000, 0x80, 32_768))
    model.apply(ChannelSet(1_020, 16_374))

    model.advance(200_000)

    assert model.overruns == 0


@pytest.mark.parametrize(
    ("interval", "first"),
    [(100, 100), (32_767, 32_767), (32_768, 16_384), (32_769, 16_385), (49_151, 32_767)],
)
def test_the_first_match_of_an_interval_is_less_than_half_round(interval: int, first: int) -> None:
    """
    So that a match that has passed and one that is to come can be told apart.
    """
    assert first_match_cycles(interval) == first


def test_a_period_of_nothing_has_no_setting() -> None:
    """
    At least one cycle; how many at most, the spec says.
    """
    with pytest.raises(ValueError, match="0 cycles are less than 1"):
        unscaled_setting(0)


@pytest.mark.parametrize(
    ("virtual_cycles", "code"), [(4_800_000_000, Code.FINE), (4_800_000_001, Code.TOO_SLOW)]
)
def test_a_period_is_as_long_as_the_spec_says(virtual_cycles: int, code: Code) -> None:
    """
    300 s are 4.8e9 clocks, more than 32 bits hold; one clock more is refused.
    """
    assert MotorModel(FACTS).apply(SetSpeed(1_000, 0x80, virtual_cycles)) == code

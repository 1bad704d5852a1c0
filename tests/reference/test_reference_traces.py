"""
Traces of moving motors, derived by hand from the datasheet: they judge the integer model.

In every derivation: p the prescaler, n the period in timer ticks, TOP = n - 1, f the first
timer tick, which is the next multiple of p after the clock was switched on. TOV rises with the
tick from TOP to BOTTOM, at f + (TOP - TCNT) * p, and from then on each n * p cycles.
Coils A, B, C, D of four-wire full steps: 1100, 0110, 0011, 1001.
"""

from collections.abc import Iterable

import pytest

from stepgen.reference.contract import Status
from stepgen.reference.facts import MotorFacts
from stepgen.reference.integer import MotorModel
from stepgen.reference.prediction import predict
from stepgen.reference.sequences import coils_off, phases
from stepgen.reference.stimuli import ClockOn, Edge, MillisTick, SetSpeed, Stimulus

ULN_FULL = MotorFacts(phases("four-wire", "full"), coils_off("four-wire"), 640, "hold")
ULN_HALF = MotorFacts(phases("four-wire", "half"), coils_off("four-wire"), 640, "hold")
SHIELD_HALF = MotorFacts(phases("motor-shield", "half"), coils_off("motor-shield"), 640, "hold")


def _wires(edges: Iterable[Edge]) -> list[tuple[int, str]]:
    return [(edge.deadline_cycle, str(edge.pattern)) for edge in edges]


@pytest.mark.parametrize(
    ("virtual_cycles", "clock", "deadline_cycles"),
    [
        # p = 1, n = 16000, TOP = 15999. f = 1002; 1002 + 15999 = 17001; then 16000 each.
        (16_000, ClockOn(1001, 1, 0), [17_001, 33_001, 49_001]),
        # 88888 > 65535; 88888 / 8 = 11111 = n, TOP = 11110. f = 126 * 8 = 1008;
        # 1008 + 11110 * 8 = 1008 + 88880 = 89888; then 88888 each.
        (88_888, ClockOn(1003, 8, 0), [89_888, 178_776, 267_664]),
        # 926533 / 8 = 115816, too many; 926533 / 64 = 14477.08, n = 14477, TOP = 14476.
        # f = 16 * 64 = 1024; 1024 + 14476 * 64 = 1024 + 926464 = 927488; then 926528 each.
        (926_533, ClockOn(1001, 64, 0), [927_488, 1_854_016, 2_780_544]),
        # 4800000 / 64 = 75000, too many; 4800000 / 256 = 18750 = n, TOP = 18749.
        # f = 5 * 256 = 1280; 1280 + 18749 * 256 = 1280 + 4799744 = 4801024; then 4800000 each.
        (4_800_000, ClockOn(1025, 256, 0), [4_801_024, 9_601_024]),
        # The slowest: 65535 * 1024 = 67107840, n = 65535, TOP = 65534. f = 2 * 1024 = 2048;
        # 2048 + 65534 * 1024 = 2048 + 67106816 = 67108864; then 67107840 each.
        (67_107_840, ClockOn(1025, 1024, 0), [67_108_864, 134_216_704]),
        # The clock comes on with a prescaler tick, at 1024 = 16 * 64: that tick is gone, f = 1088;
        # 1088 + 14476 * 64 = 1088 + 926464 = 927552.
        (926_533, ClockOn(1024, 64, 0), [927_552, 1_854_080]),
    ],
)
def test_first_step_comes_one_interval_after_the_clock_is_on(
    virtual_cycles: int, clock: ClockOn, deadline_cycles: list[int]
) -> None:
    """
    From rest the coils go on at the call, and the steps come with the overflows of the timer.
    """
    stimuli: list[Stimulus] = [SetSpeed(1000, 0x80, virtual_cycles), clock]

    run = predict(ULN_FULL, stimuli, deadline_cycles[-1])

    patterns = ["1100", "0110", "0011", "1001"]
    expected = list(zip([1000, *deadline_cycles], patterns, strict=False))
    assert _wires(run.edges) == expected
    assert [edge.kind for edge in run.edges] == ["energise"] + ["step"] * len(deadline_cycles)
    assert run.status == Status.SPIN_FIXED


def test_one_step_move_makes_one_step_and_reports_it() -> None:
    """
    A limit of one step gives one step, REACHED with it, and nothing after it.
    """
    # p = 1, n = 1000, TOP = 999. f = 508; 508 + 999 = 1507. The next overflow, 2507, is no step.
    model = MotorModel(ULN_FULL)
    model.apply(SetSpeed(500, 0x80, 1000, 1))
    model.apply(ClockOn(507, 1, 0))

    before = model.advance(1506)
    assert (model.status, model.steps_left, model.running) == (Status.SPIN_FIXED, 1, True)
    at_the_step = model.advance(1507)
    assert (model.status, model.steps_left, model.running) == (Status.REACHED, 0, False)
    after = model.advance(100_000)

    assert _wires(before) == [(500, "1100")]
    assert _wires(at_the_step) == [(1507, "0110")]
    assert after == []


def test_reversal_while_running_acts_from_the_next_step() -> None:
    """
    A call with DIRECTION while running turns the step that ends the interval in progress.
    """
    # p = 1, n = 2000, TOP = 1999. f = 101; 101 + 1999 = 2100; then 4100, and, called at 5000,
    # backwards at 6100 and 8100, which is the second and last step of that call.
    stimuli: list[Stimulus] = [
        SetSpeed(50, 0x80, 2000),
        ClockOn(100, 1, 0),
        SetSpeed(5000, 0x81, 2000, 2),
    ]

    run = predict(ULN_FULL, stimuli, 50_000)

    assert [
        (edge.deadline_cycle, str(edge.pattern), edge.position, edge.call_index)
        for edge in run.edges
    ] == [
        (50, "1100", 0, 0),
        (2100, "0110", 1, 0),
        (4100, "0011", 2, 0),
        (6100, "0110", 1, 1),
        (8100, "1100", 0, 1),
    ]
    assert run.status == Status.REACHED


def test_faster_with_the_same_prescaler_acts_after_the_interval_in_progress() -> None:
    """
    The interval in progress ends as it was, and the new one is counted from that very step.
    """
    # p = 1, n = 16000, TOP = 15999. f = 1001; 1001 + 15999 = 17000; 33000. Called at 20000 with
    # n = 1000: 33000 is its first step (OCRnA loads at that BOTTOM), then 34000, 35000.
    stimuli: list[Stimulus] = [
        SetSpeed(900, 0x80, 16_000),
        ClockOn(1000, 1, 0),
        SetSpeed(20_000, 0x80, 1000, 3),
    ]

    run = predict(ULN_FULL, stimuli, 60_000)

    assert [edge.deadline_cycle for edge in run.edges] == [900, 17_000, 33_000, 34_000, 35_000]
    assert run.position == 4


def test_change_of_prescaler_counts_from_the_new_clock_and_its_preset() -> None:
    """
    Across prescalers the step ends the old interval and the preset counter paces the next one.
    """
    # p = 8, n = 11111, TOP = 11110. f = 1008; 1008 + 88880 = 89888.
    # Called with 16000: p = 1, TOP = 15999. The interrupt of 89888 starts the clock anew at
    # 89951, 63 cycles late, with 63 in the counter. f = 89952; 89952 + (15999 - 63) * 1 =
    # 89952 + 15936 = 105888, which is 89888 + 16000: nothing was lost.
    # Called with 88888 again: p = 8. The interrupt of 105888 starts the clock at 105951 with 7.
    # f = 13244 * 8 = 105952; 105952 + (11110 - 7) * 8 = 105952 + 88824 = 194776; + 88888 = 283664.
    stimuli: list[Stimulus] = [
        SetSpeed(1000, 0x80, 88_888),
        ClockOn(1003, 8, 0),
        SetSpeed(50_000, 0x80, 16_000),
        ClockOn(89_951, 1, 63),
        SetSpeed(100_000, 0x80, 88_888),
        ClockOn(105_951, 8, 7),
    ]

    run = predict(ULN_FULL, stimuli, 283_664)

    assert _wires(run.edges) == [
        (1000, "1100"),
        (89_888, "0110"),
        (105_888, "0011"),
        (194_776, "1001"),
        (283_664, "1100"),
    ]


def test_preset_at_top_costs_a_whole_turn_of_the_counter() -> None:
    """
    A counter preset to TOP misses its compare match and runs through 0xFFFF first.
    """
    # p = 1, n = 1000, TOP = 999. f = 101 shows 1000, since the write of TCNT blocks the match;
    # 0 follows 65535 at 101 + 64536 = 64637, TOP comes at 64637 + 999 = 65636, TOV at 65637.
    run = predict(ULN_FULL, [SetSpeed(50, 0x80, 1000), ClockOn(100, 1, 999)], 66_000)

    assert _wires(run.edges) == [(50, "1100"), (65_637, "0110")]


def test_preset_just_below_top_is_one_tick() -> None:
    """
    A counter preset to TOP - 1 needs a tick to TOP and one more to the overflow.
    """
    # p = 64, v = 640000, n = 10000, TOP = 9999. f = 2 * 64 = 128 shows 9999, 192 shows 0.
    run = predict(ULN_FULL, [SetSpeed(50, 0x80, 640_000), ClockOn(100, 64, 9998)], 200)

    assert _wires(run.edges) == [(50, "1100"), (192, "0110")]


def test_interrupt_pending_at_the_commit_belongs_to_the_new_call() -> None:
    """
    A step that is due before the commit but served after it goes in the new direction.
    """
    # p = 1, n = 1000, TOP = 999. f = 101; 1100, 2100. The second is served 40 cycles late, at
    # 2140, after the commit at 2120: it is the first of three backwards, with n = 1500 from 2100.
    late_cycles = {2100: 2140}
    stimuli: list[Stimulus] = [
        SetSpeed(50, 0x80, 1000),
        ClockOn(100, 1, 0),
        SetSpeed(2120, 0x81, 1500, 3),
    ]

    run = predict(ULN_FULL, stimuli, 20_000, lambda deadline: late_cycles.get(deadline, deadline))

    assert [(edge.deadline_cycle, edge.position) for edge in run.edges] == [
        (50, 0),
        (1100, 1),
        (2100, 0),
        (3600, -1),
        (5100, -2),
    ]


def test_half_steps_of_the_shield_switch_one_coil_off_in_between() -> None:
    """
    Backwards half-steps on the shield run the table from its end, every other one on one coil.
    """
    # p = 1, n = 640, TOP = 639. f = 11; 11 + 639 = 650, 1290, 1930. Coils (A, B): - - at rest,
    # then backwards - 0, - +, 0 +. Wires: enable A, enable B, DIR A, DIR B.
    stimuli: list[Stimulus] = [SetSpeed(5, 0x81, 640, 3), ClockOn(10, 1, 0)]

    run = predict(SHIELD_HALF, stimuli, 10_000)

    assert _wires(run.edges) == [(5, "1100"), (650, "100x"), (1290, "1101"), (1930, "01x1")]


def test_half_steps_of_four_wires_start_with_coil_a_alone() -> None:
    """
    Half-steps forward: coil A, A and B, B, B and C.
    """
    # p = 1, n = 700, TOP = 699. f = 21; 21 + 699 = 720, 1420, 2120.
    stimuli: list[Stimulus] = [SetSpeed(5, 0x80, 700, 3), ClockOn(20, 1, 0)]

    run = predict(ULN_HALF, stimuli, 10_000)

    assert _wires(run.edges) == [(5, "1000"), (720, "1100"), (1420, "0100"), (2120, "0110")]


def test_millis_limit_ends_when_the_core_skips_a_millisecond() -> None:
    """
    The carry of the core's 3/125 fraction ends a limit of 2 ms within one overflow of timer 0.
    """
    # Timer 0 overflows each 64 * 256 = 16384 cycles = 1.024 ms: millis + 1, fraction + 3; at 125
    # one more. Overflow 41 (41 * 16384 = 671744): fraction 123, millis 41. Overflow 42 (688128):
    # fraction 126 - 125 = 1, millis 43. The variable changes some 70 cycles after the overflow.
    # Start at 671850 with millis 41, limit 2: p = 1, n = 8000, TOP = 7999, f = 671901;
    # 671901 + 7999 = 679900: 41 - 41 < 2, step. 687900: step. 695900: 43 - 41 = 2: the end.
    stimuli: list[Stimulus] = [
        MillisTick(671_814, 41),
        SetSpeed(671_850, 0x84, 8000, 2),
        ClockOn(671_900, 1, 0),
        MillisTick(688_198, 43),
    ]

    run = predict(ULN_FULL, stimuli, 1_000_000)

    assert _wires(run.edges) == [(671_850, "1100"), (679_900, "0110"), (687_900, "0011")]
    assert (run.status, run.running, run.position) == (Status.REACHED, False, 2)

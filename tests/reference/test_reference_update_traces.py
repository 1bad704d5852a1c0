"""
Traces of update events, derived by hand from the datasheet and the contract.

As in test_reference_traces.py: p the prescaler, n the period in ticks, TOP = n - 1, f the first
tick after the clock was switched on; TOV at f + (TOP - TCNT) * p, then each n * p cycles.
Control bits: 0x80 DRV_EN, 0x40 SPEED_VARIABLE, 0x20 VARIABLE_PWR, 0x10 IRQ_TIMING,
0x08 UPDATE_STEPS, 0x04 ENDPOINT_MILLIS, 0x02 FASTER.
"""

import pytest

from stepgen.reference.facts import MotorFacts
from stepgen.reference.integer import MotorModel
from stepgen.reference.prediction import predict
from stepgen.reference.sequences import coils_off, phases
from stepgen.reference.stimuli import ClockOn, MillisTick, SetSpeed, Stimulus, UpdateCheck

HOLDS = MotorFacts(
    phases("four-wire", "full"), coils_off("four-wire"), 640, "hold", "update-events"
)
RELEASES = MotorFacts(
    phases("four-wire", "full"), coils_off("four-wire"), 640, "release", "update-events"
)


def _step_cycles(
    stimuli: list[Stimulus], until_cycle: int, late_cycles: dict[int, int] | None = None
) -> list[int]:
    late = late_cycles or {}
    run = predict(HOLDS, stimuli, until_cycle, lambda deadline: late.get(deadline, deadline))
    return [edge.deadline_cycle for edge in run.edges if edge.kind == "step"]


def test_an_event_across_prescalers() -> None:
    """
    The step after the event ends the old interval, and the new clock paces the next one.
    """
    # 88888: p = 8, n = 11111, TOP = 11110. f = 1008; 1008 + 88880 = 89888, 178776: two steps, the
    # event: 88888 - 72888 = 16000, p = 1, TOP = 15999. 178776 + 88888 = 267664 is as before; its
    # interrupt starts the clock at 267727 with 63. f = 267728; + 15999 - 63 = 283664, which is
    # 267664 + 16000; then 299664.
    model = MotorModel(HOLDS)
    model.apply(SetSpeed(1000, 0xDA, 88_888, 0, 72_888, 2, 1))
    model.apply(ClockOn(1003, 8, 0))

    edges = model.advance(178_775)
    assert (model.virtual_cycles, model.updates_left, model.status) == (88_888, 1, 0)
    edges += model.advance(178_776)
    assert (model.virtual_cycles, model.updates_left, model.status) == (16_000, 0, 0x40)
    model.apply(ClockOn(267_727, 1, 63))
    edges += model.advance(300_000)

    steps = [edge.deadline_cycle for edge in edges[1:]]
    assert steps == [89_888, 178_776, 267_664, 283_664, 299_664]


def test_two_events_in_succession_across_two_prescalers() -> None:
    """
    The clock that a step starts belongs to the event before it, not to one at that very step.
    """
    # 100000: p = 8, n = 12500, TOP = 12499. f = 104; 104 + 99992 = 100096: event, 60000, p = 1.
    # 200096 ends the old interval: event, 20000, p = 1. The clock starts at 200160 with 64:
    # f = 200161; 200161 + 59999 - 64 = 260096 = 200096 + 60000. Then 20000 each: 280096.
    stimuli: list[Stimulus] = [
        SetSpeed(50, 0xDA, 100_000, 0, 40_000, 1, 2),
        ClockOn(100, 8, 0),
        ClockOn(200_160, 1, 64),
    ]

    assert _step_cycles(stimuli, 300_000) == [100_096, 200_096, 260_096, 280_096]


def test_events_each_three_steps_in_the_interrupt() -> None:
    """
    With UPDATE_STEPS the third step applies the first event, the sixth the second.
    """
    # p = 1, TOP = 999, f = 101: 1100, 2100, 3100 (event: 1100), 4100, 5200, 6300 (event: 1100 + 200
    # = 1300), 7400, 8700, 10000.
    model = MotorModel(HOLDS)
    model.apply(SetSpeed(50, 0xF8, 1000, 0, 100, 3, 2))
    model.apply(ClockOn(100, 1, 0))

    shown = []
    for cycle in (3099, 3100, 6299, 6300):
        model.advance(cycle)
        shown.append((model.virtual_cycles, model.modification, model.updates_left))
    edges = model.advance(10_000)

    assert shown == [(1000, 100, 2), (1100, 200, 1), (1100, 200, 1), (1300, 400, 0)]
    assert [edge.deadline_cycle for edge in edges] == [7400, 8700, 10_000]


def test_events_each_three_steps_from_the_loop() -> None:
    """
    Without IRQ_TIMING a check applies the event of the third step, not before that step.
    """
    # 1100, 2100, 3100; checked at 3050: too early; at 3150: 1000 + 100 from 4100 on: 5200, 6300.
    # Checked at 6350: 1100 + 100 from 7400 on: 8600.
    checks: list[Stimulus] = [UpdateCheck(cycle) for cycle in (3050, 3150, 3160, 6350)]
    stimuli = [SetSpeed(50, 0xC8, 1000, 0, 100, 3, 2), ClockOn(100, 1, 0), *checks]

    assert _step_cycles(stimuli, 9000) == [1100, 2100, 3100, 4100, 5200, 6300, 7400, 8600]


@pytest.mark.parametrize("modification", [361, 500, 1001, 0xFFFF_FFFF])
def test_clamp_at_the_fast_end(modification: int) -> None:
    """
    A value below the smallest becomes the smallest, with both fault bits and no step lost.
    """
    # 1100: 1000 - modification < 640, so 640 from 2100 on: 2740, 3380.
    stimuli: list[Stimulus] = [
        SetSpeed(50, 0xDA, 1000, 4, modification, 1, 5),
        ClockOn(100, 1, 0),
    ]
    model = MotorModel(HOLDS)
    for stimulus in stimuli:
        model.apply(stimulus)

    model.advance(1100)
    assert (model.virtual_cycles, model.updates_left) == (640, 0)
    assert model.status == 0x45  # SPIN_FIXED, TIMER_DIV_ERROR, FAULT
    assert _step_cycles(stimuli, 100_000) == [1100, 2100, 2740, 3380]


@pytest.mark.parametrize("modification", [107_841, 200_000, 0xFFFF_FFFF])
def test_clamp_at_the_slow_end(modification: int) -> None:
    """
    A value beyond 65535 * 1024, or beyond 32 bits, becomes 65535 * 1024, likewise.
    """
    # 67000000: p = 1024, n = 65429, TOP = 65428. f = 2048; 2048 + 66998272 = 67000320: the event.
    # + 65429 * 1024 = 66999296: 133999616; then + 65535 * 1024 = 67107840: 201107456.
    stimuli: list[Stimulus] = [
        SetSpeed(1000, 0xD8, 67_000_000, 3, modification, 1, 5),
        ClockOn(1025, 1024, 0),
    ]
    model = MotorModel(HOLDS)
    for stimulus in stimuli:
        model.apply(stimulus)

    model.advance(67_000_320)
    assert (model.virtual_cycles, model.updates_left) == (67_107_840, 0)
    assert model.status == 0x45
    assert _step_cycles(stimuli, 300_000_000) == [67_000_320, 133_999_616, 201_107_456]


@pytest.mark.parametrize(
    ("control", "virtual_cycles", "modification", "limit_cycles"),
    [(0xDA, 1000, 360, 640), (0xD8, 67_000_000, 107_840, 67_107_840)],
)
def test_landing_on_the_limit_is_no_fault(
    control: int, virtual_cycles: int, modification: int, limit_cycles: int
) -> None:
    """
    Both limits themselves are values like any other.
    """
    model = MotorModel(HOLDS)
    model.apply(SetSpeed(50, control, virtual_cycles, 0, modification, 1, 2))
    model.apply(ClockOn(100, 1 if virtual_cycles == 1000 else 1024, 0))

    model.advance(virtual_cycles + 1000)

    assert (model.virtual_cycles, model.updates_left, model.status) == (limit_cycles, 1, 0)


def test_a_check_between_two_steps_leaves_their_interval() -> None:
    """
    The interval in progress ends as it was; the next one has the new speed.
    """
    # p = 1, TOP = 15999, f = 1001: 17000, 33000. millis 1 at 16384; checked at 20000: 10000 from
    # 33000 on: 43000, 53000. The interrupt at 17000 applied nothing: no IRQ_TIMING.
    stimuli: list[Stimulus] = [
        SetSpeed(900, 0xC2, 16_000, 0, 6000, 1, 1),
        ClockOn(1000, 1, 0),
        UpdateCheck(16_383),
        MillisTick(16_384, 1),
        UpdateCheck(20_000),
    ]

    assert _step_cycles(stimuli, 53_000) == [17_000, 33_000, 43_000, 53_000]
    assert _step_cycles(stimuli[:-1], 53_000) == [17_000, 33_000, 49_000]


def test_a_check_before_a_waiting_step_acts_from_that_step_on() -> None:
    """
    Like a call while running: the step that waits is the first of what comes after.
    """
    # As before, but 33000 is served at 33040 and the check commits at 33020, or at 33000 itself.
    for check_cycle in (33_000, 33_020):
        stimuli: list[Stimulus] = [
            SetSpeed(900, 0xC2, 16_000, 0, 6000, 1, 1),
            ClockOn(1000, 1, 0),
            MillisTick(16_384, 1),
            UpdateCheck(check_cycle),
        ]

        found = _step_cycles(stimuli, 60_000, {33_000: 33_040})

        assert found == [17_000, 33_000, 43_000, 53_000]


def test_two_overdue_events_happen_at_successive_steps() -> None:
    """
    The interrupt applies one event a step until none is due.
    """
    # p = 1, TOP = 47999, f = 1001. 49000: millis 2, two are due; the first: 38000.
    # 97000: the second, 28000. 97000 + 38000 = 135000: the third, 18000. + 28000 = 163000,
    # + 18000 = 181000, 199000.
    ticks: list[Stimulus] = [MillisTick(16_384 * n, n) for n in range(1, 13)]
    stimuli = [SetSpeed(900, 0xD2, 48_000, 0, 10_000, 1, 3), ClockOn(1000, 1, 0), *ticks]

    found = _step_cycles(stimuli, 199_000)

    assert found == [49_000, 97_000, 135_000, 163_000, 181_000, 199_000]


def test_two_overdue_events_happen_at_successive_checks() -> None:
    """
    A check applies one event; both act from the same step if none is between them.
    """
    model = MotorModel(HOLDS)
    for stimulus in (
        SetSpeed(900, 0xC2, 48_000, 0, 10_000, 1, 3),
        ClockOn(1000, 1, 0),
        MillisTick(32_768, 2),
    ):
        model.apply(stimulus)

    shown = []
    for cycle in (40_000, 40_100, 40_200):
        model.apply(UpdateCheck(cycle))
        shown.append(model.virtual_cycles)
    edges = model.advance(80_000)

    # 1001 + 47999 = 49000 as it was; 49000 + 28000 = 77000.
    assert shown == [38_000, 28_000, 28_000]
    assert [edge.deadline_cycle for edge in edges] == [900, 49_000, 77_000]


def test_the_release_follows_the_interval_in_progress() -> None:
    """
    The last step applies no event, and the coils go off one interval after it.
    """
    # 1100 (event: 800), 2100 as it was and the last: no event. The coils go off at 2100 + 800.
    model = MotorModel(RELEASES)
    model.apply(SetSpeed(50, 0xDA, 1000, 2, 200, 1, 3))
    model.apply(ClockOn(100, 1, 0))

    edges = model.advance(100_000)

    assert [(edge.deadline_cycle, str(edge.kind)) for edge in edges] == [
        (50, "energise"),
        (1100, "step"),
        (2100, "step"),
        (2900, "coils-off"),
    ]
    assert (model.virtual_cycles, model.updates_left, model.status) == (800, 2, 0x10)

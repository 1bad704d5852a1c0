"""
Traces of motors that come to their end and rest, derived by hand from the contract.

All with p = 1 and n = 1000, TOP = 999, clock on at 100 with an empty counter: f = 101, so that
the deadlines are 101 + 999 = 1100, 2100, 3100 ... Coils of full steps: 1100, 0110, 0011, 1001.
"""

import pytest

from stepgen.reference.contract import Status
from stepgen.reference.facts import MotorFacts
from stepgen.reference.integer import MotorModel
from stepgen.reference.prediction import predict
from stepgen.reference.sequences import coils_off, phases
from stepgen.reference.stimuli import (
    ClockOn,
    Edge,
    Hold,
    Init,
    MillisTick,
    Release,
    SetSpeed,
    Stimulus,
)

HOLDS = MotorFacts(phases("four-wire", "full"), coils_off("four-wire"), 640, "hold")
RELEASES = MotorFacts(phases("four-wire", "full"), coils_off("four-wire"), 640, "release")
CLOCK = ClockOn(100, 1, 0)


def _start(limit: int = 0, control: int = 0x80) -> list[Stimulus]:
    return [SetSpeed(50, control, 1000, limit), CLOCK]


def _wires(edges: tuple[Edge, ...]) -> list[tuple[int, str, str]]:
    return [(edge.deadline_cycle, str(edge.pattern), edge.kind) for edge in edges]


FIRST = [(50, "1100", "energise"), (1100, "0110", "step")]


@pytest.mark.parametrize(
    ("facts", "control", "virtual_cycles", "code", "at_the_stop"),
    [
        (HOLDS, 0x80, 0, 0, []),
        (HOLDS, 0x00, 0, 0, [(1500, "0000", "coils-off")]),
        (HOLDS, 0x00, 1000, 1, [(1500, "0000", "coils-off")]),
        (RELEASES, 0x80, 0, 0, [(1500, "0000", "coils-off")]),
        (RELEASES, 0x7F, 5, 1, [(1500, "0000", "coils-off")]),
        (HOLDS, 0xFF, 0, 0, []),
    ],
)
def test_a_stop_lets_no_step_follow(
    facts: MotorFacts,
    control: int,
    virtual_cycles: int,
    code: int,
    at_the_stop: list[tuple[int, str, str]],
) -> None:
    """
    After a stop there is no step; the coils rest as the spec says, and are off without DRV_EN.
    """
    run = predict(facts, [*_start(), SetSpeed(1500, control, virtual_cycles)], 100_000)

    assert _wires(run.edges) == FIRST + at_the_stop
    assert run.return_codes == (0, code)
    assert (run.status, run.running, run.steps_left) == (Status.REACHED, False, 0)


def test_release_comes_one_interval_after_the_last_step() -> None:
    """
    At the end of a steps limit the coils stay on for one interval more, then go off.
    """
    # Two steps: 1100, 2100; the coils go off at the overflow after them, 3100.
    model = MotorModel(RELEASES)
    for stimulus in _start(limit=2):
        model.apply(stimulus)

    edges = model.advance(2100)
    assert (model.status, model.running) == (Status.REACHED, False)
    edges += model.advance(100_000)

    expected = [*FIRST, (2100, "0011", "step"), (3100, "0000", "coils-off")]
    assert _wires(tuple(edges)) == expected


def test_release_follows_the_new_clock_after_a_change_of_prescaler() -> None:
    """
    The last step may be the one that ends the old interval: the release takes the new one.
    """
    # Called at 500 with v = 80000, one step: p = 8, n = 10000, TOP = 9999. The step is at 1100.
    # The clock is started anew at 1160 with 7: f = 146 * 8 = 1168;
    # 1168 + (9999 - 7) * 8 = 1168 + 79936 = 81104.
    stimuli: list[Stimulus] = [*_start(), SetSpeed(500, 0x80, 80_000, 1), ClockOn(1160, 8, 7)]

    run = predict(RELEASES, stimuli, 200_000)

    assert _wires(run.edges) == [*FIRST, (81_104, "0000", "coils-off")]


def test_a_start_before_the_release_keeps_the_coils_on() -> None:
    """
    A new start cancels the release, and begins its first interval with its own clock.
    """
    # One step at 1100, release due at 2100. Started again at 1800, clock on at 1850: f = 1851,
    # 1851 + 999 = 2850 is the only step, 3850 the release.
    stimuli: list[Stimulus] = [*_start(limit=1), SetSpeed(1800, 0x80, 1000, 1), ClockOn(1850, 1, 0)]

    run = predict(RELEASES, stimuli, 100_000)

    assert _wires(run.edges) == [*FIRST, (2850, "0011", "step"), (3850, "0000", "coils-off")]
    assert [edge.call_index for edge in run.edges] == [0, 0, 1, 1]


def test_the_overflow_of_the_old_release_is_no_step_of_a_new_start() -> None:
    """
    Until the new call's clock is on, no deadline of the old one counts.
    """
    # One step at 1100, release due at 2100. Started again at 2090, clock on at 2150, past the
    # old deadline: f = 2151, 2151 + 999 = 3150 is the only step, 4150 the release.
    stimuli = [*_start(limit=1), SetSpeed(2090, 0x80, 1000, 1), ClockOn(2150, 1, 0)]

    run = predict(RELEASES, stimuli, 100_000)

    assert _wires(run.edges) == [*FIRST, (3150, "0011", "step"), (4150, "0000", "coils-off")]


@pytest.mark.parametrize(
    ("call", "after"),
    [
        (Hold(1800), []),
        (Release(1800), [(1800, "0000", "coils-off")]),
        (SetSpeed(1800, 0x80, 0), [(1800, "0000", "coils-off")]),
        (Init(1800), [(1800, "0000", "coils-off")]),
        (SetSpeed(1800, 0x80, 639), [(2100, "0000", "coils-off")]),
    ],
)
def test_calls_before_the_release_replace_it(
    call: Stimulus, after: list[tuple[int, str, str]]
) -> None:
    """
    Hold, release, stop and init before the release decide about the coils; a refusal does not.
    """
    run = predict(RELEASES, [*_start(limit=1), call], 100_000)

    assert _wires(run.edges) == FIRST + after


@pytest.mark.parametrize(
    ("facts", "at_the_end"),
    [(HOLDS, []), (RELEASES, [(3100, "0000", "coils-off")])],
)
def test_millis_limit_rests_at_the_step_that_is_not_made(
    facts: MotorFacts, at_the_end: list[tuple[int, str, str]]
) -> None:
    """
    A step due at the very cycle at which the limit is over is not made; coils then rest.
    """
    # Started at millis 7 with limit 1. millis is 8 from 3100 on, the cycle of the third deadline.
    stimuli: list[Stimulus] = [MillisTick(0, 7), *_start(1, control=0x84), MillisTick(3100, 8)]

    run = predict(facts, stimuli, 100_000)

    assert _wires(run.edges) == [*FIRST, (2100, "0011", "step"), *at_the_end]
    assert (run.status, run.running) == (Status.REACHED, False)


def test_millis_limit_is_judged_when_the_interrupt_is_served() -> None:
    """
    A service after the millisecond is over makes no step, though its deadline was before.
    """
    # The deadline 2100 is served at 2160; millis changes at 2130.
    stimuli: list[Stimulus] = [*_start(1, control=0x84), MillisTick(2130, 1)]

    run = predict(HOLDS, stimuli, 100_000, lambda deadline: deadline + 60)

    assert _wires(run.edges) == FIRST


def test_millis_limit_survives_the_wrap_of_millis() -> None:
    """
    The difference of two times is taken modulo 2^32.
    """
    # Started at 2^32 - 1, limit 2: 0 is one later, 1 is two later. Steps at 1100 and 2100.
    stimuli: list[Stimulus] = [
        MillisTick(0, 4_294_967_295),
        *_start(2, control=0x84),
        MillisTick(1500, 0),
        MillisTick(2500, 1),
    ]

    run = predict(HOLDS, stimuli, 100_000)

    assert _wires(run.edges) == [*FIRST, (2100, "0011", "step")]


def test_reading_the_status_looks_at_the_clock() -> None:
    """
    The status shows REACHED once the limit has passed, before the due step that is not made.
    """
    model = MotorModel(HOLDS)
    for stimulus in _start(3, control=0x84):
        model.apply(stimulus)

    assert model.status_at(1200, 2) == Status.SPIN_FIXED
    assert model.status_at(1300, 3) == Status.SPIN_FIXED | Status.REACHED
    assert len(model.advance(1300)) == 2


def test_millis_limit_zero_is_endless() -> None:
    """
    ENDPOINT_MILLIS with limit 0 has no end point.
    """
    run = predict(HOLDS, [*_start(0, control=0x84), MillisTick(1500, 4_000_000_000)], 3100)

    assert (run.position, run.running, run.steps_left) == (3, True, None)

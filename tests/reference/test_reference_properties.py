"""
What holds for every run, whatever the numbers: properties of both models.
"""

from fractions import Fraction
from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st

from stepgen.reference.facts import MotorFacts
from stepgen.reference.ideal import (
    ideal_rate_sps,
    ideal_step_cycles,
    ideal_step_seconds,
    lead_bound_cycles,
    lead_bound_from_start_cycles,
)
from stepgen.reference.integer import MotorModel
from stepgen.reference.prediction import predict
from stepgen.reference.sequences import coils_off, phases
from stepgen.reference.stimuli import ClockOn, SetSpeed, Stimulus
from stepgen.reference.timer import timer_setting

FACTS = MotorFacts(phases("four-wire", "half"), coils_off("four-wire"), 640, "hold")
VIRTUAL_CYCLES = st.integers(640, 65_535 * 1024)
CYCLES = st.integers(0, 10**9)


@given(VIRTUAL_CYCLES, CYCLES, st.integers(1, 300))
def test_exactly_limit_steps(virtual_cycles: int, start_cycle: int, limit: int) -> None:
    """
    A steps limit gives that many steps, evenly spaced, however long one waits.
    """
    setting = timer_setting(virtual_cycles)
    stimuli: list[Stimulus] = [
        SetSpeed(start_cycle, 0x80, virtual_cycles, limit),
        ClockOn(start_cycle + 9, setting.prescaler, 0),
    ]
    end_cycle = start_cycle + 9 + (limit + 5) * virtual_cycles

    run = predict(FACTS, stimuli, end_cycle)

    steps = [edge.deadline_cycle for edge in run.edges if edge.kind == "step"]
    gaps = {two - one for one, two in pairwise(steps)}
    assert len(steps) == run.position == limit
    assert gaps <= {setting.period_cycles}


@given(st.lists(st.tuples(st.booleans(), st.integers(1, 50)), max_size=12))
def test_position_is_the_sum_of_the_moves(moves: list[tuple[bool, int]]) -> None:
    """
    After several moves the position is the sum of their signed lengths, the phase that sum mod 8.
    """
    model = MotorModel(FACTS)
    pattern = FACTS.phases[0]
    cycle = 0
    for backwards, steps in moves:
        model.apply(SetSpeed(cycle, 0x80 | backwards, 1000, steps))
        model.apply(ClockOn(cycle, 1, 0))
        cycle += 100_000
        pattern = model.advance(cycle)[-1].pattern

    total = sum(-steps if backwards else steps for backwards, steps in moves)
    assert model.position == total
    assert pattern == FACTS.phases[total % 8]


@given(st.integers(1, 200), st.integers(640, 65_535), st.integers(1, 999))
def test_reversing_returns_over_the_same_phases(
    steps: int, virtual_cycles: int, call_after_cycles: int
) -> None:
    """
    Reversed while running, the motor returns through the same patterns to where it was.
    """
    first_cycle = virtual_cycles  # clock on at 0: the first tick at 1, TOP ticks more
    last_cycle = first_cycle + (steps - 1) * virtual_cycles
    call_cycle = last_cycle + min(call_after_cycles, virtual_cycles - 1)
    stimuli: list[Stimulus] = [
        SetSpeed(0, 0x80, virtual_cycles),
        ClockOn(0, 1, 0),
        SetSpeed(call_cycle, 0x81, virtual_cycles, steps),
    ]

    run = predict(FACTS, stimuli, last_cycle + (steps + 3) * virtual_cycles)

    patterns = [edge.pattern for edge in run.edges]
    assert len(patterns) == 2 * steps + 1
    assert patterns == patterns[::-1]
    assert run.position == 0


@given(VIRTUAL_CYCLES, CYCLES, st.integers(0, 65_535))
def test_first_overflow_lies_within_one_tick_of_the_interval(
    virtual_cycles: int, clock_on_cycle: int, until_commit_cycles: int
) -> None:
    """
    From rest the first step comes one period after the clock, or less than a tick earlier.
    """
    setting = timer_setting(virtual_cycles)
    commit_cycle = max(clock_on_cycle - until_commit_cycles, 0)
    stimuli: list[Stimulus] = [
        SetSpeed(commit_cycle, 0x80, virtual_cycles, 1),
        ClockOn(clock_on_cycle, setting.prescaler, 0),
    ]

    run = predict(FACTS, stimuli, clock_on_cycle + virtual_cycles)

    wait_cycles = run.edges[-1].deadline_cycle - clock_on_cycle
    assert 0 <= setting.period_cycles - wait_cycles < setting.prescaler


@given(VIRTUAL_CYCLES)
def test_period_is_never_longer_than_asked_for(virtual_cycles: int) -> None:
    """
    The integer period is at most v and less than one prescaler tick shorter, for every v.
    """
    setting = timer_setting(virtual_cycles)

    assert 0 <= virtual_cycles - setting.period_cycles < setting.prescaler


@given(VIRTUAL_CYCLES, CYCLES, st.integers(1, 100))
def test_integer_model_stays_within_the_bound_of_the_ideal_one(
    virtual_cycles: int, clock_on_cycle: int, steps: int
) -> None:
    """
    The k-th step leads the ideal one by less than k * p cycles, from the start (k + 1) * p.
    """
    prescaler = timer_setting(virtual_cycles).prescaler
    stimuli: list[Stimulus] = [
        SetSpeed(clock_on_cycle, 0x80, virtual_cycles, steps + 1),
        ClockOn(clock_on_cycle, prescaler, 0),
    ]

    run = predict(FACTS, stimuli, clock_on_cycle + (steps + 1) * virtual_cycles)

    first, *others = [edge.deadline_cycle for edge in run.edges[1:]]
    for intervals, step_cycle in enumerate(others, start=1):
        lead = first + ideal_step_cycles(intervals, virtual_cycles) - step_cycle
        assert 0 <= lead < lead_bound_cycles(intervals, prescaler)
    for intervals, step_cycle in enumerate([first, *others], start=1):
        lead = clock_on_cycle + ideal_step_cycles(intervals, virtual_cycles) - step_cycle
        assert 0 <= lead < lead_bound_from_start_cycles(intervals, prescaler)


def test_ideal_motor_is_exact() -> None:
    """
    Rates and times of the ideal motor are fractions, never rounded.
    """
    assert ideal_rate_sps(16_000_000, 88_888) == Fraction(2_000_000, 11_111)
    assert ideal_step_seconds(3, 88_888, 16_000_000) == Fraction(33_333, 2_000_000)

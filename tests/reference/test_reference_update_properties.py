"""
What holds for update events, whatever the numbers.

Control bits: 0x80 DRV_EN, 0x40 SPEED_VARIABLE, 0x20 VARIABLE_PWR, 0x10 IRQ_TIMING,
0x08 UPDATE_STEPS, 0x02 FASTER.
"""

from itertools import pairwise

from hypothesis import assume, given
from hypothesis import strategies as st

from stepgen.reference.facts import MotorFacts
from stepgen.reference.ideal import ideal_halvings_cycles
from stepgen.reference.integer import MotorModel
from stepgen.reference.prediction import predict
from stepgen.reference.sequences import coils_off, phases
from stepgen.reference.stimuli import ClockOn, MillisTick, SetSpeed, Stimulus, UpdateCheck
from stepgen.reference.timer import timer_setting

FASTEST = 640
SLOWEST = 65_535 * 1024
FACTS = MotorFacts(
    phases("four-wire", "half"), coils_off("four-wire"), FASTEST, "hold", "update-events"
)
UINT32 = st.integers(1, (1 << 32) - 1)


def _virtual_column(
    control: int, virtual_cycles: int, modification: int, updates: int
) -> list[int]:
    """
    Return the virtual value at a call and after each event, which checks apply one by one.
    """
    model = MotorModel(FACTS)
    model.apply(SetSpeed(0, control, virtual_cycles, 0, modification, 1, updates))
    column = [model.virtual_cycles]
    for number in range(1, updates + 1):
        model.apply(MillisTick(number, number))
        model.apply(UpdateCheck(number))
        column.append(model.virtual_cycles)
    assert (model.updates_left, model.status) == (0, 0x40)
    return column


@given(st.integers(1, 30_000_000), st.integers(1, 40))
def test_halvings_add_up(modification: int, updates: int) -> None:
    """
    Halving changes, n from m on, come to m * (2 - 2^(1 - n)), at most n - 1 less by truncation.
    """
    start_cycles = 2 * modification + FASTEST

    column = _virtual_column(0xE2, start_cycles, modification, updates)

    missing = ideal_halvings_cycles(modification, updates) - (column[0] - column[-1])
    assert 0 <= missing <= updates - 1


def test_halvings_of_the_source_add_up() -> None:
    """
    The 11 halvings of 2385000 lead from 4800000 to 32332, within 10 cycles of the formula.
    """
    # 2385000 * (2 - 2^-10) = 4770000 - 2329.1 = 4767670.9; 4800000 - 4767670.9 = 32329.1.
    assert 32_332 - 10 <= 4_800_000 - ideal_halvings_cycles(2_385_000, 11) <= 32_332


@given(st.integers(1, 300_000), st.integers(1, 12), st.integers(FASTEST, 1_000_000))
def test_slower_mirrors_faster_with_equal_changes(
    modification: int, updates: int, end_cycles: int
) -> None:
    """
    Slower by equal changes passes the values of faster by the same ones, backwards.
    """
    start_cycles = end_cycles + updates * modification

    there = _virtual_column(0xC2, start_cycles, modification, updates)
    back = _virtual_column(0xC0, end_cycles, modification, updates)

    assert (there[0], there[-1]) == (start_cycles, end_cycles)
    assert there == back[::-1]


@given(st.integers(1, 300_000), st.integers(1, 12), st.integers(FASTEST, 1_000_000))
def test_doublings_mirror_halvings(smallest: int, updates: int, end_cycles: int) -> None:
    """
    Slower by doublings passes the values of faster by exact halvings, backwards.
    """
    start_cycles = end_cycles + smallest * (2**updates - 1)
    assume(start_cycles <= SLOWEST)

    there = _virtual_column(0xE2, start_cycles, smallest * 2 ** (updates - 1), updates)
    back = _virtual_column(0xE0, end_cycles, smallest, updates)

    assert (there[0], there[-1]) == (start_cycles, end_cycles)
    assert there == back[::-1]


@given(
    st.integers(FASTEST, SLOWEST),
    st.one_of(st.integers(1, 100_000), UINT32),
    st.sampled_from([0xD8, 0xDA, 0xF8, 0xFA]),
    st.integers(1, 5),
    st.integers(1, 60),
)
def test_no_step_is_lost_and_the_speed_changes_one_way(
    virtual_cycles: int, modification: int, control: int, interval: int, limit: int
) -> None:
    """
    Whatever the events do there are exactly *limit* steps, never slower than both speeds.
    """
    stimuli: list[Stimulus] = [
        SetSpeed(0, control, virtual_cycles, limit, modification, interval, 30),
        ClockOn(0, timer_setting(virtual_cycles).prescaler, 0),
    ]

    run = predict(FACTS, stimuli, (limit + 2) * SLOWEST)

    steps = [edge.deadline_cycle for edge in run.edges if edge.kind == "step"]
    gaps = [two - one for one, two in pairwise(steps)]
    assert len(steps) == run.position == limit
    # Up to the step after the first event the old speed; truncation is less than 1024 cycles.
    assert set(gaps[:interval]) <= {timer_setting(virtual_cycles).period_cycles}
    order = [-gap for gap in gaps] if control & 0x02 else gaps
    assert all(two > one - 1024 for one, two in pairwise(order))
    assert all(FASTEST <= gap <= SLOWEST for gap in gaps)

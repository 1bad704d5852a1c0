"""
Steps that come too late: what the model counts, and that no later step moves for them.
"""

from hypothesis import given
from hypothesis import strategies as st

from stepgen.reference.contract import Status
from stepgen.reference.facts import MotorFacts
from stepgen.reference.integer import MotorModel
from stepgen.reference.prediction import predict
from stepgen.reference.sequences import coils_off, phases
from stepgen.reference.stimuli import ClockOn, Init, Release, SetSpeed, Stimulus

OVERRUN_CYCLES = 1_000
FACTS = MotorFacts(
    phases("four-wire", "full"),
    coils_off("four-wire"),
    2048,
    "release",
    timing="compare",
    overrun_cycles=OVERRUN_CYCLES,
)
# Steps at 3048 + k * 2048, as tests/reference/test_reference_compare.py derives them.
FIRST, PERIOD = 3_048, 2_048
START: tuple[Stimulus, ...] = (SetSpeed(1_000, 0x80, PERIOD), ClockOn(1_001, 8, 0))


def _model(waits: dict[int, int]) -> MotorModel:
    """
    Return a running motor, the k-th of whose interrupts waits for waits[k] cycles.
    """
    late = {FIRST + k * PERIOD: wait for k, wait in waits.items()}
    model = MotorModel(FACTS, lambda deadline: deadline + late.get(deadline, 0))
    for stimulus in START:
        model.apply(stimulus)
    return model


def test_a_step_counts_from_the_stated_lateness_on() -> None:
    """
    999 cycles are late, 1000 are too late.
    """
    model = _model({0: OVERRUN_CYCLES - 1, 1: OVERRUN_CYCLES})

    model.advance(FIRST + PERIOD)
    assert (model.overruns, model.status & Status.MISSED) == (0, Status(0))
    model.advance(FIRST + 2 * PERIOD)
    assert (model.overruns, model.status & Status.MISSED) == (1, Status.MISSED)


def test_a_start_clears_the_bit_and_an_init_the_count() -> None:
    """
    The bit tells of the present motion, the count of everything since the init.
    """
    model = _model({0: OVERRUN_CYCLES})
    model.advance(5_000)

    model.apply(SetSpeed(5_001, 0x80, 1))  # refused
    assert model.status & Status.MISSED
    model.apply(SetSpeed(5_002, 0x80, 4_096))
    assert (model.overruns, model.status & Status.MISSED) == (1, Status(0))
    model.apply(Init(5_003))
    assert model.overruns == 0


def test_a_stop_leaves_the_bit() -> None:
    """
    Who stops a motor may still ask whether it was late.
    """
    model = _model({0: OVERRUN_CYCLES})
    model.advance(5_000)

    model.apply(SetSpeed(5_001, 0, 0))
    model.apply(Release(5_002))

    assert model.status & Status.MISSED


def test_the_release_after_the_last_step_counts_too() -> None:
    """
    It is an interrupt as that of a step.
    """
    until = FIRST + 3 * PERIOD
    late = FIRST + PERIOD
    result = predict(
        FACTS,
        [SetSpeed(1_000, 0x80, PERIOD, 1), ClockOn(1_001, 8, 0)],
        until,
        lambda deadline: deadline + (1_500 if deadline == late else 0),
    )

    assert [edge.kind for edge in result.edges] == ["energise", "step", "coils-off"]
    assert result.overruns == 1


def test_the_count_wraps_at_16_bits() -> None:
    """
    As a uint16_t does.
    """
    model = _model({0: OVERRUN_CYCLES})
    model._notices.overruns = 65_535  # noqa: SLF001 - as many cannot be made here

    model.advance(5_000)

    assert model.overruns == 0


@given(st.dictionaries(st.integers(0, 40), st.integers(0, 1_900), max_size=30))
def test_no_step_moves_for_one_that_waited(waits: dict[int, int]) -> None:
    """
    However long any of them wait: every step is due at its multiple of the period.
    """
    model = _model(waits)
    edges = [edge for edge in model.advance(FIRST + 50 * PERIOD) if edge.kind == "step"]

    assert [edge.deadline_cycle for edge in edges] == [FIRST + k * PERIOD for k in range(51)]
    assert [edge.position for edge in edges] == list(range(1, 52))
    assert model.overruns == sum(wait >= OVERRUN_CYCLES for wait in waits.values())


@given(st.integers(0, 5_000))
def test_fast_pwm_cannot_tell(wait: int) -> None:
    """
    Without a stated lateness nothing is counted.
    """
    facts = MotorFacts(phases("four-wire", "full"), coils_off("four-wire"), 640, "hold")
    stimuli: list[Stimulus] = [SetSpeed(1_000, 0x80, 20_000), ClockOn(1_001, 1, 0)]

    result = predict(facts, stimuli, 100_000, lambda deadline: deadline + wait)

    assert (result.overruns, result.status & Status.MISSED) == (0, Status(0))

"""
When ``motorTimerUpdateCheck`` calls back, and what the status then shows, by the contract.

All with p = 1 and n = 1000, TOP = 999, clock on at 100 with an empty counter: f = 101, so that
the deadlines are 101 + 999 = 1100, 2100, 3100 ... The smallest virtual value is 640.
Status bits: 0x01 FAULT, 0x02 FAULT_CALLED, 0x04 TIMER_DIV_ERROR, 0x08 TIMER_DIV_CALLED,
0x10 REACHED, 0x20 REACH_CALLED, 0x40 SPIN_FIXED.
"""

import pytest

from stepgen.reference.facts import MotorFacts
from stepgen.reference.integer import MotorModel
from stepgen.reference.sequences import coils_off, phases
from stepgen.reference.stimuli import (
    CallBack,
    Callbacks,
    ClockOn,
    Hold,
    Init,
    MillisTick,
    SetSpeed,
    Stimulus,
    UpdateCheck,
)

HOLDS = MotorFacts(
    phases("four-wire", "full"), coils_off("four-wire"), 640, "hold", "update-events"
)
BOTH = Callbacks(0, reached=True, fault=True)
CLOCK = ClockOn(100, 1, 0)
ONE_STEP = SetSpeed(50, 0x80, 1000, 1)


def _check(cycle: int) -> tuple[Stimulus, Stimulus]:
    """
    Return both halves of a check in which nothing comes in between.
    """
    return UpdateCheck(cycle), CallBack(cycle)


def _tell(model: MotorModel, *stimuli: Stimulus) -> None:
    for stimulus in stimuli:
        model.apply(stimulus)


def _model(*stimuli: Stimulus) -> MotorModel:
    model = MotorModel(HOLDS)
    _tell(model, *stimuli)
    return model


@pytest.mark.parametrize("control", [0x80, 0xD0])
def test_an_end_point_calls_back_once(control: int) -> None:
    """
    The first check after the last step calls back, also when the interrupt does the timing.
    """
    model = _model(BOTH, SetSpeed(50, control, 1000, 1, 1, 1, 1), CLOCK)

    for cycle in (1099, 1200, 1300):
        _tell(model, *_check(cycle))

    assert model.callbacks == ((1200, "reached"),)
    assert model.status == 0x30


@pytest.mark.parametrize("stop", [SetSpeed(1500, 0x80, 0), SetSpeed(1500, 0, 1000)])
def test_a_stop_calls_nobody(stop: SetSpeed) -> None:
    """
    REACHED by a stop is no end point.
    """
    model = _model(BOTH, SetSpeed(50, 0x80, 1000, 5), CLOCK, stop, *_check(1600))

    assert (model.callbacks, model.status) == ((), 0x10)


@pytest.mark.parametrize(
    ("between", "made"),
    [
        (SetSpeed(1500, 0x80, 0), ((1600, "reached"),)),
        (SetSpeed(1500, 0x80, 1), ((1600, "reached"), (1600, "fault"))),
        (SetSpeed(1500, 0x80, 1000), ()),
        (Init(1500), ()),
    ],
)
def test_calls_between_the_end_point_and_its_callback(
    between: Stimulus, made: tuple[tuple[int, str], ...]
) -> None:
    """
    A stop or a refusal leaves the callback due, a start or Init drops it with the bit.
    """
    model = _model(BOTH, ONE_STEP, CLOCK, between, *_check(1600))

    assert model.callbacks == made


def test_a_callback_registered_later_is_made_then() -> None:
    """
    Without a registered callback nothing is called and nothing is marked as called.
    """
    model = _model(ONE_STEP, CLOCK, SetSpeed(1200, 0x80, 1), *_check(1300))
    assert (model.callbacks, model.status) == ((), 0x15)

    model.apply(Callbacks(1400, reached=False, fault=True))
    _tell(model, *_check(1500))
    assert (model.callbacks, model.status) == (((1500, "fault"),), 0x1F)

    model.apply(Callbacks(1600, reached=True, fault=False))
    _tell(model, *_check(1700))
    assert (model.callbacks[1:], model.status) == (((1700, "reached"),), 0x3F)


def test_each_fault_calls_back_once() -> None:
    """
    A refusal calls back once, the next refusal once more; a start clears all bits.
    """
    model = _model(BOTH, SetSpeed(10, 0x80, 639))
    assert model.status == 0x05

    for cycle in (20, 30):
        _tell(model, *_check(cycle))
        assert (model.callbacks, model.status) == (((20, "fault"),), 0x0F)
    model.apply(SetSpeed(40, 0xC0, 1000))
    assert model.status == 0x0D
    _tell(model, *_check(50))
    assert (model.callbacks[1:], model.status) == (((50, "fault"),), 0x0F)
    model.apply(SetSpeed(60, 0x80, 1000))
    _tell(model, *_check(70))
    assert (len(model.callbacks), model.status) == (2, 0x40)
    model.apply(Hold(80))
    _tell(model, *_check(90))
    assert (model.callbacks[2:], model.status) == (((90, "fault"),), 0x43)


def test_a_clamp_in_a_check_is_called_back_by_it() -> None:
    """
    The check that stops at a limit delivers the fault itself.
    """
    started = SetSpeed(50, 0xCA, 1000, 0, 500, 1, 5)
    model = _model(BOTH, started, CLOCK, *_check(1200), *_check(1300))

    assert (model.callbacks, model.status) == (((1200, "fault"),), 0x4F)
    assert [edge.deadline_cycle for edge in model.advance(2740)] == [50, 1100, 2100, 2740]


def test_a_check_notices_that_a_millis_limit_has_passed() -> None:
    """
    The callback need not wait for the step that is not made; no event happens any more.
    """
    # Limit 2 ms, an event due at 1 ms. The deadline 2100 makes no step.
    started = SetSpeed(50, 0xC6, 1000, 2, 100, 1, 5)
    model = _model(BOTH, started, CLOCK, MillisTick(1200, 2))
    assert (model.status, model.status_at(1300, 2)) == (0x00, 0x10)

    _tell(model, *_check(1300))

    assert (model.callbacks, model.status) == (((1300, "reached"),), 0x30)
    assert (model.running, model.virtual_cycles) == (True, 1000)
    assert [edge.deadline_cycle for edge in model.advance(9000)] == [50, 1100]
    _tell(model, *_check(9000))
    assert (model.running, model.status, len(model.callbacks)) == (False, 0x30, 1)


def test_a_callback_may_start_the_next_motion() -> None:
    """
    A start in the callback clears the bits, and its end point calls back again.
    """
    model = _model(BOTH, ONE_STEP, CLOCK, *_check(1200), SetSpeed(1200, 0x81, 1000, 1))
    assert model.status == 0x40

    model.apply(ClockOn(1250, 1, 0))
    _tell(model, *_check(2250))

    assert model.callbacks == ((1200, "reached"), (2250, "reached"))
    assert (model.position, model.status) == (0, 0x30)


def test_an_end_point_in_the_middle_of_a_check_is_called_back_by_it() -> None:
    """
    The last step is due between the two moments at which the check masks the interrupts.
    """
    model = _model(BOTH, ONE_STEP, CLOCK, UpdateCheck(1090))
    assert model.status == 0x40

    model.apply(CallBack(1110))

    assert (model.callbacks, model.status) == (((1110, "reached"),), 0x30)

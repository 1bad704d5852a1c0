"""
Motors with a command time-out, traced by hand: a step is made while the last word is recent.

p = 1 and n = 1000, clock on at 100 with an empty counter: deadlines at 1100, 2100, 3100 ... The
time-out is 20 ms; ``millis()`` returns what the ticks say.
"""

import pytest

from stepgen.reference.contract import Code, Status
from stepgen.reference.facts import MotorFacts
from stepgen.reference.integer import MotorModel
from stepgen.reference.prediction import predict
from stepgen.reference.sequences import coils_off, phases
from stepgen.reference.stimuli import (
    CallBack,
    ClockOn,
    Hold,
    Init,
    KeepAlive,
    MillisTick,
    SetSpeed,
    Stimulus,
    UpdateCheck,
)

PHASES, OFF = phases("four-wire", "full"), coils_off("four-wire")
RELEASES = MotorFacts(PHASES, OFF, 640, "release", command_timeout_millis=20)
HOLDS = MotorFacts(PHASES, OFF, 640, "hold", command_timeout_millis=20)
LAST_MILLIS = (1 << 32) - 5


def _model(facts: MotorFacts, *stimuli: Stimulus, until: int) -> tuple[MotorModel, list[int]]:
    model = MotorModel(facts)
    for stimulus in stimuli:
        model.apply(stimulus)
    return model, [edge.deadline_cycle for edge in model.advance(until)]


@pytest.mark.parametrize("first", [0, LAST_MILLIS])
def test_a_motor_that_is_left_alone_stops_at_the_step_after_the_time(first: int) -> None:
    """
    19 ms after the call a step is made; after 20 the next is not, and the coils go off at it.
    """
    stimuli = (
        MillisTick(40, first),
        SetSpeed(50, 0x80, 1000),
        ClockOn(100, 1, 0),
        MillisTick(1500, (first + 19) % (1 << 32)),
        MillisTick(2500, (first + 20) % (1 << 32)),
    )

    model, edges = _model(RELEASES, *stimuli, until=9000)

    assert edges == [50, 1100, 2100, 3100]
    assert (model.position, model.running, model.timed_out) == (2, False, True)
    assert model.status == Status.REACHED
    assert str(model.advance(9000)) == "[]"


def test_a_motor_that_holds_keeps_its_coils_on() -> None:
    """
    The stop is one like any other: with ``at_rest: hold`` no edge comes of it.
    """
    stimuli = (SetSpeed(50, 0x80, 1000), ClockOn(100, 1, 0), MillisTick(1500, 20))

    model, edges = _model(HOLDS, *stimuli, until=9000)

    assert edges == [50, 1100]
    assert model.timed_out


def test_a_sign_of_life_counts_from_itself() -> None:
    """
    Kept alive at 15 ms, the motor makes the step at 34 ms and not that at 35.
    """
    stimuli = (
        SetSpeed(50, 0x80, 1000),
        ClockOn(100, 1, 0),
        MillisTick(1500, 15),
        KeepAlive(1600),
        MillisTick(2500, 34),
        MillisTick(3500, 35),
    )

    model, edges = _model(HOLDS, *stimuli, until=9000)

    assert edges == [50, 1100, 2100, 3100]
    assert model.timed_out


def test_a_sign_of_life_before_the_next_step_is_due_comes_in_time() -> None:
    """
    The time has passed, but no step was due: the motor goes on.
    """
    stimuli = (
        SetSpeed(50, 0x80, 1000),
        ClockOn(100, 1, 0),
        MillisTick(1200, 25),
        KeepAlive(1300),
    )

    model, edges = _model(HOLDS, *stimuli, until=3000)

    assert edges == [50, 1100, 2100]
    assert model.running


def test_what_is_refused_is_no_sign_of_life() -> None:
    """
    Neither a call that is out of range nor Hold while running puts the time-out off.
    """
    stimuli = (
        SetSpeed(50, 0x80, 1000),
        ClockOn(100, 1, 0),
        MillisTick(1200, 19),
        SetSpeed(1300, 0x80, 1),
        Hold(1400),
        MillisTick(1500, 20),
    )

    model, edges = _model(HOLDS, *stimuli, until=9000)

    assert edges == [50, 1100]
    assert model.return_codes == (Code.FINE, Code.TOO_FAST, Code.RUNNING)
    assert model.status == Status.REACHED | Status.FAULT | Status.TIMER_DIV_ERROR


@pytest.mark.parametrize("limit", [2, 0])
def test_an_end_point_before_it_is_none(limit: int) -> None:
    """
    A motor that has reached its limit, or was stopped, never times out.
    """
    stimuli: tuple[Stimulus, ...] = (SetSpeed(50, 0x80, 1000, limit), ClockOn(100, 1, 0))
    if not limit:
        stimuli += (SetSpeed(2200, 0x80, 0),)

    model, edges = _model(HOLDS, *stimuli, MillisTick(3500, 90), until=9000)

    assert edges == [50, 1100, 2100]
    assert not model.timed_out


@pytest.mark.parametrize("after", [SetSpeed(4000, 0x80, 1000), Init(4000)])
def test_a_start_and_an_init_forget_it(after: Stimulus) -> None:
    """
    What the last motion came to counts until the next begins.
    """
    stimuli = (SetSpeed(50, 0x80, 1000), ClockOn(100, 1, 0), MillisTick(1500, 20))

    model, _ = _model(HOLDS, *stimuli, after, until=4100)

    assert not model.timed_out


def test_a_time_out_is_no_end_point_that_is_called_back() -> None:
    """
    As after a stop, ``...TimerUpdateCheck`` tells nobody.
    """
    facts = MotorFacts(PHASES, OFF, 640, "hold", "update-events", command_timeout_millis=20)
    stimuli = (SetSpeed(50, 0x80, 1000), ClockOn(100, 1, 0), MillisTick(1500, 20))

    prediction = predict(facts, [*stimuli, UpdateCheck(5000), CallBack(5050)], 9000)

    assert prediction.callbacks == ()
    assert prediction.status == Status.REACHED

"""
What calls with update events return and set, derived by hand from the contract.

All with p = 1 and n = 1000, TOP = 999, clock on at 100 with an empty counter: f = 101, so that
the deadlines are 101 + 999 = 1100, 2100, 3100 ... The smallest virtual value is 640.
Status bits: 0x01 FAULT, 0x02 FAULT_CALLED, 0x04 TIMER_DIV_ERROR, 0x08 TIMER_DIV_CALLED,
0x10 REACHED, 0x20 REACH_CALLED, 0x40 SPIN_FIXED.
"""

from collections.abc import Callable
from dataclasses import replace

import pytest

from stepgen.reference.facts import MotorFacts
from stepgen.reference.integer import MotorModel
from stepgen.reference.prediction import predict
from stepgen.reference.sequences import coils_off, phases
from stepgen.reference.stimuli import (
    ClockOn,
    MillisTick,
    SetSpeed,
    Stimulus,
    UpdateCheck,
)

HOLDS = MotorFacts(
    phases("four-wire", "full"), coils_off("four-wire"), 640, "hold", "update-events"
)
CLOCK = ClockOn(100, 1, 0)


def _model(*stimuli: Stimulus) -> MotorModel:
    model = MotorModel(HOLDS)
    for stimulus in stimuli:
        model.apply(stimulus)
    return model


@pytest.mark.parametrize(
    ("call", "code", "status"),
    [
        (SetSpeed(9, 0xC0, 1000, 0, 0, 1, 1), -4, 0x01),
        (SetSpeed(9, 0xC0, 1000, 0, 1, 0, 1), -4, 0x01),
        (SetSpeed(9, 0xC0, 1000, 0, 1, 1, 0), -4, 0x01),
        (SetSpeed(9, 0xC0, 639), -1, 0x05),  # the range is judged before the update events
        (SetSpeed(9, 0xFF, 67_107_841), -2, 0x05),
        (SetSpeed(9, 0x7F, 1000), 1, 0x10),  # and a stop before everything
        (SetSpeed(9, 0xFF, 0), 0, 0x10),
        (SetSpeed(9, 0xFF, 640, 0, 1, 1, 1), 0, 0x00),
        (SetSpeed(9, 0xC0, 67_107_840, 0, 0xFFFF_FFFF, 65_535, 65_535), 0, 0x00),
        (SetSpeed(9, 0xBF, 1000), 0, 0x40),
    ],
)
def test_verdicts(call: SetSpeed, code: int, status: int) -> None:
    """
    Each call returns its code and leaves its status bits.
    """
    model = MotorModel(HOLDS)

    assert model.apply(call) == code
    assert model.status == status


@pytest.mark.parametrize("bit", [0x40, 0x20, 0x10, 0x08, 0x02])
def test_a_constant_library_has_no_update_bits(bit: int) -> None:
    """
    The library of motion ``constant`` refuses each control bit of the update events.
    """
    model = MotorModel(replace(HOLDS, motion="constant"))

    assert model.apply(SetSpeed(9, 0x80 | bit, 1000, 0, 1, 1, 1)) == -3
    assert model.status == 0x01


def test_without_speed_variable_the_rest_has_no_effect() -> None:
    """
    Bits and arguments of the update events change nothing without SPEED_VARIABLE.
    """
    # 0xBA: DRV_EN, VARIABLE_PWR, IRQ_TIMING, UPDATE_STEPS, FASTER.
    model = _model(SetSpeed(50, 0xBA, 1000, 0, 100, 1, 5), CLOCK, UpdateCheck(1500))

    edges = model.advance(4100)

    assert [edge.deadline_cycle for edge in edges] == [50, 1100, 2100, 3100, 4100]
    assert (model.virtual_cycles, model.modification, model.updates_left) == (1000, 0, 0)
    assert model.status == 0x40


def test_with_irq_timing_a_check_applies_no_event() -> None:
    """
    An event that is due waits for the step interrupt, whoever checks in between.
    """
    model = _model(SetSpeed(50, 0xD2, 1000, 0, 100, 1, 5), CLOCK, MillisTick(200, 3))

    model.apply(UpdateCheck(300))
    assert (model.virtual_cycles, model.updates_left) == (1000, 5)
    model.advance(1100)
    assert (model.virtual_cycles, model.updates_left) == (900, 4)


def test_a_new_call_ends_the_events_of_the_old_one() -> None:
    """
    A call while running replaces the speed that an event has chosen, and the events to come.
    """
    # 1100: 900 from 2100 on; called at 1500 with 700: 2100 + 700 = 2800, 3500.
    stimuli: list[Stimulus] = [
        SetSpeed(50, 0xDA, 1000, 0, 100, 1, 5),
        CLOCK,
        SetSpeed(1500, 0x80, 700),
    ]

    run = predict(HOLDS, stimuli, 3500)

    assert [edge.deadline_cycle for edge in run.edges] == [50, 1100, 2100, 2800, 3500]


def test_a_refused_call_keeps_the_events() -> None:
    """
    After a refusal the events of the running call go on.
    """
    # Events at 1100 (900), 2100 (800), 3000 (700): 2100 + 900 = 3000, + 800 = 3800, + 700 = 4500.
    refused = SetSpeed(1500, 0xC0, 1000)
    run = predict(HOLDS, [SetSpeed(50, 0xDA, 1000, 0, 100, 1, 3), CLOCK, refused], 4500)

    assert [edge.deadline_cycle for edge in run.edges[1:]] == [1100, 2100, 3000, 3800, 4500]
    assert (run.return_codes, run.status) == ((0, -4), 0x41)


def test_the_columns_at_rest() -> None:
    """
    An end point leaves the debug columns as they are; a stop and Init empty them.
    """
    model = _model(SetSpeed(50, 0xF8, 1000, 2, 100, 1, 9), CLOCK)
    model.advance(10_000)

    def columns() -> tuple[int, int, int, int | None]:
        return model.virtual_cycles, model.modification, model.updates_left, model.steps_left

    assert columns() == (1100, 200, 8, 0)
    model.apply(SetSpeed(11_000, 0, 0))
    assert columns() == (0, 0, 0, 0)


def test_events_survive_the_wrap_of_millis() -> None:
    """
    The milliseconds since the call are taken modulo 2^32.
    """
    # Called at 2^32 - 1: 0 is one later. Event at 2100: 900 from 3100 on.
    stimuli: list[Stimulus] = [
        MillisTick(0, 4_294_967_295),
        SetSpeed(50, 0xD2, 1000, 0, 100, 1, 1),
        CLOCK,
        MillisTick(1500, 0),
    ]

    run = predict(HOLDS, stimuli, 4000)

    assert [edge.deadline_cycle for edge in run.edges[1:]] == [1100, 2100, 3100, 4000]


@pytest.mark.parametrize(
    "make",
    [
        lambda: SetSpeed(0, 0xC0, 1000, 0, 1 << 32, 1, 1),
        lambda: SetSpeed(0, 0xC0, 1000, 0, 1, 65_536, 1),
        lambda: SetSpeed(0, 0xC0, 1000, 0, 1, 1, 65_536),
    ],
)
def test_values_that_no_argument_holds_are_refused(make: Callable[[], object]) -> None:
    """
    Arguments outside the width of their C type are a ValueError.
    """
    with pytest.raises(ValueError, match="is not within"):
        make()

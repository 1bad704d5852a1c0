"""
What each call returns and leaves alone, derived by hand from the contract.

All with p = 1 and n = 1000, TOP = 999, clock on at 100 with an empty counter: f = 101, so that
the deadlines are 101 + 999 = 1100, 2100, 3100 ... Coils of full steps: 1100, 0110, 0011, 1001.
"""

from collections.abc import Callable

import pytest

from stepgen.reference.contract import Code, Status
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
from stepgen.reference.verdict import fault_bits

HOLDS = MotorFacts(phases("four-wire", "full"), coils_off("four-wire"), 640, "hold")
RELEASES = MotorFacts(phases("four-wire", "full"), coils_off("four-wire"), 640, "release")
CLOCK = ClockOn(100, 1, 0)


def _start(limit: int = 0, control: int = 0x80) -> list[Stimulus]:
    return [SetSpeed(50, control, 1000, limit), CLOCK]


def _wires(edges: tuple[Edge, ...]) -> list[tuple[int, str, str]]:
    return [(edge.deadline_cycle, str(edge.pattern), edge.kind) for edge in edges]


FIRST = [(50, "1100", "energise"), (1100, "0110", "step")]


@pytest.mark.parametrize(
    ("control", "virtual_cycles", "code", "status"),
    [
        (0x80, 639, Code.TOO_FAST, 0x45),
        (0x80, 67_107_841, Code.TOO_SLOW, 0x45),
        (0xC0, 1000, Code.CONTROL, 0x41),
        (0xA0, 1, Code.CONTROL, 0x41),
        (0x90, 1000, Code.CONTROL, 0x41),
        (0x88, 1000, Code.CONTROL, 0x41),
        (0x82, 1000, Code.CONTROL, 0x41),
    ],
)
def test_a_refused_call_changes_nothing_in_the_motion(
    control: int, virtual_cycles: int, code: Code, status: int
) -> None:
    """
    A refusal sets its fault bits while the steps go on; control bits are judged before range.
    """
    stimuli: list[Stimulus] = [*_start(), SetSpeed(1500, control, virtual_cycles, 1)]

    run = predict(HOLDS, stimuli, 3100)

    assert _wires(run.edges) == [*FIRST, (2100, "0011", "step"), (3100, "1001", "step")]
    assert run.return_codes == (0, code)
    assert run.status == status


def test_both_ends_of_the_range_are_accepted() -> None:
    """
    The smallest proven period and 65535 * 1024 cycles are no errors.
    """
    run = predict(HOLDS, [SetSpeed(1, 0x80, 640), SetSpeed(2, 0x80, 67_107_840)], 3)

    assert run.return_codes == (0, 0)


def test_an_accepted_start_clears_the_faults() -> None:
    """
    Status bits last until a start is accepted; a stop adds REACHED to them.
    """
    model = MotorModel(HOLDS)

    assert model.apply(SetSpeed(10, 0x80, 1)) == Code.TOO_FAST
    assert model.status == Status.FAULT | Status.TIMER_DIV_ERROR
    assert model.apply(SetSpeed(20, 0x80, 0)) == Code.FINE
    assert model.status == Status.FAULT | Status.TIMER_DIV_ERROR | Status.REACHED
    assert model.apply(SetSpeed(30, 0x80, 1000)) == Code.FINE
    assert model.status == Status.SPIN_FIXED


def test_hold_and_release_switch_the_coils_at_rest() -> None:
    """
    At rest hold energises the current phase and release switches it off, each once.
    """
    calls: list[Stimulus] = [Hold(10), Hold(20), Release(30), Release(40)]

    run = predict(HOLDS, calls, 50)

    assert _wires(run.edges) == [(10, "1100", "energise"), (30, "0000", "coils-off")]
    assert run.return_codes == (0, 0, 0, 0)


@pytest.mark.parametrize("call", [Hold(1500), Release(1500)])
def test_hold_and_release_are_refused_while_running(call: Stimulus) -> None:
    """
    While running they return -5, set FAULT and do nothing.
    """
    run = predict(RELEASES, [*_start(), call], 2100)

    assert _wires(run.edges) == [*FIRST, (2100, "0011", "step")]
    assert run.return_codes == (0, -5)
    assert run.status == Status.SPIN_FIXED | Status.FAULT


def test_a_stop_with_hold_keeps_coils_off_that_were_off() -> None:
    """
    Hold at rest keeps what there is: a stop after init energises nothing.
    """
    run = predict(HOLDS, [Init(5), SetSpeed(10, 0x80, 0)], 20)

    assert run.edges == ()
    assert run.status == Status.REACHED


def test_init_forgets_everything() -> None:
    """
    Init switches the coils off and zeroes position, phase and status.
    """
    run = predict(HOLDS, [*_start(), Init(1500), Hold(1600)], 100_000)

    expected = [*FIRST, (1500, "0000", "coils-off"), (1600, "1100", "energise")]
    assert _wires(run.edges) == expected
    assert (run.position, run.status, run.running) == (0, 0, False)


@pytest.mark.parametrize(
    ("control", "position", "after"),
    [(0x80, 2_147_483_647, -2_147_483_648), (0x81, -2_147_483_648, 2_147_483_647)],
)
def test_position_wraps_like_an_int32(control: int, position: int, after: int) -> None:
    """
    One step past either end of int32 continues at the other end.
    """
    model = MotorModel(HOLDS, position=position)
    for stimulus in _start(1, control=control):
        model.apply(stimulus)

    edges = model.advance(1100)

    assert [edge.position for edge in edges] == [position, after]
    assert model.position == after


def test_a_clock_with_another_prescaler_paces_nothing() -> None:
    """
    The model does not follow the chip to a prescaler that the call does not ask for.
    """
    run = predict(HOLDS, [SetSpeed(50, 0x80, 1000), ClockOn(100, 8, 0)], 1_000_000)

    assert _wires(run.edges) == FIRST[:1]


def test_a_clock_at_rest_paces_nothing() -> None:
    """
    A timer that runs while the motor rests makes no step.
    """
    run = predict(HOLDS, [CLOCK], 1_000_000)

    assert run.edges == ()


@pytest.mark.parametrize("late", [SetSpeed(99, 0x80, 1000), MillisTick(99, 1), ClockOn(99, 1, 0)])
def test_stimuli_out_of_order_are_refused(late: Stimulus) -> None:
    """
    A stimulus before what has already happened is a mistake of the caller.
    """
    model = MotorModel(HOLDS)
    model.advance(100)

    with pytest.raises(ValueError, match="cycle 99 lies before cycle 100"):
        model.apply(late)


def test_a_service_before_its_deadline_is_refused() -> None:
    """
    No interrupt is served before its flag is set.
    """
    with pytest.raises(ValueError, match="deadline 1100 served too early, at 1099"):
        predict(HOLDS, _start(), 5000, lambda deadline: deadline - 1)


@pytest.mark.parametrize(
    "make",
    [
        lambda: SetSpeed(0, 256, 1000),
        lambda: SetSpeed(0, 0x80, 1 << 64),
        lambda: SetSpeed(0, 0x80, 1000, -1),
        lambda: ClockOn(0, 2, 0),
        lambda: ClockOn(0, 1, 65_536),
        lambda: MillisTick(0, 1 << 32),
        lambda: MotorFacts(HOLDS.phases, HOLDS.coils_off, 3, "hold"),
    ],
)
def test_values_that_no_register_holds_are_refused(make: Callable[[], object]) -> None:
    """
    Stimuli and facts outside the width of their C type or register are a ValueError.
    """
    with pytest.raises(ValueError, match=r"is (not within|none of|out of range)"):
        make()


def test_each_edge_names_the_call_that_made_it() -> None:
    """
    Coils that a call switches are its own, and so is the turn back to phase 0 by Init.
    """
    calls: list[Stimulus] = [
        SetSpeed(50, 0x80, 1000, 1),  # call 0: energise, and the step at 1100
        CLOCK,
        Release(1200),  # call 1: off
        Hold(1300),  # call 2: on again
        SetSpeed(1400, 0, 0),  # call 3: a stop without DRV_EN, off
        Hold(1500),  # call 4: on
        Init(1600),  # call 5: off
    ]

    run = predict(HOLDS, calls, until_cycle=2000)

    assert [edge.call_index for edge in run.edges] == [0, 0, 1, 2, 3, 4, 5]


@pytest.mark.parametrize("code", [Code.FINE, Code.NOT_DRIVEN])
def test_a_call_that_is_not_refused_is_no_fault(code: Code) -> None:
    """
    0 and warnings set no fault bits.
    """
    assert fault_bits(code) == Status(0)

"""
Limits of an axis, by hand from the contract: switches that are met, ranges, and the way home.

The ladder is that of `tests.reference.test_reference_trapezoid`, whose intervals are 1000, 900,
800, 700 clocks and so on. A call at cycle 1000 has its first step due at 2000.
"""

from dataclasses import replace
from itertools import pairwise

import pytest

from stepgen.reference.contract import Code
from stepgen.reference.end_stops import End, EndStopFacts, Fault, HomingFacts
from stepgen.reference.facts import MotorFacts
from stepgen.reference.stimuli import (
    AxisStimulus,
    ChannelSet,
    ClearFault,
    EdgeKind,
    EmergencyStop,
    Halt,
    Home,
    Init,
    Move,
    MoveTo,
    QueueMoveTo,
    RunOn,
    SetPace,
    SetPosition,
    Stop,
    Switches,
)
from stepgen.reference.trapezoid import TrapezoidModel
from tests.reference.test_reference_trapezoid import facts, model_of, started, steps

BOTH: frozenset[End] = frozenset({"low", "high"})
LOW, HIGH, NONE = frozenset({"low"}), frozenset({"high"}), frozenset[str]()
# Fast is the level of 700 clocks, 3 steps up; slow the lowest one.
HOMING = HomingFacts("low", 700 << 8, 1000 << 8, back_off=3, travel=20, position=0, park=0)


def limited(
    span: tuple[int, int] | None = None,
    homing: HomingFacts | None = None,
    *,
    releases: bool = False,
) -> MotorFacts:
    """
    Return the axis with a switch at each end.
    """
    return replace(facts(releases=releases), end_stops=EndStopFacts(BOTH, span, homing))


def after(*stimuli: AxisStimulus, axis: MotorFacts | None = None) -> TrapezoidModel:
    """
    Return the model of *axis* after the first of *stimuli*, whose first step is due at 2000.
    """
    first, *others = stimuli
    return model_of(first, ChannelSet(1_020, 980), *others, axis=axis or limited())


@pytest.mark.parametrize(("direction", "end"), [(1, HIGH), (-1, LOW)])
def test_a_step_that_leads_into_a_switch_is_not_made(direction: int, end: frozenset[str]) -> None:
    """
    The switch is pressed between the steps of 2000 and 2900: the axis stays at one step.
    """
    model = after(RunOn(1_000, direction), Switches(2_500, end))

    assert steps(model) == [2_000]
    assert (model.position, model.fault, model.running) == (direction, Fault.LIMIT, False)
    assert model.target == direction


def test_a_switch_is_seen_by_the_interrupt_of_its_cycle() -> None:
    """
    What is pressed at the service of a step stops that step, a cycle later the next one.
    """
    assert steps(after(RunOn(1_000, 1), Switches(2_900, HIGH))) == [2_000]
    assert steps(after(RunOn(1_000, 1), Switches(2_901, HIGH))) == [2_000, 2_900]


def test_the_switch_behind_does_not_matter() -> None:
    """
    Going away from a pressed switch makes all steps.
    """
    model = after(Move(1_000, 2), Switches(1_500, LOW))

    assert (len(steps(model)), model.position, model.fault) == (2, 2, Fault.NONE)


def test_the_current_goes_off_at_a_switch_if_it_does_at_rest() -> None:
    """
    The interrupt of the step that is not made switches the coils off, as a halt does.
    """
    model = after(RunOn(1_000, 1), Switches(2_500, HIGH), axis=limited(releases=True))
    kinds = [(edge.deadline_cycle, edge.kind) for edge in model.advance(9_000)]

    assert kinds == [
        (1_000, EdgeKind.ENERGISE),
        (2_000, EdgeKind.STEP),
        (2_900, EdgeKind.COILS_OFF),
    ]


def test_a_fault_stays_until_it_is_cleared() -> None:
    """
    All moves and homing are refused, then not; what reads and halts is not.
    """
    model = after(RunOn(1_000, 1), Switches(2_500, HIGH), axis=limited(homing=HOMING))
    model.advance(5_000)
    moves = (Move(5_000, 1), MoveTo(5_000, 1), QueueMoveTo(5_000, 1), RunOn(5_000, -1))

    assert {model.apply(move) for move in (*moves, Home(5_000))} == {Code.FAULT}
    assert model.apply(Halt(5_000)) is Code.FINE
    assert model.apply(ClearFault(5_001)) is Code.FINE
    assert model.apply(RunOn(5_002, -1)) is Code.FINE


def test_an_emergency_stops_at_once_and_leaves_a_fault() -> None:
    """
    No step follows, the position is kept, and Init forgets the fault.
    """
    model = after(RunOn(1_000, 1), EmergencyStop(2_100))

    assert (steps(model), model.position, model.fault) == ([2_000], 1, Fault.EMERGENCY)
    model.apply(Init(1_000_000))
    assert model.fault is Fault.NONE


def test_a_range_refuses_what_leads_beyond() -> None:
    """
    From -2 to 3, both included; the position cannot be set beyond it either.
    """
    model = model_of(axis=limited((-2, 3)))

    assert [model.apply(MoveTo(10, place)) for place in (-3, 4)] == [Code.RANGE] * 2
    assert model.apply(QueueMoveTo(10, 4)) is Code.RANGE
    assert model.apply(Move(10, 4)) is Code.RANGE
    assert model.apply(Move(10, (1 << 31) - 1)) is Code.RANGE
    assert model.apply(SetPosition(10, -3)) is Code.RANGE
    assert model.apply(SetPosition(10, -2)) is Code.FINE
    assert model.apply(MoveTo(10, 3)) is Code.FINE


def test_a_run_ends_where_the_range_does() -> None:
    """
    There is nothing without an end: forward is to 3.
    """
    model = after(RunOn(1_000, 1), axis=limited((-2, 3)))

    assert (model.target, len(steps(model)), model.position) == (3, 3, 3)


def test_homing_step_by_step() -> None:
    """
    To the switch, 3 steps behind it, back, slowly again, and to position 0.

    The switch is seen at 3700, at position -2. The step that was due is made, and two more down the
    ladder, 900 and 1000: -5. The way back to -2 + 3 = 1 are 6 steps, up and down again. Slowly,
    1000 clocks each, to -1, where the switch is seen at 14000; the step to -2 is made. That is one
    behind the switch, so position -1, and the last step leads to 0.
    """
    model = after(
        Home(1_000),
        Switches(3_000, LOW),
        Switches(7_000, NONE),
        Switches(13_500, LOW),
        Switches(14_500, NONE),
        axis=limited(homing=HOMING),
    )

    assert steps(model) == [
        *(2_000, 2_900, 3_700, 4_600, 5_600),
        *(6_600, 7_500, 8_300, 9_100, 10_000, 11_000),
        *(12_000, 13_000, 14_000),
        15_000,
    ]
    assert (model.position, model.homed, model.fault) == (0, True, Fault.NONE)


def test_the_step_at_the_switch_comes_when_its_second_interrupt_does() -> None:
    """
    It is served later, but the next one is due as if it had not been.
    """
    model = TrapezoidModel(limited(homing=HOMING), again_cycle=lambda deadline: deadline + 300)
    for stimulus in (Home(1_000), ChannelSet(1_020, 980), Switches(3_000, LOW)):
        model.apply(stimulus)

    assert steps(model, 3_999) == [2_000, 2_900]
    assert steps(model, 5_600) == [3_700, 4_600, 5_600]


def test_homing_gives_up_after_its_travel() -> None:
    """
    Twenty steps without a switch leave a fault, and no home.
    """
    model = after(Home(1_000), axis=limited(homing=HOMING))

    assert (len(steps(model)), model.position) == (20, -20)
    assert (model.fault, model.homed, model.running) == (Fault.HOMING, False, False)


def test_homing_gives_up_where_the_switch_stays_pressed() -> None:
    """
    The way back ends at 1, with the switch still pressed.
    """
    model = after(Home(1_000), Switches(3_000, LOW), axis=limited(homing=HOMING))

    assert (len(steps(model)), model.position, model.fault) == (11, 1, Fault.HOMING)


def test_homing_gives_up_where_the_switch_is_not_seen_again() -> None:
    """
    The second way to it is 6 steps, twice the way back from where it was seen.
    """
    model = after(
        Home(1_000), Switches(3_000, LOW), Switches(7_000, NONE), axis=limited(homing=HOMING)
    )

    assert (len(steps(model)), model.position, model.fault) == (17, -5, Fault.HOMING)


def test_the_other_switch_ends_homing() -> None:
    """
    On the way back it is an unexpected limit.
    """
    model = after(
        Home(1_000), Switches(3_000, LOW), Switches(7_000, HIGH), axis=limited(homing=HOMING)
    )

    assert (steps(model)[-1], model.position, model.fault) == (6_600, -4, Fault.LIMIT)


def test_what_is_refused_while_homing() -> None:
    """
    Moves, speeds and homing itself are refused; a stop is not, and ends it.
    """
    model = after(Home(1_000), axis=limited(homing=HOMING))
    for call in (Move(1_500, 1), MoveTo(1_500, 1), QueueMoveTo(1_500, 1), RunOn(1_500, 1)):
        assert model.apply(call) is Code.HOMING
    assert model.apply(SetPace(1_500, 600 << 8)) is Code.HOMING
    assert model.apply(SetPosition(1_500, 1)) is Code.RUNNING
    assert model.apply(Home(1_500)) is Code.RUNNING
    assert model.apply(Stop(2_100)) is Code.FINE
    model.advance(10_000)

    assert (model.running, model.fault, model.homed) == (False, Fault.NONE, False)


def test_the_speed_of_the_sketch_counts_again_after_homing() -> None:
    """
    It was 900 clocks; a move after a halt on the way home has that interval, not homing's 700.
    """
    model = model_of(SetPace(10, 900 << 8), axis=limited(homing=HOMING))
    model.apply(Home(1_000))
    model.apply(ChannelSet(1_020, 980))
    model.apply(Halt(2_100))
    model.apply(Move(11_000, 9))
    model.apply(ChannelSet(11_020, 980))
    deadlines = steps(model)

    assert min(b - a for a, b in pairwise(deadlines[1:])) == 900


def test_an_axis_without_limits_knows_nothing_of_them() -> None:
    """
    Without facts of limits a pressed switch stops nothing.
    """
    model = started(RunOn(1_000, 1), Switches(1_500, frozenset()))

    assert steps(model, 3_000) == [2_000, 2_900]
    with pytest.raises(ValueError, match="finds home"):
        model.apply(Home(3_000))

"""
Scenario files: whatever a scenario holds is written and read back, and faults have their place.
"""

from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from stepgen import api
from stepgen.errors import StepgenError
from stepgen.plan.model import Plan
from stepgen.verify.bench import (
    OF_AXES,
    OF_EVERY_MOTOR,
    OF_LIMITS,
    Call,
    CallKind,
    Context,
    Loop,
    has_call,
)
from stepgen.verify.scenario_file import default_scenario, load_scenario, scenario_text
from stepgen.verify.scenarios import Action, Scenario, Wait

SPECS = Path(__file__).parents[2] / "specs"
CONSTANT = api.plan(SPECS / "mega_pan_tilt.yaml")
TIMED = api.plan(SPECS / "uno_command_timeout.yaml")
CHANGING = api.plan(SPECS / "uno_variable_speed.yaml")
ALWAYS_ENABLED = api.plan(SPECS / "uno_drv8825.yaml")
AXIS = api.plan(SPECS / "uno_trapezoid.yaml")
HOMING = api.plan(SPECS / "uno_homing.yaml")
BYTES, WORDS, LONGS = (st.integers(0, (1 << bits) - 1) for bits in (8, 16, 32))
LINES = st.text(st.characters(exclude_categories=("C", "Zl", "Zp")), min_size=1, max_size=40)


def actions(plan: Plan) -> st.SearchStrategy[Action]:
    """
    Return waits, and all calls with all arguments that the motors of *plan* have.
    """
    if plan in (AXIS, HOMING):
        return axis_actions(plan)
    changes = plan.motors[0].motion.kind == "update-events"
    motors = st.integers(0, len(plan.motors) - 1)
    update = (LONGS, WORDS, WORDS) if changes else ()
    of_changing = {CallKind.UPDATE_CHECK} if changes else set()
    if plan.motors[0].command_timeout_ms is not None:
        of_changing.add(CallKind.KEEP_ALIVE)
    kinds = st.sampled_from(
        sorted(of_changing | {CallKind.HOLD, CallKind.RELEASE, CallKind.READ, CallKind.INIT})
    )
    every: list[st.SearchStrategy[Action]] = [
        st.builds(Wait, st.integers(0, 1 << 40)),
        st.builds(Call, kinds, motors),
        st.builds(Call, st.just(CallKind.SET_SPEED), motors, BYTES, LONGS, LONGS, *update),
        st.builds(Call, st.just(CallKind.DIVIDE_CLOCK), st.just(0), st.integers(0, 8)),
        st.builds(Call, st.just(CallKind.TOP_PER_SECOND), top=WORDS),
        st.just(Call(CallKind.CLOCKS_PER_SECOND)),
    ]
    if changes:
        every.append(st.builds(Call, st.just(CallKind.CALLBACKS), motors, st.integers(0, 3)))
    return st.one_of(every)


def axis_actions(plan: Plan) -> st.SearchStrategy[Action]:
    """
    Return waits, and all calls that the axis of *plan* has, with all steps and paces.
    """
    with_steps = [CallKind.MOVE_TO, CallKind.MOVE, CallKind.QUEUE_MOVE_TO, CallKind.SET_POSITION]
    every = {*OF_AXES, *OF_EVERY_MOTOR, *OF_LIMITS} - {*with_steps, CallKind.SET_PACE}
    others = sorted(kind for kind in every if has_call(plan.motors[0], kind))
    others = [kind for kind in others if kind is not CallKind.PRESS]
    presses = [st.builds(Call, st.just(CallKind.PRESS), control=st.integers(0, 255))]
    return st.one_of(
        *(presses if has_call(plan.motors[0], CallKind.PRESS) else []),
        st.builds(Wait, st.integers(0, 1 << 40)),
        st.builds(Call, st.sampled_from(with_steps), steps=st.integers(-(1 << 31), (1 << 31) - 1)),
        st.builds(Call, st.just(CallKind.SET_PACE), top=LONGS),
        st.builds(Call, st.sampled_from(others), context=st.sampled_from([0, 2]).map(Context)),
    )


def scenarios(plan: Plan) -> st.SearchStrategy[Scenario]:
    """
    Return scenarios for the motors of *plan*, with a name of one line.
    """
    steps = st.lists(actions(plan), min_size=1, max_size=12).map(tuple)
    return st.builds(Scenario, LINES, st.sampled_from(Loop), steps)


@given(data=st.data(), plan=st.sampled_from([CONSTANT, CHANGING, TIMED, AXIS, HOMING]))
def test_a_scenario_is_read_back_as_it_was_written(
    tmp_path_factory: pytest.TempPathFactory, data: st.DataObject, plan: Plan
) -> None:
    """
    Every call with every argument, every wait, every loop and the name come back equal.
    """
    scenario = data.draw(scenarios(plan))
    file = tmp_path_factory.getbasetemp() / "round_trip.yaml"
    file.write_text(scenario_text(scenario, plan), encoding="utf-8")

    assert load_scenario(file, plan) == scenario


def test_bits_have_names_and_what_the_library_lacks_is_a_number() -> None:
    """
    The library without update events has no FASTER: the byte is written as it is passed.
    """
    calls = (Call(CallKind.SET_SPEED, 1, 0x85, 640), Call(CallKind.SET_SPEED, 0, 0x82, 640))

    text = scenario_text(Scenario("bits", Loop.BUSY, calls), CONSTANT)

    assert "control: [DRV_EN, ENDPOINT_MILLIS, DIRECTION], top: 640" in text
    assert "control: 130, top: 640" in text


@pytest.mark.parametrize(
    ("step", "wrong", "reason"),
    [
        ("{call: set_speed, control: [FASTER]}", "FASTER", "has no update events; give it"),
        ("{call: set_speed, control: [FAULT]}", "FAULT", "is no bit of set_speed; write one"),
        ("{call: set_speed, control: [DRVEN]}", "DRVEN", "write 'DRV_EN', "),
        ("{call: set_speed, control: 256}", "256", "write 255 or less"),
        ("{call: set_speed, count: 3}", "3", "has no update events; give it"),
        ("{call: update_check}", "update_check", "has no update events; give it"),
        ("{call: hold, motor: roll}", "roll", "is no motor of this spec; it has pan, tilt"),
        ("{call: hold, top: 3}", "3", "top is no argument of hold; it has motor"),
        ("{call: clocks_per_second, top: 3}", "3", "of clocks_per_second; it has none"),
        ("{call: watchdog}", "watchdog", "there is no watchdog; give the spec `watchdog_ms`"),
        ("{call: divide_clock, control: [FAULT]}", "FAULT", "bit of divide_clock; write a number"),
        ("{call: jump}", "jump", "write 'set_speed', "),
        ("{wait_ms: 1, wait_clocks: 2}", "{wait", "write call, wait_ms or wait_clocks"),
        ("{wait_clocks: -1}", "-1", "write 0 or more"),
    ],
)
def test_what_a_motor_lacks_is_refused_with_its_place(
    tmp_path: Path, step: str, wrong: str, reason: str
) -> None:
    """
    Each fault names line and column, and a way out.
    """
    line = f"  - {step}"
    file = tmp_path / "wrong.yaml"
    file.write_text(f"loop: busy\nsteps:\n{line}\n")

    with pytest.raises(StepgenError) as refusal:
        load_scenario(file, CONSTANT)

    assert f"wrong.yaml:3:{line.index(wrong) + 1}: error: " in str(refusal.value)
    assert reason in str(refusal.value)
    assert len(refusal.value.faults) == 1


def test_a_scenario_without_a_step_is_refused(tmp_path: Path) -> None:
    """
    An empty list of steps is a fault, with what to write.
    """
    file = tmp_path / "empty.yaml"
    file.write_text("steps: []\n")

    with pytest.raises(StepgenError, match=r"empty.yaml:1:1: error: steps is empty; write a call"):
        load_scenario(file, CONSTANT)


def test_a_byte_that_the_library_must_refuse_can_be_given_as_a_number(tmp_path: Path) -> None:
    """
    What the contract refuses is a scenario too: the call returns its error.
    """
    file = tmp_path / "raw.yaml"
    file.write_text("steps: [{call: set_speed, control: 0xC2, top: 640}, {wait_clocks: 7}]")

    scenario = load_scenario(file, CONSTANT)

    assert scenario.actions == (Call(CallKind.SET_SPEED, 0, 0xC2, 640), Wait(7))


@pytest.mark.parametrize(
    ("plan", "call", "way_out"),
    [
        (CONSTANT, "move_to", "give it `motion: {kind: trapezoid, ...}`, or write set_speed"),
        (CONSTANT, "stop", "give it `motion: {kind: trapezoid, ...}`, or write set_speed"),
        (AXIS, "set_speed", "write move_to, run_forward, stop or another of those of an axis"),
        (AXIS, "home", "give it `limits` with `homing`, or leave this out"),
        (AXIS, "press", "give it `limits` with a switch, or leave this out"),
        (AXIS, "clear_fault", "give it `limits`, or leave this out"),
        (AXIS, "update_check", "write move_to, run_forward, stop or another of those of an axis"),
    ],
)
def test_calls_of_the_other_kind_of_motor_are_refused(
    tmp_path: Path, plan: Plan, call: str, way_out: str
) -> None:
    """
    An axis has its own calls, and they are no other motor's; the fault says which there are.
    """
    file = tmp_path / "other.yaml"
    file.write_text(f"steps:\n  - {{call: {call}}}\n")

    with pytest.raises(StepgenError) as refusal:
        load_scenario(file, plan)

    assert f"other.yaml:2:{len('  - {call: ') + 1}: error: " in str(refusal.value)
    assert way_out in str(refusal.value)
    assert len(refusal.value.faults) == 1


def test_a_queue_that_an_axis_lacks_is_refused(tmp_path: Path) -> None:
    """
    Without a queue there is no such function.
    """
    motor = AXIS.motors[0]
    plan = replace(AXIS, motors=(replace(motor, motion=replace(motor.motion, queue=0)),))
    file = tmp_path / "queue.yaml"
    file.write_text("steps:\n  - {call: queue_move_to, steps: 3}\n")

    with pytest.raises(StepgenError, match="give its motion a `queue`, or write move_to"):
        load_scenario(file, plan)


def test_an_axis_goes_eight_steps_there_and_back_by_default() -> None:
    """
    A first look moves it by its own calls.
    """
    calls = [action for action in default_scenario(AXIS).actions if isinstance(action, Call)]

    assert [(call.kind, call.steps) for call in calls] == [
        (CallKind.MOVE, 8),
        (CallKind.MOVE, -8),
        (CallKind.READ, 0),
    ]


@pytest.mark.parametrize("call", ["hold", "release"])
def test_a_motor_without_enable_cannot_be_held_or_released(tmp_path: Path, call: str) -> None:
    """
    A driver that is always enabled has no such function: the file is refused, with its place.
    """
    file = tmp_path / "hold.yaml"
    file.write_text(f"steps:\n  - {{call: {call}}}\n")

    with pytest.raises(StepgenError, match="has no ENABLE to switch; leave this out") as refusal:
        load_scenario(file, ALWAYS_ENABLED)

    assert f"hold.yaml:2:{len('  - {call: ') + 1}: error: " in str(refusal.value)


def test_calls_that_a_motor_lacks_are_not_written() -> None:
    """
    A general scenario, written for a motor without ENABLE, can be read back.
    """
    switched = Scenario("any", Loop.SLEEP, (Call(CallKind.HOLD), Wait(5), Call(CallKind.RELEASE)))

    assert "hold" in scenario_text(switched, CHANGING)
    assert "call" not in scenario_text(switched, ALWAYS_ENABLED)

"""
A scenario as a YAML file: with the names of motors and control bits, read and written.

Whatever a scenario can hold can be written and is read back equal, so that a run that failed
can be handed to ``stepgen simulate``.
"""

from collections.abc import Iterator, Mapping
from io import StringIO
from pathlib import Path
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.comments import CommentedMap

from stepgen.errors import Fault, StepgenError
from stepgen.plan.model import MotorPlan, Plan
from stepgen.reference.contract import ALL_CONTROL_BITS, CONTROL_BITS, Control
from stepgen.reference.timer import FRACTIONS
from stepgen.spec.load import load_model
from stepgen.verify.bench import SWITCHING, Call, CallKind, Context, Loop, has_call, is_axis
from stepgen.verify.ladders import ladder_of
from stepgen.verify.scenario_model import (
    UPDATE_FIELDS,
    CallStep,
    ScenarioSpec,
    WaitStep,
    bits_of,
    fields_of,
)
from stepgen.verify.scenarios import Action, Scenario, Wait

_OF_UPDATE_EVENTS = {CallKind.UPDATE_CHECK, CallKind.CALLBACKS}
_OF_LIMITS = {
    CallKind.HOME: " with `homing`",
    CallKind.EMERGENCY_STOP: "",
    CallKind.CLEAR_FAULT: "",
    CallKind.PRESS: " with a switch",
}
_WAY_OUT = "give it `motion: update-events`, or leave this out"


def load_scenario(path: Path, plan: Plan) -> Scenario:
    """
    Return the scenario in *path* for the motors of *plan*; without a name it has the file's.

    Raises:
        StepgenError: All faults of the file, each with its place.
    """
    document, spec = load_model(path, ScenarioSpec)
    faults = []
    actions: list[Action] = []
    for index, step in enumerate(spec.steps):
        if isinstance(step, WaitStep):
            actions.append(step.action(plan.board.f_cpu_hz))
            continue
        found = list(_faults(step, plan))
        for location, reason in found:
            place, text = document.place(("steps", index, *location))
            faults.append(Fault(place, text, reason))
        if not found:
            actions.append(_call(step, plan))
    if faults:
        raise StepgenError(faults)
    return Scenario(spec.name or path.stem, Loop[spec.loop.upper()], tuple(actions))


def scenario_text(scenario: Scenario, plan: Plan) -> str:
    """
    Return *scenario* for the motors of *plan* as YAML, from which `load_scenario` makes it again.

    Calls that a motor does not have are left out, as where it runs.
    """
    steps = [_step(action, plan) for action in scenario.actions_on(plan)]
    data = {"name": scenario.name, "loop": scenario.loop.name.lower(), "steps": steps}
    yaml = YAML()
    yaml.width = 1 << 16
    yaml.indent(mapping=2, sequence=4, offset=2)
    stream = StringIO()
    yaml.dump(data, stream)
    return stream.getvalue()


def default_scenario(plan: Plan) -> Scenario:
    """
    Return a first look: each motor makes eight steps forward and eight back.

    200 a second; an axis takes its time from rest to rest.
    """
    actions: list[Action] = []
    for index, motor in enumerate(plan.motors):
        top = max(plan.board.f_cpu_hz // 200, _first_interval_cycles(motor))
        for call in _there_and_back(motor, index, top):
            actions += [call, Wait(11 * top)]
        actions.append(Call(CallKind.READ, index))
    return Scenario("eight steps there and back", Loop.SLEEP, tuple(actions))


def _first_interval_cycles(motor: MotorPlan) -> int:
    """
    Return the longest interval of an axis that moves at full speed; 0 for another motor.
    """
    ladder = ladder_of(motor.motion)
    return ladder.first_interval_256 // FRACTIONS if ladder else 0


def _there_and_back(motor: MotorPlan, index: int, top: int) -> tuple[Call, Call]:
    """
    Return the calls that make eight steps forward and eight back.
    """
    if is_axis(motor):
        return Call(CallKind.MOVE, index, steps=8), Call(CallKind.MOVE, index, steps=-8)
    drive, back = int(Control.DRV_EN), int(Control.DRV_EN | Control.DIRECTION)
    return (
        Call(CallKind.SET_SPEED, index, drive, top, 8),
        Call(CallKind.SET_SPEED, index, back, top, 8),
    )


def _faults(step: CallStep, plan: Plan) -> Iterator[tuple[tuple[str | int, ...], str]]:
    """
    Yield where *step* asks for what its call or its motor does not have, and the way out.
    """
    fields, bits = fields_of(step.kind), bits_of(step.kind)
    for field in sorted(step.model_fields_set - {"call", *fields}):
        had = f"it has {', '.join(fields)}" if fields else "it has none"
        yield (field,), f"{field} is no argument of {step.call}; {had}"
    for index, bit in enumerate(step.bits):
        if bit not in bits and "control" in fields:
            ways = f"one of {', '.join(bits)}, or a number" if bits else "a number"
            yield ("control", index), f"is no bit of {step.call}; write {ways}"
    if step.kind is CallKind.WATCHDOG and plan.watchdog_ms is None:
        yield (
            ("call",),
            "there is no watchdog; give the spec `watchdog_ms`, or leave this out",
        )
    motors = {motor.name: motor for motor in plan.motors}
    if step.motor is not None and step.motor not in motors:
        yield ("motor",), f"is no motor of this spec; it has {', '.join(motors)}"
    else:
        motor = motors[step.motor] if step.motor is not None else plan.motors[0]
        yield from _lacks(step, motor, bits)


def _lacks(
    step: CallStep, motor: MotorPlan, bits: Mapping[str, int]
) -> Iterator[tuple[tuple[str | int, ...], str]]:
    """
    Yield what *motor* has not: the call, a switch for its current, a time-out, or update events.
    """
    if step.kind not in SWITCHING and not has_call(motor, step.kind):
        yield (
            ("call",),
            f"the motor {motor.name} has no such call; {_way_to_call(motor, step.kind)}",
        )
        return
    if step.kind in SWITCHING and not motor.switches_current:
        yield ("call",), f"the motor {motor.name} has no ENABLE to switch; leave this out"
    if step.kind is CallKind.KEEP_ALIVE and motor.command_timeout_ms is None:
        way_out = "give it `command_timeout_ms`, or leave this out"
        yield ("call",), f"the motor {motor.name} has no command time-out; {way_out}"
    if _control_bits(motor) != ALL_CONTROL_BITS:
        yield from _lacks_events(step, motor, bits)


def _way_to_call(motor: MotorPlan, kind: CallKind) -> str:
    """
    Return what to do about the call *kind*, which the API of *motor* has not.
    """
    if not is_axis(motor):
        return "give it `motion: {kind: trapezoid, ...}`, or write set_speed"
    if kind is CallKind.QUEUE_MOVE_TO:
        return "give its motion a `queue`, or write move_to"
    if kind in _OF_LIMITS:
        return f"give it `limits`{_OF_LIMITS[kind]}, or leave this out"
    return "write move_to, run_forward, stop or another of those of an axis"


def _lacks_events(
    step: CallStep, motor: MotorPlan, bits: Mapping[str, int]
) -> Iterator[tuple[tuple[str | int, ...], str]]:
    """
    Yield what *motor*, which has no update events, cannot do.
    """
    known = _control_bits(motor)
    reason = f"the motor {motor.name} has no update events; {_WAY_OUT}"
    if step.kind in _OF_UPDATE_EVENTS:
        yield ("call",), reason
    if step.context == "callback":
        yield ("context",), reason
    if step.kind is CallKind.SET_SPEED:
        for index, bit in enumerate(step.bits):
            if bits.get(bit, 0) & ~known:
                yield (
                    ("control", index),
                    f"{reason}, or write control as a number to see it refused",
                )
        for field in UPDATE_FIELDS:
            if field in step.model_fields_set:
                yield (field,), reason


def _call(step: CallStep, plan: Plan) -> Call:
    names = [motor.name for motor in plan.motors]
    return Call(
        step.kind,
        names.index(step.motor) if step.motor is not None else 0,
        step.control_byte,
        step.top,
        step.limit,
        step.modification,
        step.interval,
        step.count,
        steps=step.steps,
        context=Context[step.context.upper()],
    )


def _step(action: Action, plan: Plan) -> CommentedMap:
    """
    Return *action* as one line of YAML; what is as it is by default is left out.
    """
    step = CommentedMap()
    step.fa.set_flow_style()
    if isinstance(action, Wait):
        step["wait_clocks"] = action.cycles
        return step
    step["call"] = action.kind.name.lower()
    for field in fields_of(action.kind):
        value: Any = getattr(action, field)
        if field == "motor":
            value = plan.motors[action.motor].name if len(plan.motors) > 1 else None
        elif field == "control":
            value = _control(action, plan)
        elif field == "context":
            value = action.context.name.lower() if action.context else None
        if value:
            step[field] = value
    return step


def _control(call: Call, plan: Plan) -> int | list[str]:
    """
    Return the names of the bits of *call*, or the number if the library lacks one of them.
    """
    bits = bits_of(call.kind)
    known = sum(bits.values())
    if call.kind is CallKind.SET_SPEED:
        known = _control_bits(plan.motors[call.motor])
    if call.control & ~known:
        return call.control
    return [name for name, bit in bits.items() if call.control & bit]


def _control_bits(motor: MotorPlan) -> int:
    """
    Return the control bits that the library of *motor* has.
    """
    return next(bits for kind, bits in CONTROL_BITS.items() if kind == motor.motion.kind)

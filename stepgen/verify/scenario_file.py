"""
A scenario that the user wrote: YAML, with the names of motors and of control bits.
"""

from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field

from stepgen.errors import Fault, StepgenError
from stepgen.plan.model import Plan
from stepgen.reference.contract import Control
from stepgen.spec.base import SpecModel
from stepgen.spec.load import load_model
from stepgen.verify.bench import Call, CallKind, Loop
from stepgen.verify.scenarios import Action, Scenario, Wait

_UINT32 = Field(ge=0, le=0xFFFF_FFFF)
_LONGEST_WAIT_MS = 3_600_000
_CALLS = {
    "set_speed": CallKind.SET_SPEED,
    "hold": CallKind.HOLD,
    "release": CallKind.RELEASE,
    "read": CallKind.READ,
    "init": CallKind.INIT,
}


class CallStep(SpecModel):
    """
    ``{call: set_speed, control: [DRV_EN], top: 20000, limit: 10}``.
    """

    call: Literal["set_speed", "hold", "release", "read", "init"]
    motor: str | None = None
    control: Annotated[
        tuple[Literal["DRV_EN", "ENDPOINT_MILLIS", "DIRECTION"], ...], Field(strict=False)
    ] = ()
    top: Annotated[int, _UINT32] = 0
    limit: Annotated[int, _UINT32] = 0


class WaitStep(SpecModel):
    """
    ``{wait_ms: 20}``.
    """

    wait_ms: Annotated[int | float, Field(gt=0, le=_LONGEST_WAIT_MS)]


class ScenarioSpec(SpecModel):
    """
    What the sketch does between calls, and the steps in their order.
    """

    loop: Literal["sleep", "busy", "hostile"] = "sleep"
    steps: Annotated[tuple[CallStep | WaitStep, ...], Field(min_length=1, strict=False)]


def load_scenario(path: Path, plan: Plan) -> Scenario:
    """
    Return the scenario in *path* for the motors of *plan*.

    Raises:
        StepgenError: All faults of the file, each with its place.
    """
    document, spec = load_model(path, ScenarioSpec)
    names = [motor.name for motor in plan.motors]
    faults = []
    actions: list[Action] = []
    for index, step in enumerate(spec.steps):
        if isinstance(step, WaitStep):
            actions.append(Wait(round(step.wait_ms * plan.board.f_cpu_hz / 1000)))
        elif step.motor is not None and step.motor not in names:
            place, text = document.place(("steps", index, "motor"))
            faults.append(Fault(place, text, f"is no motor of this spec; it has {names}"))
        else:
            motor = names.index(step.motor) if step.motor else 0
            control = sum(int(Control[bit]) for bit in set(step.control))
            actions.append(Call(_CALLS[step.call], motor, control, step.top, step.limit))
    if faults:
        raise StepgenError(faults)
    return Scenario(path.stem, Loop[spec.loop.upper()], tuple(actions))


def default_scenario(plan: Plan) -> Scenario:
    """
    Return a first look: each motor makes eight steps forward and eight back, 200 a second.
    """
    top = plan.board.f_cpu_hz // 200
    drive, back = int(Control.DRV_EN), int(Control.DRV_EN | Control.DIRECTION)
    actions: list[Action] = []
    for motor in range(len(plan.motors)):
        for control in (drive, back):
            actions.append(Call(CallKind.SET_SPEED, motor, control, top, 8))
            actions.append(Wait(11 * top))
        actions.append(Call(CallKind.READ, motor))
    return Scenario("eight steps there and back", Loop.SLEEP, tuple(actions))

"""
What a scenario's YAML file may hold.
"""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Annotated, Literal, Self

from pydantic import Discriminator, Field, Tag, model_validator

from stepgen.reference.contract import ALL_CONTROL_BITS, Control
from stepgen.spec.base import SpecModel
from stepgen.verify.bench import CallKind
from stepgen.verify.scenarios import Wait

UPDATE_FIELDS = ("modification", "interval", "count")
_LONGEST_WAIT_MS = 3_600_000
_LONGEST_WAIT_CLOCKS = 1 << 40
_ONE_LINE = r"^[^\x00-\x1f\x7f-\x9f]*$"
# Which fields each call has, in their order.
_FIELDS: Mapping[CallKind, tuple[str, ...]] = MappingProxyType(
    {
        CallKind.SET_SPEED: ("motor", "control", "top", "limit", *UPDATE_FIELDS, "context"),
        CallKind.CALLBACKS: ("motor", "control", "context"),
        CallKind.HOLD_UP: ("top",),
        CallKind.WATCHDOG: ("control", "context"),
        CallKind.DIVIDE_CLOCK: ("control",),
        CallKind.TOP_PER_SECOND: ("top",),
        CallKind.CLOCKS_PER_SECOND: (),
        CallKind.SET_PACE: ("motor", "top", "context"),
        CallKind.PRESS: ("motor", "control"),
        **dict.fromkeys(
            (CallKind.MOVE_TO, CallKind.MOVE, CallKind.QUEUE_MOVE_TO, CallKind.SET_POSITION),
            ("motor", "steps", "context"),
        ),
    }
)
_CALLBACKS = {"REACHED": 1, "FAULT": 2}
_ENDS = {"LOW": 1, "HIGH": 2}

Bit = Literal[
    "DRV_EN",
    "SPEED_VARIABLE",
    "VARIABLE_PWR",
    "IRQ_TIMING",
    "UPDATE_STEPS",
    "ENDPOINT_MILLIS",
    "FASTER",
    "DIRECTION",
    "REACHED",
    "FAULT",
    "LOW",
    "HIGH",
]


def _of_control(value: object) -> str:
    return "control" if isinstance(value, int) else "bits"


def _of_step(value: object) -> str:
    return "a call" if isinstance(value, dict) and "call" in value else "a wait"


ControlField = Annotated[
    Annotated[int, Field(ge=0, le=ALL_CONTROL_BITS), Tag("control")]
    | Annotated[tuple[Bit, ...], Field(strict=False), Tag("bits")],
    Discriminator(_of_control),
]


class CallStep(SpecModel):
    """
    ``{call: set_speed, motor: pan, control: [DRV_EN], top: 20000, limit: 10}``.

    Of an axis ``{call: move_to, steps: -400}``, and in 1/256 clock ``{call: set_pace, top: 9999}``.
    No call of the sketch is ``{call: press, control: [LOW]}``: it presses limit switches from
    outside, and lets go those that are not named.

    A number for ``control`` is passed on as it is, also where the library must refuse it.
    """

    call: Literal[
        "set_speed",
        "hold",
        "release",
        "read",
        "init",
        "update_check",
        "callbacks",
        "keep_alive",
        "watchdog",
        "hold_up",
        "divide_clock",
        "top_per_second",
        "clocks_per_second",
        "move_to",
        "move",
        "run_forward",
        "run_backward",
        "stop",
        "halt",
        "set_pace",
        "queue_move_to",
        "set_position",
        "home",
        "emergency_stop",
        "clear_fault",
        "press",
    ]
    motor: str | None = None
    control: ControlField = ()
    top: Annotated[int, Field(ge=0, le=0xFFFF_FFFF)] = 0
    limit: Annotated[int, Field(ge=0, le=0xFFFF_FFFF)] = 0
    modification: Annotated[int, Field(ge=0, le=0xFFFF_FFFF)] = 0
    interval: Annotated[int, Field(ge=0, le=0xFFFF)] = 0
    count: Annotated[int, Field(ge=0, le=0xFFFF)] = 0
    steps: Annotated[int, Field(ge=-0x8000_0000, le=0x7FFF_FFFF)] = 0
    context: Literal["loop", "callback", "interrupt"] = "loop"

    @property
    def kind(self) -> CallKind:
        """
        Return what the bench calls.
        """
        return CallKind[self.call.upper()]

    @property
    def bits(self) -> tuple[str, ...]:
        """
        Return the bits of ``control`` that were named.
        """
        return () if isinstance(self.control, int) else self.control

    @property
    def control_byte(self) -> int:
        """
        Return ``control`` as a number.
        """
        if isinstance(self.control, int):
            return self.control
        return sum(bits_of(self.kind)[bit] for bit in set(self.control))


class WaitStep(SpecModel):
    """
    ``{wait_ms: 20}``, or ``{wait_clocks: 1234}``: so many CPU clocks.
    """

    wait_ms: Annotated[int | float, Field(gt=0, le=_LONGEST_WAIT_MS)] | None = None
    wait_clocks: Annotated[int, Field(ge=0, le=_LONGEST_WAIT_CLOCKS)] | None = None

    @model_validator(mode="after")
    def _has_one_length(self) -> Self:
        if (self.wait_ms is None) == (self.wait_clocks is None):
            raise ValueError("is neither a call nor a wait; write call, wait_ms or wait_clocks")
        return self

    def action(self, f_cpu_hz: int) -> Wait:
        """
        Return the wait in clocks of a board with *f_cpu_hz*.
        """
        if self.wait_clocks is not None:
            return Wait(self.wait_clocks)
        return Wait(round((self.wait_ms or 0) * f_cpu_hz / 1000))


Step = Annotated[
    Annotated[CallStep, Tag("a call")] | Annotated[WaitStep, Tag("a wait")],
    Discriminator(_of_step),
]


class ScenarioSpec(SpecModel):
    """
    What the sketch does between calls, and the steps in their order.
    """

    name: Annotated[str, Field(max_length=200, pattern=_ONE_LINE)] | None = None
    loop: Literal["sleep", "busy", "hostile", "exact"] = "sleep"
    steps: Annotated[tuple[Step, ...], Field(strict=False)]

    @model_validator(mode="after")
    def _has_a_step(self) -> Self:
        if not self.steps:
            raise ValueError("steps is empty; write a call, such as {call: read}")
        return self


def bits_of(kind: CallKind) -> Mapping[str, int]:
    """
    Return the names of the bits in ``control`` of the call *kind*.
    """
    if kind is CallKind.SET_SPEED:
        return {str(bit.name): int(bit) for bit in Control}
    return {CallKind.CALLBACKS: _CALLBACKS, CallKind.PRESS: _ENDS}.get(kind, {})


def fields_of(kind: CallKind) -> tuple[str, ...]:
    """
    Return which fields the call *kind* has.
    """
    return _FIELDS.get(kind, ("motor", "context"))

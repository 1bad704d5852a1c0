"""
The view of the example Console: what can be typed to each motor, and the functions behind it.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from textwrap import fill

from stepgen.library.api_view import api_name, api_names, init_name
from stepgen.library.example_speeds import Ramp, example_speed_sps
from stepgen.library.motor_view import period_type
from stepgen.library.text import comment_lines, listed
from stepgen.plan.model import MotorPlan, Plan

_WIDTH = 92
_WORD_WIDTH = 13  # of a command with its number, in the help


@dataclass(frozen=True)
class _Kind:
    """
    The struct and table of the motors of a kind, and its functions after a motor's name.
    """

    type: str
    table: str
    placeholder: str
    functions: tuple[str, ...]
    switches: tuple[tuple[str, str], ...]


_KINDS = {
    "axis": _Kind(
        "const Axis",
        "axes",
        "AXIS",
        (
            *("MoveTo", "Move", "SetSpeed", "RunForward", "RunBackward", "Stop", "Halt"),
            *("SetCurrentPosition", "CurrentPosition", "IsRunning"),
        ),
        (("on", "EnableOutputs"), ("off", "DisableOutputs")),
    ),
    "motor": _Kind(
        "Motor",
        "motors",
        "MOTOR",
        ("SetSpeed", "ReadStatus", "ReadPosition"),
        (("hold", "Hold"), ("release", "Release")),
    ),
}
_SWITCH_TEXTS = ("coils on, while it stands", "coils off, while it stands")


@dataclass(frozen=True)
class Extra:
    """
    A command that not every motor has: *optional* tells whether some motor of the console lacks it.
    """

    word: str
    says: str
    optional: bool

    @property
    def padded(self) -> str:
        """
        Return the word as wide as those before it in the help.
        """
        return self.word.ljust(_WORD_WIDTH)

    @property
    def remark(self) -> str:
        """
        Return the comment of its place in the table.
        """
        return "  // null where there is none" if self.optional else ""


@dataclass(frozen=True)
class ConsoleRow:
    """
    A motor, and the functions that its commands call, in the order of its struct.
    """

    name: str
    init: str
    functions: str


@dataclass(frozen=True)
class ConsoleKind:
    """
    The motors of one set of functions: *who* stands for a name of one in the help.

    The functions of those that are *changing* their speed have more parameters than the table's.
    """

    api: str
    type: str
    table: str
    who: str
    off_text: str
    extras: tuple[Extra, ...]
    changing: tuple[str, ...]
    ramps: tuple[Ramp, ...]
    rows: tuple[ConsoleRow, ...]
    speed_sps: int
    period_type: str


@dataclass(frozen=True)
class ConsoleView:
    """
    A console: the motors by their kinds, and where each is, in the order of the spec.
    """

    title: tuple[str, ...]
    kinds: tuple[ConsoleKind, ...]
    addressee: str
    who: tuple[str, ...]
    places: tuple[str, ...]
    refuses_running: bool


def console_view(plan: Plan, ramps: Sequence[Ramp], baud: int) -> ConsoleView:
    """
    Return the console of *plan*, whose *ramps* can be asked for.
    """
    kinds = tuple(_kind(plan, api, ramps) for api in api_names(plan))
    places: dict[str, str] = {}
    for kind in kinds:
        rows = enumerate(kind.rows)
        places |= {row.name: f"{kind.table}[{index}]" for index, row in rows}
    names = [motor.name for motor in plan.motors]
    return ConsoleView(
        title=comment_lines(
            f"{listed(names)} by hand: open the Serial Monitor at {baud} baud, line ending "
            f'"Newline", and type help.'
        ),
        kinds=kinds,
        addressee="several" if names[1:] else "one",
        who=tuple(f"{kind.who}is {row.name}" for kind in kinds for row in kind.rows),
        places=tuple(places[name] for name in names),
        refuses_running=any(m.switches_current or m.motion.ladder for m in plan.motors),
    )


def _kind(plan: Plan, api: str, ramps: Sequence[Ramp]) -> ConsoleKind:
    kind = _KINDS[api]
    motors = [motor for motor in plan.motors if api_name(motor) == api]
    ramped = [ramp for ramp in ramps if ramp.motor in {motor.name for motor in motors}]
    switching = [motor.name for motor in motors if motor.switches_current]
    extras = [
        (word, says, {name: f"{name}{function}" for name in switching})
        for (word, function), says in zip(kind.switches, _SWITCH_TEXTS, strict=True)
    ]
    for ramp in ramped[:1]:  # all have the same speeds
        says = f"from {ramp.slow_sps} to {ramp.fast_sps} steps/s by update events"
        extras.append(("ramp", says, {ramp.motor: f"{ramp.motor}Ramp" for ramp in ramped}))
    extras = [extra for extra in extras if extra[2]]
    return ConsoleKind(
        api=api,
        type=kind.type,
        table=kind.table,
        who=f"{kind.placeholder} " if plan.motors[1:] else "",
        off_text=", coils off" if switching else "",
        extras=tuple(
            Extra(word, says, optional=len(having) < len(motors)) for word, says, having in extras
        ),
        changing=tuple(motor.name for motor in motors if motor.motion.changes_speed),
        ramps=tuple(ramped),
        rows=tuple(
            _row(motor, kind, [having.get(motor.name, "nullptr") for *_, having in extras])
            for motor in motors
        ),
        speed_sps=example_speed_sps(plan),
        period_type=period_type(plan),
    )


def _row(motor: MotorPlan, kind: _Kind, extras: Sequence[str]) -> ConsoleRow:
    names = [f"{motor.name}{function}" for function in kind.functions]
    if motor.motion.changes_speed:  # whose function has more parameters
        names[0] = f"{motor.name}Start"
    return ConsoleRow(motor.name, init_name(motor), fill(", ".join([*names, *extras]), _WIDTH))

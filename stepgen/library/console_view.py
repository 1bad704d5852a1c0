"""
The view of the example Console: what can be typed to each motor, and the functions behind it.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from textwrap import fill

from stepgen.library.api_view import api_name, api_names, init_name
from stepgen.library.console_extras import Extra, Meaning, extras, faults, refusals
from stepgen.library.example_speeds import Ramp, example_speed_sps
from stepgen.library.motor_view import period_type
from stepgen.library.text import comment_lines, listed
from stepgen.plan.model import MotorPlan, Plan

_WIDTH = 92


@dataclass(frozen=True)
class _Kind:
    """
    The struct and table of the motors of a kind, and its functions after a motor's name.
    """

    type: str
    table: str
    placeholder: str
    functions: tuple[str, ...]


_KINDS = {
    "axis": _Kind(
        "const Axis",
        "axes",
        "AXIS",
        (
            *("MoveTo", "Move", "SetSpeed", "RunForward", "RunBackward", "Stop", "Halt"),
            *("SetCurrentPosition", "CurrentPosition", "IsRunning"),
        ),
    ),
    "motor": _Kind(
        "Motor",
        "motors",
        "MOTOR",
        ("SetSpeed", "ReadStatus", "ReadPosition"),
    ),
}


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
    run_text: str
    faults: tuple[Meaning, ...]
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
    refusals: tuple[Meaning, ...]


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
        refusals=refusals(plan),
    )


def _kind(plan: Plan, api: str, ramps: Sequence[Ramp]) -> ConsoleKind:
    kind = _KINDS[api]
    motors = [motor for motor in plan.motors if api_name(motor) == api]
    ramped = [ramp for ramp in ramps if ramp.motor in {motor.name for motor in motors}]
    more = extras(motors, ramped)
    has_range = any(motor.end_stops and motor.end_stops.range for motor in motors)
    return ConsoleKind(
        api=api,
        type=kind.type,
        table=kind.table,
        who=f"{kind.placeholder} " if plan.motors[1:] else "",
        off_text=", coils off" if any(motor.switches_current for motor in motors) else "",
        run_text="as far as it may" if has_range else "without an end",
        faults=faults(plan),
        extras=more,
        changing=tuple(motor.name for motor in motors if motor.motion.changes_speed),
        ramps=tuple(ramped),
        rows=tuple(_row(motor, kind, more) for motor in motors),
        speed_sps=example_speed_sps(plan),
        period_type=period_type(plan),
    )


def _row(motor: MotorPlan, kind: _Kind, more: Sequence[Extra]) -> ConsoleRow:
    names = [f"{motor.name}{function}" for function in kind.functions]
    if motor.motion.changes_speed:  # whose function has more parameters
        names[0] = f"{motor.name}Start"
    names += [extra.functions.get(motor.name, "nullptr") for extra in more]
    return ConsoleRow(motor.name, init_name(motor), fill(", ".join(names), _WIDTH))

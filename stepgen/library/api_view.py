"""
The view of the public names: which control bits, status bits, codes and functions there are.

What no motor of the library can do has no name in it.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace

from stepgen.library import lengths
from stepgen.library.limits_view import switch_functions
from stepgen.plan.model import MotorPlan, Plan

_CHANGING = frozenset({"update-events"})
_ALL = frozenset({"constant", "update-events"})
_AXES = frozenset({"trapezoid"})


@dataclass(frozen=True)
class _Name:
    name: str
    value: int
    remark: str
    motions: frozenset[str] = _ALL


@dataclass(frozen=True)
class Definition:
    """
    A constant of the header as finished text, and its comment, lined up with its neighbours'.
    """

    value: str
    comment: str


_CONTROL_BITS = (
    _Name("MOTOR_CTRL_DRV_EN", 0x80, "drive the motor; without it it stops"),
    _Name("MOTOR_CTRL_SPEED_VARIABLE", 0x40, "update events change the speed", _CHANGING),
    _Name("MOTOR_CTRL_VARIABLE_PWR", 0x20, "each halves (FASTER) or doubles the next", _CHANGING),
    _Name("MOTOR_CTRL_IRQ_TIMING", 0x10, "the step interrupt applies them", _CHANGING),
    _Name("MOTOR_CTRL_UPDATE_STEPS", 0x08, "timerUpd_ms counts steps", _CHANGING),
    _Name("MOTOR_CTRL_ENDPOINT_MILLIS", 0x04, "limit is in milliseconds, not in steps"),
    _Name("MOTOR_CTRL_FASTER", 0x02, "events shorten the interval", _CHANGING),
    _Name("MOTOR_CTRL_SLOWER", 0x00, "they lengthen it: for readers", _CHANGING),
    _Name("MOTOR_CTRL_DIRECTION", 0x01, "backward: the position counts down"),
)
_STATUS_BITS = (
    _Name(
        "MOTOR_STAT_FAULT",
        0x01,
        "something was refused; a start clears it",
    ),
    _Name("MOTOR_STAT_FAULT_CALLED", 0x02, "and its callback was told", _CHANGING),
    _Name("MOTOR_STAT_TIMER_DIV_ERROR", 0x04, "because a speed is out of range"),
    _Name("MOTOR_STAT_TIMER_DIV_CALLED", 0x08, "and the callback was told", _CHANGING),
    _Name("MOTOR_STAT_REACHED", 0x10, "at the end point, or stopped"),
    _Name("MOTOR_STAT_REACH_CALLED", 0x20, "and its callback was told", _CHANGING),
    _Name("MOTOR_STAT_SPIN_FIXED", 0x40, "running at a speed that stays"),
    _Name("MOTOR_STAT_MISSED", 0x80, "a step came too late; a start clears it"),
)
_CALL_CYCLES = {"motor": 1000, "axis": 1300}

_CODES = (
    _Name("MOTOR_ERROR_TOO_FAST", -1, "below MOTOR_MIN_TOP"),
    _Name("MOTOR_ERROR_TOO_FAST", -1, "above the spec's speed", _AXES),
    _Name("MOTOR_ERROR_TOO_SLOW", -2, "above MOTOR_MAX_TOP"),
    _Name(
        "MOTOR_ERROR_CONTROL",
        -3,
        "a control bit that this motor does not have",
        frozenset({"constant"}),
    ),
    _Name("MOTOR_ERROR_UPDATE", -4, "modification, interval or count of events is 0", _CHANGING),
    _Name("MOTOR_ERROR_RUNNING", -5, "not while the motor runs", _ALL | _AXES),
    _Name("MOTOR_ERROR_QUEUE_FULL", -6, "no place is left for the move", _AXES),
    _Name("MOTOR_ERROR_RANGE", -7, "outside of the spec's range", _AXES),
    _Name("MOTOR_ERROR_HOMING", -8, "not while the motor looks for home", _AXES),
    _Name("MOTOR_ERROR_FAULT", -9, "not until the fault is cleared", _AXES),
    _Name("MOTOR_WARN_NOT_ENABLED", 1, "a speed without MOTOR_CTRL_DRV_EN: the motor stops"),
)
_FAULTS = (
    _Name("MOTOR_FAULT_LIMIT", 1, "stopped at a limit switch", _AXES),
    _Name("MOTOR_FAULT_HOMING", 2, "homing has not found the switch, or it stays pressed", _AXES),
    _Name("MOTOR_FAULT_EMERGENCY", 3, "stopped in an emergency", _AXES),
)
_FUNCTIONS = ("ShieldInit", "SetSpeed", "ReadStatus", "ReadPosition")
_AXIS_FUNCTIONS = (
    *("Init", "MoveTo", "Move", "RunForward", "RunBackward", "Stop", "Halt", "SetSpeed"),
    *("CurrentPosition", "TargetPosition", "DistanceToGo", "IsRunning", "SetCurrentPosition"),
)
_AXIS_SWITCH_FUNCTIONS = ("EnableOutputs", "DisableOutputs")
_QUEUE_FUNCTIONS = ("QueueMoveTo",)
_SWITCH_CODES = {"MOTOR_ERROR_RUNNING"}
_QUEUE_CODES = {"MOTOR_ERROR_QUEUE_FULL"}
_GUARD_FUNCTIONS = ("EmergencyStop", "ReadFault", "ClearFault")
_GUARD_CODES = {"MOTOR_ERROR_FAULT", "MOTOR_FAULT_EMERGENCY"}
_SWITCH_FAULTS = {"MOTOR_FAULT_LIMIT"}
_RANGE_CODES = {"MOTOR_ERROR_RANGE"}
_HOMING_FUNCTIONS = ("Home", "IsHomed")
_HOMING_CODES = {"MOTOR_ERROR_HOMING", "MOTOR_FAULT_HOMING"}
_SWITCH_FUNCTIONS = ("Hold", "Release")
_MISSED_BITS = {"MOTOR_STAT_MISSED"}
_MISSED_FUNCTIONS = ("ReadMissed",)
_TIMED_FUNCTIONS = ("KeepAlive", "TimedOut")
_WATCHDOG_FUNCTIONS = ("motorWatchdogStart", "motorWatchdogFeed", "motorWatchdogFired")
_CHANGING_FUNCTIONS = ("TimerUpdateCheck", "CallBackPositionReached", "CallBackFault")
_API_FUNCTIONS = {
    "motor": ("motorTimerGetIOclocksPerSecond", "motorTimerCalcPerSecond"),
    "axis": ("motorInterval",),
}
_RANGE = ("MOTOR_MIN_TOP", "MOTOR_MAX_TOP")


def control_bits(plan: Plan) -> tuple[Definition, ...]:
    """
    Return the control bits that some motor of *plan* knows.
    """
    return _definitions("uint8_t", _used(_CONTROL_BITS, plan))


def status_bits(plan: Plan) -> tuple[Definition, ...]:
    """
    Return the status bits that some motor of *plan* can show.
    """
    return _definitions("uint8_t", _used(_STATUS_BITS, plan))


def codes(plan: Plan) -> tuple[Definition, ...]:
    """
    Return what the functions of *plan* return beside 0.
    """
    return _definitions("int8_t", _used(_CODES, plan))


def faults(plan: Plan) -> tuple[Definition, ...]:
    """
    Return why motors of *plan* can refuse to move until that is cleared.
    """
    return _definitions("int8_t", _used(_FAULTS, plan))


def function_names(plan: Plan) -> tuple[str, ...]:
    """
    Return all functions, those of the library first.
    """
    names = [name for api in api_names(plan) for name in _API_FUNCTIONS[api]]
    names += _WATCHDOG_FUNCTIONS if plan.watchdog_ms is not None else ()
    for motor in plan.motors:
        names += [f"{motor.name}{part}" for part in _parts(motor)]
        names += [dump_name(motor)] if motor.motion.dumps else []
    return tuple(names)


def _parts(motor: MotorPlan) -> tuple[str, ...]:
    """
    Return the functions of *motor*, without its name before them.
    """
    missed = _MISSED_FUNCTIONS if tells_missed(motor) else ()
    turns = ("StepsForTurns",) if motor.steps_per_turn is not None else ()
    if motor.motion.ladder:
        parts = (*_AXIS_FUNCTIONS, *missed)
        parts += _AXIS_SWITCH_FUNCTIONS if motor.switches_current else ()
        parts += _QUEUE_FUNCTIONS if motor.motion.queue else ()
        parts += _limit_parts(motor)
        return (*parts, *turns, *lengths.functions(motor))
    parts = (*_FUNCTIONS, *missed)
    parts += _SWITCH_FUNCTIONS if motor.switches_current else ()
    parts += _CHANGING_FUNCTIONS if motor.motion.kind in _CHANGING else ()
    parts += _TIMED_FUNCTIONS if motor.command_timeout_ms is not None else ()
    parts += turns
    return (*parts, *lengths.functions(motor))


def _limit_parts(motor: MotorPlan) -> tuple[str, ...]:
    if motor.end_stops is None:
        return ()
    homing = _HOMING_FUNCTIONS if motor.end_stops.homing else ()
    return (*_GUARD_FUNCTIONS, *switch_functions(motor), *homing)


def init_name(motor: MotorPlan) -> str:
    """
    Return the function that prepares *motor*.
    """
    return f"{motor.name}{_AXIS_FUNCTIONS[0] if motor.motion.ladder else _FUNCTIONS[0]}"


def position_name(motor: MotorPlan) -> str:
    """
    Return the function that tells where *motor* is.
    """
    return f"{motor.name}{'CurrentPosition' if motor.motion.ladder else 'ReadPosition'}"


def call_cycles(plan: Plan) -> int:
    """
    Return the longest that an interrupt of the sketch can take that does nothing but one call.
    """
    return max(_CALL_CYCLES[name] for name in api_names(plan))


def api_name(motor: MotorPlan) -> str:
    """
    Return the set of functions that *motor* has, by the name of its partial.
    """
    return "axis" if motor.motion.ladder else "motor"


def api_names(plan: Plan) -> tuple[str, ...]:
    """
    Return the sets of functions that motors of *plan* have, by the names of their partials.
    """
    return tuple(sorted({api_name(motor) for motor in plan.motors}))


def tells_missed(motor: MotorPlan) -> bool:
    """
    Tell whether *motor* counts the steps that come too late.
    """
    return motor.gate.tells_missed


def dump_name(motor: MotorPlan) -> str:
    """
    Return the function that prints the state of *motor*: system 1's ``debugDump`` for ``motor``.
    """
    return "debugDump" if motor.name == "motor" else f"{motor.name}DebugDump"


def constant_names(plan: Plan) -> tuple[str, ...]:
    """
    Return all constants of the header.
    """
    used = _used((*_CONTROL_BITS, *_STATUS_BITS, *_CODES, *_FAULTS), plan)
    names = dict.fromkeys(name.name for name in used)
    return (*names, *(_RANGE if "motor" in api_names(plan) else ()))


def _used(names: Iterable[_Name], plan: Plan) -> tuple[_Name, ...]:
    kinds = {motor.motion.kind for motor in plan.motors}
    unused: set[str] = set()
    if not any(motor.motion.queue for motor in plan.motors):
        unused |= _QUEUE_CODES
    if not any(motor.switches_current or motor.motion.ladder for motor in plan.motors):
        unused |= _SWITCH_CODES
    if not any(tells_missed(motor) for motor in plan.motors):
        unused |= _MISSED_BITS
    stops = [motor.end_stops for motor in plan.motors if motor.end_stops]
    for names_of, is_used in (
        (_GUARD_CODES, bool(stops)),
        (_SWITCH_FAULTS, any(one.switches for one in stops)),
        (_RANGE_CODES, any(one.range for one in stops)),
        (_HOMING_CODES, any(one.homing for one in stops)),
    ):
        unused |= set() if is_used else names_of
    used: dict[str, _Name] = {}
    for name in names:
        if name.motions & kinds and name.name not in unused:
            other = used.get(name.name)
            remark = f"{other.remark} or {name.remark}" if other else name.remark
            used[name.name] = replace(name, remark=remark)
    return tuple(used.values())


def _definitions(kind: str, names: tuple[_Name, ...]) -> tuple[Definition, ...]:
    if not names:
        return ()
    texts = [f"constexpr {kind} {name.name} = {_value(kind, name.value)};" for name in names]
    width = max(len(text) for text in texts)
    return tuple(
        Definition(text, f"{' ' * (width - len(text))}  // {name.remark}")
        for text, name in zip(texts, names, strict=True)
    )


def _value(kind: str, value: int) -> str:
    return f"0x{value:02X}" if kind == "uint8_t" else str(value)

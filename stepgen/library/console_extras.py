"""
The commands of the example Console that not every motor has, and what codes and faults mean there.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from stepgen.library.api_view import api_name, constant_names
from stepgen.library.example_speeds import Ramp
from stepgen.plan.model import MotorPlan, Plan

_WORD_WIDTH = 13  # of a command with its number, in the help

_REFUSALS = {
    "MOTOR_ERROR_RUNNING": "not while it runs",
    "MOTOR_ERROR_RANGE": "that is beyond its range",
    "MOTOR_ERROR_HOMING": "not while it looks for home",
    "MOTOR_ERROR_FAULT": "not until you clear the fault",
}
_FAULTS = {
    "MOTOR_FAULT_LIMIT": "stopped at a limit switch",
    "MOTOR_FAULT_HOMING": "has not found its switch, or that stays pressed",
    "MOTOR_FAULT_EMERGENCY": "stopped in an emergency",
}


@dataclass(frozen=True)
class Meaning:
    """
    A constant of the library, and what a sketch says of it.
    """

    name: str
    says: str


@dataclass(frozen=True)
class Extra:
    """
    A command that not every motor has: *optional* tells whether some motor of the console lacks it.

    Its *functions*, by motor, give a *result*, with which the console's *verb* deals.
    """

    word: str
    says: str
    functions: Mapping[str, str]
    optional: bool
    result: str
    verb: str

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
class _Word:
    """
    A command of the motors with the set of functions *api* that it *suits*.
    """

    api: str
    word: str
    function: str
    says: str
    suits: Callable[[MotorPlan], bool]
    result: str = "int8_t"
    verb: str = "act"


def _switches(motor: MotorPlan) -> bool:
    return motor.switches_current


def _has_limits(motor: MotorPlan) -> bool:
    return motor.end_stops is not None


def homes(motor: MotorPlan) -> bool:
    """
    Tell whether *motor* finds home by itself.
    """
    return motor.end_stops is not None and motor.end_stops.homing is not None


_ON, _OFF = "coils on, while it stands", "coils off, while it stands"
_WORDS = (
    _Word("axis", "home", "Home", "look for the limit switch", homes),
    _Word("axis", "fault", "ReadFault", "why it moves no more", _has_limits, "uint8_t", "tell"),
    _Word("axis", "clear", "ClearFault", "let it move again", _has_limits, "void"),
    _Word("axis", "on", "EnableOutputs", _ON, _switches),
    _Word("axis", "off", "DisableOutputs", _OFF, _switches),
    _Word("motor", "hold", "Hold", _ON, _switches),
    _Word("motor", "release", "Release", _OFF, _switches),
)


def refusals(plan: Plan) -> tuple[Meaning, ...]:
    """
    Return what the codes mean with which motors of *plan* refuse something.
    """
    return _meanings(_REFUSALS, plan)


def faults(plan: Plan) -> tuple[Meaning, ...]:
    """
    Return what the faults of motors of *plan* mean.
    """
    return _meanings(_FAULTS, plan)


def _meanings(meanings: Mapping[str, str], plan: Plan) -> tuple[Meaning, ...]:
    names = constant_names(plan)
    return tuple(Meaning(name, says) for name, says in meanings.items() if name in names)


def extras(motors: Sequence[MotorPlan], ramps: Sequence[Ramp]) -> tuple[Extra, ...]:
    """
    Return the commands that some of *motors*, all with one set of functions, have, and *ramps*.
    """
    return tuple(_extras(motors, ramps))


def _extras(motors: Sequence[MotorPlan], ramps: Sequence[Ramp]) -> Iterator[Extra]:
    for one in _WORDS:
        having = [m.name for m in motors if api_name(m) == one.api and one.suits(m)]
        functions = {name: f"{name}{one.function}" for name in having}
        optional = len(having) < len(motors)
        if having:
            yield Extra(one.word, one.says, functions, optional, one.result, one.verb)
    for ramp in ramps[:1]:  # all have the same speeds
        says = f"from {ramp.slow_sps} to {ramp.fast_sps} steps/s by update events"
        functions = {ramp.motor: f"{ramp.motor}Ramp" for ramp in ramps}
        yield Extra("ramp", says, functions, len(ramps) < len(motors), "int8_t", "act")

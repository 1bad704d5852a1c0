"""
The view of the limits of an axis: switches, range and homing as finished text.
"""

from collections.abc import Iterator
from dataclasses import dataclass

from stepgen.devices import Mcu
from stepgen.library.port_view import Change
from stepgen.library.text import comment_lines, hexadecimal
from stepgen.plan.end_stops import EndStops, EndSwitch, HomingPlan
from stepgen.plan.model import MotorPlan, Plan

_FAR = {"forward": "Position() + kFar, kEndless", "backward": "Position() - kFar, kEndless"}


@dataclass(frozen=True)
class Constant:
    """
    A constant of the source and what stands behind it.
    """

    value: str
    comment: str


@dataclass(frozen=True)
class SwitchView:
    """
    A switch: the expression that is true while it is pressed, and the function that says so.

    *bit* is what the bench of verification has for it.
    """

    function: str
    pressed: str
    comment: str
    bit: str


@dataclass(frozen=True)
class HomingView:
    """
    Homing: its constants, and sentences about it for the source and for the header.
    """

    prefix: str
    pressed: str
    constants: tuple[Constant, ...]
    comment: tuple[str, ...]
    header: tuple[str, ...]


@dataclass(frozen=True)
class LimitsView:
    """
    What the templates print of the limits of one motor.

    *forward* and *backward* are the arguments of a move without an end, or to that of the range.
    """

    handler: str
    switches: tuple[SwitchView, ...]
    inputs: tuple[Change, ...]
    range: tuple[Constant, ...]
    lowest: str
    highest: str
    forward: str
    backward: str
    homing: HomingView | None


def limits_name(motor: MotorPlan) -> str:
    """
    Return the partial that prints the limits of *motor*.
    """
    if motor.end_stops is None:
        return "none"
    return "homing" if motor.end_stops.homing else "guarded"


def limits_view(motor: MotorPlan, plan: Plan) -> LimitsView | None:
    """
    Return what the templates print of the limits of *motor* of *plan*; None if it has none.
    """
    stops = motor.end_stops
    if stops is None:
        return None
    prefix = f"k{motor.name[0].upper()}{motor.name[1:]}"
    lowest, highest = f"{prefix}Lowest", f"{prefix}Highest"
    homing = stops.homing
    mcu = plan.board.mcu
    return LimitsView(
        handler=limit_handler(motor),
        switches=tuple(_switch(motor, switch) for switch in stops.switches),
        inputs=tuple(change for switch in stops.switches for change in _inputs(switch, mcu)),
        range=tuple(_range(stops, lowest, highest)),
        lowest=lowest,
        highest=highest,
        forward=f"{highest}, 0" if stops.range else motor.name + _FAR["forward"],
        backward=f"{lowest}, 0" if stops.range else motor.name + _FAR["backward"],
        homing=_homing(motor, homing, stops, prefix) if homing else None,
    )


def limit_handler(motor: MotorPlan) -> str:
    """
    Return where the step interrupt of *motor* goes on in place of a step into a switch.
    """
    return motor.hot_path.limit_handler


def switch_functions(motor: MotorPlan) -> tuple[str, ...]:
    """
    Return what the names of the functions end with that tell whether a switch is pressed.
    """
    stops = motor.end_stops
    return tuple(_function(switch) for switch in stops.switches) if stops else ()


def _function(switch: EndSwitch) -> str:
    return f"At{switch.end.capitalize()}Limit"


def _pressed(switch: EndSwitch) -> str:
    mask = hexadecimal(1 << switch.pin.bit.bit)
    shown = f"{switch.register.name} & {mask}"
    return shown if switch.active_high else f"!({shown})"


def _switch(motor: MotorPlan, switch: EndSwitch) -> SwitchView:
    level = "HIGH" if switch.active_high else "LOW"
    shown = f"{switch.pin.label} is {level}"
    return SwitchView(
        function=f"{motor.name}{_function(switch)}",
        pressed=_pressed(switch),
        comment=f"Whether the switch at the {switch.end} end is pressed: {shown}.",
        bit="1" if switch.end == "low" else "2",
    )


def _inputs(switch: EndSwitch, mcu: Mcu) -> Iterator[Change]:
    port = mcu.port(switch.pin.bit.port)
    mask = 1 << switch.pin.bit.bit
    keep = hexadecimal(~mask & 0xFF)
    yield Change(f"{port.ddr.name} &= {keep};", f"  // {switch.end} limit switch")
    pull = f"|= {hexadecimal(mask)};" if switch.pull_up else f"&= {keep};"
    yield Change(f"{port.port.name} {pull}", "  // pulled up" if switch.pull_up else "")


def _range(stops: EndStops, lowest: str, highest: str) -> Iterator[Constant]:
    if stops.range:
        for name, steps in zip((lowest, highest), stops.range, strict=True):
            yield Constant(f"constexpr int32_t {name} = {steps};", "")


def _homing(motor: MotorPlan, homing: HomingPlan, stops: EndStops, prefix: str) -> HomingView:
    there = -1 if homing.towards == "low" else 1
    switch = next(one for one in stops.switches if one.end == homing.towards)
    constants = (
        ("int32_t", "Travel", there * homing.travel, "where it gives up, from where it begins"),
        ("int32_t", "BackOff", -there * homing.back_off, "back from the switch"),
        ("int32_t", "Home", homing.position, "what the place of the switch is called"),
        ("int32_t", "Park", homing.park, "where it rests in the end"),
        ("uint32_t", "HomeInterval", homing.fast.interval_256, "its speed there,"),
        ("uint16_t", "HomeHeight", homing.fast.height, "and how high on the ramp that is"),
        ("uint32_t", "SlowInterval", homing.slow.interval_256, "the same when it looks again"),
        ("uint16_t", "SlowHeight", homing.slow.height, ""),
    )
    behind = homing.fast.height + 1
    at_rest = "there" if homing.park == homing.position else f"at {homing.park}"
    return HomingView(
        prefix=prefix,
        pressed=_pressed(switch),
        constants=tuple(_constant(prefix, *row) for row in constants),
        comment=comment_lines("Homing; ways in steps, with a sign."),
        header=comment_lines(
            f"Finds the switch at the {homing.towards} end, and returns at once: the motor runs "
            f"there, comes to rest up to {behind} steps behind it, goes back until it is "
            f"{homing.back_off} steps before it, and slowly on until it sees it again. That place "
            f"is position {homing.position}; it comes to rest {at_rest}. After {homing.travel} "
            "steps without the switch, or if that stays pressed, it gives up, with "
            "MOTOR_FAULT_HOMING. Meanwhile other moves and speeds are refused with "
            f"MOTOR_ERROR_HOMING, and {motor.name}Stop() and {motor.name}Halt() end it. Returns 0, "
            "MOTOR_ERROR_FAULT or MOTOR_ERROR_RUNNING."
        ),
    )


def _constant(prefix: str, kind: str, name: str, value: int, note: str) -> Constant:
    suffix = "UL" if kind == "uint32_t" else ""
    comment = f"  // {note}" if note else ""
    return Constant(f"constexpr {kind} {prefix}{name} = {value}{suffix};", comment)

"""
What people look for first: of one motor a few figures, of several a table with a row for each.
"""

from collections.abc import Iterator

from stepgen.datasheet.names import numbered_names
from stepgen.datasheet.tables import NONE, Table, told_once
from stepgen.library.rates_view import microseconds
from stepgen.plan.limit_facts import range_steps
from stepgen.plan.model import MotorPlan, Plan

_OWNED = ("timer", "timing", "interrupt vector", "ports written", "ports for itself")


def facts(plan: Plan) -> Iterator[tuple[str, str]]:
    """
    Yield the few figures of one motor that people look for first; several have a table of them.
    """
    if plan.motors[1:]:
        return
    (motor,) = plan.motors
    yield (f"{motor.name}, up to", f"{_fastest(motor, plan)} steps/s")
    yield (f"{motor.name}, a step takes", f"{motor.hot_path.usual_cycles} clocks")
    if motor.end_stops and motor.end_stops.range:
        yield (f"{motor.name}, range", range_steps(motor.end_stops.range))
    if motor.steps_per_turn:
        yield (f"{motor.name}, a turn", f"{_turn(motor)} steps")
    yield _held(plan)


def motor_table(plan: Plan) -> Table:
    """
    Return a row for each motor: driver, highest rate, a step's cycles, and what it has for itself.
    """
    names = numbered_names(plan)
    rows = tuple(
        (
            names[motor.name],
            motor.drive.title,
            motor.drive.steps_text,
            _turn(motor),
            _fastest(motor, plan),
            f"{motor.hot_path.usual_cycles}",
            *_owned(motor),
        )
        for motor in plan.motors
    )
    heading = ("motor", "drive", "steps", "in a turn", "up to steps/s", "clocks a step", *_OWNED)
    return told_once(Table("Motors", heading, rows, ": ".join(_held(plan)), kind="motors"))


def ownership_table(plan: Plan) -> Table:
    """
    Return what each motor has for itself: timer, vector, ports, and the pins of its switches.
    """
    has_switches = any(motor.end_switches for motor in plan.motors)
    rows = tuple(
        (motor.name, *_owned(motor), *([_switch_pins(motor)] if has_switches else []))
        for motor in plan.motors
    )
    switches = ("switches",) if has_switches else ()
    return Table("Timers, vectors and ports", ("motor", *_OWNED, *switches), rows, kind="motors")


def _held(plan: Plan) -> tuple[str, str]:
    fastest = plan.held_off[-1]
    return (
        f"interrupts off at {int(fastest.steps_per_second)} steps/s",
        f"{int(microseconds(fastest, plan))} us at most",
    )


def _owned(motor: MotorPlan) -> tuple[str, ...]:
    timing = motor.timing
    return (
        f"{timing.timer.number}",
        timing.kind,
        timing.vector,
        ", ".join(sorted({wire.pin.bit.port for wire in motor.drive.every_wire})),
        f"{motor.port_letters} owned" if motor.owns_ports else "none owned, all shared",
    )


def _fastest(motor: MotorPlan, plan: Plan) -> str:
    return f"{int(plan.rates[motor.name][-1].steps_per_second)}"


def _turn(motor: MotorPlan) -> str:
    return f"{float(motor.steps_per_turn):.6g}" if motor.steps_per_turn else NONE


def _switch_pins(motor: MotorPlan) -> str:
    pins = (f"{switch.pin.label} ({switch.signal})" for switch in motor.end_switches)
    return ", ".join(pins) or "none"

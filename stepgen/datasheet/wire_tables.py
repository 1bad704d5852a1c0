"""
The tables of what a library has for itself: wires, limits, timers and ports.
"""

from collections.abc import Iterator

from stepgen.datasheet.figures import Table
from stepgen.plan.limit_facts import limit_facts
from stepgen.plan.model import MotorPlan, Plan


def wire_table(motor: MotorPlan) -> Table:
    """
    Return signal, pin, port bit and role of each wire of *motor*.
    """
    drive = motor.drive
    shared = ", shared" if drive.shared_enables else ""
    roles = dict.fromkeys(drive.wires, "steps")
    roles |= dict.fromkeys(drive.enables, f"enable{shared}")
    roles |= dict.fromkeys(drive.quiet, "stays LOW")
    rows = [
        (wire.signal, wire.pin.label, wire.pin.bit.name, roles.get(wire, "direction"))
        for wire in drive.every_wire
    ]
    rows += [
        (switch.signal, switch.pin.label, switch.pin.bit.name, f"input, {switch.level} there")
        for switch in motor.end_switches
    ]
    return Table(f"{motor.name}: wires", ("signal", "pin", "port bit", "what for"), tuple(rows))


def limit_tables(plan: Plan) -> Iterator[Table]:
    """
    Yield what each motor with limits keeps to.
    """
    for motor in plan.motors:
        rows = tuple(limit_facts(motor, plan.board.f_cpu_hz))
        if rows:
            yield Table(f"{motor.name}: limits", ("", "is"), rows)


def ownership_table(plan: Plan) -> Table:
    """
    Return what each motor has for itself: timer, vector, ports, and the pins of its switches.
    """
    has_switches = any(motor.end_switches for motor in plan.motors)
    rows = [
        (
            motor.name,
            f"{motor.timing.timer.number} ({motor.timing.kind}, {motor.timing.event})",
            motor.timing.vector,
            ", ".join(sorted({wire.pin.bit.port for wire in motor.drive.every_wire})),
            f"{motor.port_letters} owned" if motor.owns_ports else "none owned, all shared",
            *([_switch_pins(motor)] if has_switches else []),
        )
        for motor in plan.motors
    ]
    heading = ("motor", "timer", "interrupt vector", "ports written", "ports for itself")
    switches = ("switches",) if has_switches else ()
    return Table("Timers, vectors and ports", (*heading, *switches), tuple(rows))


def _switch_pins(motor: MotorPlan) -> str:
    pins = (f"{switch.pin.label} ({switch.signal})" for switch in motor.end_switches)
    return ", ".join(pins) or "none"

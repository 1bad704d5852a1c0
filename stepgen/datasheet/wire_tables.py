"""
The tables of wires and limits: of one motor a row for each, of several alike a row for each motor.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence

from stepgen.datasheet.names import row_names, together
from stepgen.datasheet.tables import NONE, Row, Table, told_once
from stepgen.library.text import listed
from stepgen.plan.limit_facts import limit_facts, limit_row
from stepgen.plan.model import MotorPlan, Plan

Wires = Mapping[str, tuple[str, str, str]]
"""By the signal: pin, port bit, and what for."""


def wire_tables(plan: Plan) -> Iterator[Table]:
    """
    Yield pin, port bit and role of each wire; motors whose drives have the same signals share one.
    """
    alike: dict[Row, list[MotorPlan]] = {}
    for motor in plan.motors:
        signals = tuple(wire.signal for wire in motor.drive.every_wire)
        alike.setdefault(signals, []).append(motor)
    for motors in alike.values():
        yield _wires_of(motors, plan) if motors[1:] else _wires_of_one(motors[0])


def limit_tables(plan: Plan) -> Iterator[Table]:
    """
    Yield what each motor with limits keeps to.
    """
    f_cpu_hz = plan.board.f_cpu_hz
    motors = [motor for motor in plan.motors if motor.end_stops]
    if not motors[1:]:
        for motor in motors:
            alone = tuple(limit_facts(motor, f_cpu_hz))
            yield Table(f"{motor.name}: limits", ("limit", "is"), alone)
        return
    facts = [dict(limit_row(motor, f_cpu_hz)) for motor in motors]
    columns = _in_order(name for row in facts for name in row)
    rows = tuple(
        (row_names(plan)[motor.name], *(row.get(name, NONE) for name in columns))
        for motor, row in zip(motors, facts, strict=True)
    )
    yield told_once(Table(f"{together(motors, plan)}: limits", ("motor", *columns), rows))


def _wires(motor: MotorPlan) -> Wires:
    """
    Return the wires of *motor*, those of its switches last.
    """
    drive = motor.drive
    shared = ", shared" if drive.shared_enables else ""
    roles = dict.fromkeys(drive.wires, "steps")
    roles |= dict.fromkeys(drive.enables, f"enable{shared}")
    roles |= dict.fromkeys(drive.quiet, "stays LOW")
    wires = {
        wire.signal: (wire.pin.label, wire.pin.bit.name, roles.get(wire, "direction"))
        for wire in drive.every_wire
    }
    for switch in motor.end_switches:
        role = f"input, {switch.level} there"
        wires[switch.signal] = (switch.pin.label, switch.pin.bit.name, role)
    return wires


def _wires_of_one(motor: MotorPlan) -> Table:
    rows = tuple((signal, *what) for signal, what in _wires(motor).items())
    return Table(
        f"{motor.name}: wires", ("signal", "pin", "port bit", "what for"), rows, kind="wires"
    )


def _wires_of(motors: Sequence[MotorPlan], plan: Plan) -> Table:
    """
    Return a row for each motor; what a signal is for stands above the table if that is the same.
    """
    wires = [_wires(motor) for motor in motors]
    signals = _in_order(signal for one in wires for signal in one)
    roles = {signal: {one[signal][2] for one in wires if signal in one} for signal in signals}
    of_role: dict[str, list[str]] = {}
    for signal in signals:
        if len(roles[signal]) == 1:
            of_role.setdefault(min(roles[signal]), []).append(signal)
    note = "; ".join(f"{role}: {listed(having)}" for role, having in of_role.items())
    names = row_names(plan)
    rows = tuple(
        (names[motor.name], *(_cell(one, signal, roles[signal]) for signal in signals))
        for motor, one in zip(motors, wires, strict=True)
    )
    return Table(f"{together(motors, plan)}: wires", ("motor", *signals), rows, note, kind="wires")


def _cell(wires: Wires, signal: str, roles: set[str]) -> str:
    if signal not in wires:
        return NONE
    label, bit, role = wires[signal]
    return f"{label} ({bit})" if len(roles) == 1 else f"{label} ({bit}), {role}"


def _in_order(names: Iterable[str]) -> Row:
    """
    Return *names*, each once, in their order, but those of the switches last.
    """
    once = dict.fromkeys(names)
    ends = [name for name in ("low end", "high end") if name in once]
    return (*(name for name in once if name not in ends), *ends)

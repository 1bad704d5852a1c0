"""
Sentences about a plan, for comments and documents: what is wired where, and who owns what.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence

from stepgen.devices import Board
from stepgen.library.api_view import call_cycles, dump_name
from stepgen.library.sharing import Need, sharing_rules
from stepgen.library.text import comment_lines, frequency, listed
from stepgen.plan.end_stops import EndSwitch
from stepgen.plan.model import MotorPlan, Plan
from stepgen.plan.pulses import PulseDrive


def summary(motor: MotorPlan) -> str:
    """
    Return driver, sequence and timer of *motor* in a few words.
    """
    return f"{motor.drive.title}, {motor.drive.steps_text}, timer {motor.timing.timer.number}"


def title(plan: Plan, sentence: str) -> tuple[str, ...]:
    """
    Return what stands at the top of the header: what the library is, and for what hardware.
    """
    board = plan.board
    return (
        *comment_lines(f"{plan.library.name} {plan.library.version}: {sentence}"),
        "",
        f"Board: {board.title} ({board.mcu.title}, {frequency(board.f_cpu_hz)})",
        *(
            line
            for motor in plan.motors
            for line in comment_lines(f"{motor.name}: {summary(motor)}")
        ),
    )


def wiring(motor: MotorPlan, board: Board) -> tuple[str, ...]:
    """
    Return a table of the wires of *motor*, and what the sketch must leave to it.
    """
    rows = [
        f"  {wire.signal:<10}{wire.pin.label:<6}{wire.pin.bit.name}"
        for wire in motor.drive.every_wire
    ]
    rows += [
        f"  {switch.signal:<10}{switch.pin.label:<6}{switch.pin.bit.name:<6}{switch_role(switch)}"
        for switch in motor.end_switches
    ]
    timer = motor.timing.timer
    taken = f"Timer {timer.number} belongs to the motor: no analogWrite() on {_pwm(motor, board)}."
    return (
        f"  {'signal':<10}{'pin':<6}port bit",
        *rows,
        "",
        *comment_lines(port_rule(motor, board)),
        *comment_lines(" ".join(filter(None, (taken, motor.timing.rule)))),
    )


def switch_role(switch: EndSwitch) -> str:
    """
    Return what the pin of *switch* shows at the end of the way, and how it is held else.
    """
    pulled = ", pulled up by the chip" if switch.pull_up else ""
    return f"{switch.level} there{pulled}"


def port_rule(motor: MotorPlan, board: Board) -> str:
    """
    Return what the sketch may do to the ports of *motor*.
    """
    rules = []
    owned = _owned(motor)
    if owned:
        rules.append(
            f"Port {motor.port_letters} belongs to the motor: the sketch must not write to it."
        )
    shared = {wire.pin.bit.port for wire in motor.drive.every_wire} - owned
    return " ".join((*rules, *_shared_rules(shared, board)))


def _owned(motor: MotorPlan) -> set[str]:
    """
    Return the ports that only *motor* writes to.
    """
    return {wire.pin.bit.port for wire in motor.drive.wires} if motor.owns_ports else set()


def _port_rules(plan: Plan) -> Iterator[str]:
    """
    Yield what the sketch may do to the ports of all motors: a port that one owns is not shared.
    """
    owners = {port: motor for motor in plan.motors for port in _owned(motor)}
    every = {wire.pin.bit.port for motor in plan.motors for wire in motor.drive.every_wire}
    for port, motor in sorted(owners.items(), key=lambda item: item[0]):
        owner = f"motor {motor.name}" if plan.motors[1:] else "the motor"
        yield f"Port {port} belongs to {owner}: the sketch must not write to it."
    yield from _shared_rules(every - owners.keys(), plan.board)


def _shared_rules(ports: Iterable[str], board: Board) -> Iterator[str]:
    """
    Yield what the sketch may do to *ports*.

    A single bit of a port within reach of SBI and CBI changes in one instruction; elsewhere the
    sketch loads, changes and stores, and a step in between would be undone.
    """
    near = [port for port in sorted(ports) if board.mcu.port(port).port.bit_addressable]
    far = [port for port in sorted(ports) if port not in near]
    if near:
        yield (
            f"The sketch may change other bits of port{'s' if len(near) > 1 else ''} "
            f"{listed(near)} with digitalWrite(), with single-bit sbi/cbi, or inside ATOMIC_BLOCK."
        )
    if far:
        yield (
            f"The sketch may change other bits of port{'s' if len(far) > 1 else ''} "
            f"{listed(far)} with digitalWrite() or inside ATOMIC_BLOCK."
        )


def _pwm(motor: MotorPlan, board: Board) -> str:
    """
    Return the pins, or the port bits that no pin carries, that the timer of *motor* could drive.
    """
    bits = [bit for _, bit in motor.timing.timer.outputs]
    pins = [board.find_pin(bit.name) for bit in bits]
    return listed(
        [pin.label if pin else bit.name for pin, bit in zip(pins, bits, strict=True)], "or"
    )


def calls_comment(plan: Plan) -> tuple[str, ...]:
    """
    Return from where the functions may be called, as lines of a comment.
    """
    changing = [motor for motor in plan.motors if motor.motion.changes_speed]
    callbacks = (
        f" ({listed([f'{motor.name}TimerUpdateCheck()' for motor in changing])} and the callbacks "
        "that it makes: longer, by those)"
        if changing
        else ""
    )
    axes = [f"{motor.name}SetSpeed()" for motor in plan.motors if motor.motion.ladder]
    searches = f" ({listed(axes)}: longer, by a search of the ramp)" if axes else ""
    places = ["from setup() and loop()", *(["from a callback"] if changing else [])]
    dumps = [motor for motor in changing if motor.motion.dumps]
    names = listed([f"{dump_name(motor)}()" for motor in dumps]) if dumps else ""
    prints = f" The exception is {names}: it prints, and waits for Serial." if dumps else ""
    return comment_lines(
        f"Every function may be called {', '.join(places)}, and from an interrupt of the sketch, "
        "also in the middle of another call. Step interrupts wait for an interrupt of the sketch: "
        f"a call takes at most {call_cycles(plan)} clocks there{callbacks}{searches}, and counts "
        f"as a stretch with interrupts off.{prints}"
    )


def init_comment(motor: MotorPlan) -> tuple[str, ...]:
    """
    Return what the function that prepares the motor does, as lines of a comment.
    """
    coils = ", with the coils off" if motor.switches_current else ""
    floats = (
        "; a driver that must be off meanwhile needs a resistor at its ENABLE"
        if isinstance(motor.drive, PulseDrive) and motor.drive.enables
        else ""
    )
    inputs = ", and those of the switches inputs" if motor.end_switches else ""
    return comment_lines(
        f"Makes the pins outputs{coils}, at position 0{inputs}. Call it once, from setup(). Until "
        f"then, and from any reset on, they are inputs and drive nothing{floats}."
    )


def axis_start_comment(motor: MotorPlan, need: Need | None, f_cpu_hz: int) -> tuple[str, ...]:
    """
    Return what happens at the start and at the end of a move, as lines of a comment.
    """
    energised = "the coils are energised at once and " if motor.switches_current else ""
    return comment_lines(
        f"From rest {energised}the first step comes one interval later{_wake(motor, f_cpu_hz)}. "
        f"{_rest_comment(motor, need)} {returns(*refusals(motor))}"
    )


def refusals(motor: MotorPlan) -> tuple[str, ...]:
    """
    Return the codes with which the limits of *motor* refuse a move.
    """
    stops = motor.end_stops
    if stops is None:
        return ()
    by_range = ("MOTOR_ERROR_RANGE",) if stops.range else ()
    by_homing = ("MOTOR_ERROR_HOMING",) if stops.homing else ()
    return (*by_range, *by_homing, "MOTOR_ERROR_FAULT")


def returns(*codes: str) -> str:
    """
    Return what a function returns that can be refused with *codes*.
    """
    return f"Returns {listed(['0', *codes], 'or')}." if codes else "Always returns 0."


def _wake(motor: MotorPlan, f_cpu_hz: int) -> str:
    wake_ms = motor.wake_cycles / f_cpu_hz * 1000
    return f", {wake_ms:.6g} ms at least, since the driver has to wake up" if wake_ms else ""


def start_comment(motor: MotorPlan, need: Need | None, f_cpu_hz: int) -> tuple[str, ...]:
    """
    Return what happens at a start from rest, in mid-run and at the end, as lines of a comment.
    """
    energised = "the coils are energised at once and " if motor.switches_current else ""
    return comment_lines(
        f"From rest {energised}the first step comes one interval later{_wake(motor, f_cpu_hz)}. "
        "While the motor runs, the interval in progress ends as it was; the step at its end is the "
        f"first of the new motion. {_rest_comment(motor, need)}"
    )


def _rest_comment(motor: MotorPlan, need: Need | None) -> str:
    """
    Return what the coils do at the end of a move.
    """
    if motor.releases_at_rest and need:
        return (
            "One interval after the last step the coils go off, "
            f"unless {need.other} needs the current."
        )
    if motor.releases_at_rest:
        return "At its end the coils go off one interval after the last step."
    if not motor.switches_current:
        return "The coils always have current: there is no ENABLE."
    return "At its end the coils stay on and hold the position."


def release_comment(need: Need | None) -> tuple[str, ...]:
    """
    Return what the function that releases the motor does, as lines of a comment.
    """
    unless = f", unless {need.other} needs the current" if need else ""
    return comment_lines(
        f"Switches the coils off, so that the shaft turns freely{unless}. Returns 0, or "
        "MOTOR_ERROR_RUNNING."
    )


def isr_contract(motor: MotorPlan) -> tuple[str, ...]:
    """
    Return trigger, cycles and effects of the step interrupt, as lines of a comment.
    """
    path = motor.hot_path
    switched = motor.drive.released if motor.releases_at_rest else ()
    ports = listed(sorted({wire.pin.bit.port for wire in (*motor.drive.wires, *switched)}))
    clock = f", {path.clock_cycles} with a look at the clock" if motor.motion.watches_clock else ""
    timing = motor.timing
    late = " comes too late and" if motor.gate.late_cycles else ""
    laps = "".join(
        f" Between two steps it counts laps of the timer, {cycles[0]} cycles each, and "
        f"{cycles[-1]} for the last of them."
        for cycles in (path.lap_cycles,)
        if cycles
    )
    pressed = ""
    if path.pressed_cycles:
        pressed = f", up to {path.pressed_cycles} more while limit switches are pressed"
    if motor.gate.boundary:
        laps = " In an interval of 32768 clocks or more it counts laps of 16384 clocks there, too."
    return comment_lines(
        f"Timer {timing.timer.number} {timing.event}: one step, {path.usual_cycles} cycles from "
        f"the interrupt's response to RETI{clock}; at most {motor.isr_bound_cycles} when it{late} "
        f"goes on in {motor.handler}. {motor.drive.edge_note} {path.edge_cycles} cycles after "
        f"{timing.instant} ({path.boundary_edge_cycles} before a boundary{pressed}).{laps} It "
        f"writes port {ports} and nothing else that the sketch can see. Behind each instruction "
        "stand its cycles."
    )


def takes(plan: Plan) -> tuple[str, ...]:
    """
    Return what the library takes from the sketch, a line each.
    """
    under = {rule: [m.name for m in plan.motors if m.timing.rule == rule] for rule in _rules(plan)}
    of_timer: dict[int, list[MotorPlan]] = {}
    for motor in plan.motors:
        of_timer.setdefault(motor.timing.timer.number, []).append(motor)
    rows = [
        f"Timer {number} and {listed([f'`{motor.timing.vector}`' for motor in motors])}: no "
        f"`analogWrite()` on {_pwm(motors[0], plan.board)}.{_own_rule(motors, under)}"
        for number, motors in of_timer.items()
    ]
    rows.extend(f"{listed(names)}: {rule}" for rule, names in under.items() if names[1:])
    rows.extend(sharing_rules(plan))
    rows.extend(_port_rules(plan))
    rows.append(_inputs([motor for motor in plan.motors if motor.end_switches]))
    rows.append("`GPIOR0`, `GPIOR1` and `GPIOR2`, which the Arduino core does not use.")
    return tuple(dict.fromkeys(filter(None, rows)))


def _inputs(motors: Sequence[MotorPlan]) -> str:
    """
    Return which pins the switches of *motors* take, or "" without any; which is which if it is one.
    """
    switches = [switch for motor in motors for switch in motor.end_switches]
    if not switches:
        return ""
    if motors[1:]:
        pins = listed([switch.pin.label for switch in switches])
        return f"Pins {pins}: inputs for limit switches."
    pins = listed([f"{switch.pin.label} ({switch.signal})" for switch in switches])
    plural = ("s", "es", "inputs") if switches[1:] else ("", "", "an input")
    return (
        f"Pin{plural[0]} {pins}: {plural[2]} for the limit switch{plural[1]} of {motors[0].name}."
    )


def _rules(plan: Plan) -> Iterator[str]:
    return (motor.timing.rule for motor in plan.motors if motor.timing.rule)


def _own_rule(motors: Sequence[MotorPlan], under: Mapping[str, list[str]]) -> str:
    """
    Return what else holds of the timer of *motors*, if it holds of one motor only.
    """
    rules = [motor.timing.rule for motor in motors if under.get(motor.timing.rule) == [motor.name]]
    return "".join(f" {rule}" for rule in rules)


def paragraph(plan: Plan) -> str:
    """
    Return the second sentence of library.properties.
    """
    motors = "; ".join(f"{m.name}: {m.drive.title}, {m.drive.steps_text}" for m in plan.motors)
    return f"Made by stepgen for the {plan.board.title}: {motors}."

"""
The view of one motor: names, masks and numbers as finished text.
"""

from collections.abc import Iterator
from dataclasses import dataclass

from stepgen.library.api_view import dump_name, init_name, position_name, tells_missed
from stepgen.library.axis_view import AxisView, axis_view
from stepgen.library.example_speeds import example_speed_sps
from stepgen.library.hot_view import Line, instruction_lines, operand_lines
from stepgen.library.kernel_view import KernelView, kernel_view
from stepgen.library.lengths import Lengths, lengths
from stepgen.library.limits_view import LimitsView, limits_name, limits_view
from stepgen.library.port_view import Bits, Change, bit_groups, switched
from stepgen.library.prose import (
    init_comment,
    isr_contract,
    release_comment,
    start_comment,
    summary,
    wiring,
)
from stepgen.library.sharing import Need, need_of, sharing_note
from stepgen.library.text import comment_lines
from stepgen.library.timings import TimerView, timer_view
from stepgen.plan.model import MotorPlan, Plan

_LARGEST_UINT16, _LARGEST_UINT32 = 0xFFFF, 0xFFFF_FFFF
_EXAMPLE_STEPS = 200
_MINUTE = "60ULL * motorTimerGetIOclocksPerSecond() for one a minute;"


@dataclass(frozen=True)
class Named:
    """
    A name with a value or a remark.
    """

    name: str
    value: str = ""
    comment: str = ""


@dataclass(frozen=True)
class Turns:
    """
    The helper that turns turns into steps: its formula and what it stands for.
    """

    expression: str
    comment: str


@dataclass(frozen=True)
class Timeout:
    """
    The command time-out: its milliseconds, and the call that stops the motor in the same way.
    """

    millis: str
    stop_call: str


@dataclass(frozen=True)
class MotorView:
    """
    One motor, as its parts of header and source need it.
    """

    name: str
    title: str
    init: str
    axis: AxisView | None
    limits_name: str
    limits: LimitsView | None
    summary: str
    period_type: str
    period_note: tuple[str, ...]
    wiring: tuple[str, ...]
    init_comment: tuple[str, ...]
    start_comment: tuple[str, ...]
    release_comment: tuple[str, ...]
    turns: Turns | None
    lengths: Lengths | None
    kernel_name: str
    timing_name: str
    motion_name: str
    timeout_name: str
    timeout: Timeout | None
    has_updates: bool
    tells_missed: bool
    dump_name: str
    kernel: KernelView
    timer: TimerView
    vector: str
    handler: str
    count: str
    state: str
    variables: tuple[Named, ...]
    releases: bool
    switches: bool
    holds: bool
    wake_top: str
    need: Need | None
    sharers: tuple[str, ...]
    switch_on: tuple[Change, ...]
    switch_off: tuple[Change, ...]
    at_start: tuple[Change, ...]
    outputs: tuple[Bits, ...]
    isr_contract: tuple[str, ...]
    usual: tuple[Line, ...]
    clock: tuple[Line, ...]
    late: tuple[Line, ...]
    rare: tuple[Line, ...]
    operands: tuple[Line, ...]
    wires: tuple[Named, ...]
    example_speed_sps: int
    turn_steps: str
    turn_back: str
    turn_text: str
    loop_text: str


def motor_view(motor: MotorPlan, plan: Plan) -> MotorView:
    """
    Return everything that the templates print about *motor* of *plan*.
    """
    storage, board, drive = motor.storage, plan.board, motor.drive
    places = _turn_places(motor)
    mcu, need = board.mcu, need_of(motor, plan)
    lows = [wire for wire in drive.every_wire if not (need and wire in drive.enables)]
    return MotorView(
        name=motor.name,
        title=motor.name[0].upper() + motor.name[1:],
        init=init_name(motor),
        axis=axis_view(motor, need, plan),
        limits_name=limits_name(motor),
        limits=limits_view(motor, plan),
        summary=summary(motor),
        period_type=period_type(plan),
        period_note=(_MINUTE,) if has_long_periods(plan) else (),
        wiring=(*wiring(motor, board), *comment_lines(sharing_note(motor, need, plan))),
        init_comment=init_comment(motor),
        start_comment=start_comment(motor, need, board.f_cpu_hz),
        release_comment=release_comment(need),
        turns=_turns(motor),
        lengths=lengths(motor, position_name(motor), board.f_cpu_hz),
        kernel_name=motor.kernel.kind,
        timing_name=motor.timing.module,
        motion_name=module_name(motor.motion.kind),
        timeout_name="none" if motor.command_timeout_ms is None else "command",
        timeout=_timeout(motor),
        has_updates=motor.motion.changes_speed,
        tells_missed=tells_missed(motor),
        dump_name=dump_name(motor) if motor.motion.dumps else "",
        kernel=kernel_view(motor.kernel),
        timer=timer_view(motor),
        vector=motor.timing.vector,
        handler=motor.handler,
        count=storage.count.name,
        state=storage.state.name,
        variables=_variables(motor),
        releases=motor.releases_at_rest,
        need=need,
        sharers=need.others if need else (),
        switches=motor.switches_current,
        holds=motor.switches_current and not motor.releases_at_rest,
        wake_top=f"{motor.wake_cycles}UL",
        switch_on=switched(drive.enables, mcu, active=True),
        switch_off=switched(drive.released, mcu, active=False),
        at_start=switched(tuple(lows), mcu, active=False),
        outputs=bit_groups(drive.every_wire, mcu),
        isr_contract=isr_contract(motor),
        usual=instruction_lines(motor.hot_path.usual),
        clock=instruction_lines(motor.hot_path.clock),
        late=instruction_lines(motor.hot_path.late),
        rare=instruction_lines(motor.hot_path.boundary),
        operands=operand_lines(motor),
        wires=tuple(_wires(motor)),
        example_speed_sps=example_speed_sps(plan),
        turn_steps=places[1],
        turn_back=places[0],
        turn_text=_turn_text(motor),
        loop_text=_loop_text(motor),
    )


def _turn_text(motor: MotorPlan) -> str:
    """
    Return how far the examples turn *motor*: a turn, unless its range is shorter.
    """
    near, far = example_places(motor)
    steps = far - near
    if motor.steps_per_turn and steps == round(motor.steps_per_turn):
        return "One turn"
    return f"{steps} steps"


def _turn_places(motor: MotorPlan) -> tuple[str, str]:
    """
    Return the places between which the examples turn *motor*, as C text.
    """
    near, far = example_places(motor)
    if motor.steps_per_turn and (near, far) == (0, round(motor.steps_per_turn)):
        return "0", f"{motor.name}StepsForTurns(1)"
    return str(near), str(far)


def example_places(motor: MotorPlan) -> tuple[int, int]:
    """
    Return the places between which the examples turn *motor*, in steps.
    """
    steps = round(motor.steps_per_turn) if motor.steps_per_turn else _EXAMPLE_STEPS
    return motor.end_stops.to_and_fro(steps) if motor.end_stops else (0, steps)


def has_long_periods(plan: Plan) -> bool:
    """
    Return whether steps of *plan* can be minutes apart; then they can in all of its motors.
    """
    return any(motor.timing.has_long_periods for motor in plan.motors)


def period_type(plan: Plan) -> str:
    """
    Return the type of a virtual timer TOP: 32 bits are 268 s at 16 MHz.
    """
    return "uint64_t" if has_long_periods(plan) else "uint32_t"


def module_name(kind: str) -> str:
    """
    Return the name of the partial for *kind*, as the spec calls it.
    """
    return kind.replace("-", "_")


def _wires(motor: MotorPlan) -> Iterator[Named]:
    """
    Yield signal, pin and port bit of each wire of *motor*, those of its switches last.
    """
    for wire in motor.drive.every_wire:
        yield Named(wire.signal, wire.pin.label, wire.pin.bit.name)
    for switch in motor.end_switches:
        yield Named(switch.signal, switch.pin.label, switch.pin.bit.name)


def _turns(motor: MotorPlan) -> Turns | None:
    steps = motor.steps_per_turn
    if steps is None:
        return None
    fitting = int(_LARGEST_UINT32 / steps)
    limit = f", for up to {fitting} turns" if fitting < _LARGEST_UINT16 else ""
    if steps.denominator == 1:
        comment = f"Steps for whole turns: {steps} in each{limit}."
        return Turns(f"turns * {steps.numerator}UL", comment)
    half = steps.denominator // 2
    return Turns(
        f"static_cast<uint32_t>((turns * {steps.numerator}ULL + {half}) / {steps.denominator})",
        f"Steps for whole turns, rounded: {float(steps):.6g} in each{limit}.",
    )


def _loop_text(motor: MotorPlan) -> str:
    if motor.command_timeout_ms is None:
        return "{}  // the motor turns by itself"
    return f"{{ {motor.name}KeepAlive(); }}  // or it stops after {motor.command_timeout_ms} ms"


def _timeout(motor: MotorPlan) -> Timeout | None:
    millis = motor.command_timeout_ms
    if millis is None:
        return None
    stop = f"{motor.name}SetSpeed(MOTOR_CTRL_DRV_EN, 0)"
    return Timeout(str(millis), stop)


def _variables(motor: MotorPlan) -> tuple[Named, ...]:
    comments = {
        motor.storage.count.name: (motor.storage.count, "step interrupts until the next boundary"),
        motor.storage.state.name: (motor.storage.state, motor.kernel.state_note),
    }
    return tuple(
        Named(name, comment=comment)
        for name, (place, comment) in comments.items()
        if place.register is None and comment
    )

"""
Which example sketches a library has, and what they print beside its motors.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction

from stepgen.library.neighbours import (
    Neighbour,
    neighbour_names,
    neighbours,
    pin_view,
    serial_owner,
    spec_uses,
)
from stepgen.library.text import comment_lines, listed
from stepgen.plan.coils import CoilDrive
from stepgen.plan.model import MotorPlan, Plan
from stepgen.plan.rates import Clock
from stepgen.plan.speed_wishes import Wish, plan_wish
from stepgen.units import MILLISECONDS_PER_SECOND

_SPEED_SPS = 200  # slow enough for any motor, a 28BYJ-48 included
_BAUD, _FAST_HZ = 115_200, 16_000_000

# A ramp goes up to twice that, from a quarter of it.
_FAST_SPS = 400
_RAMP_FACTOR = 4
_RAMP_SECONDS = 3

_BY_COILS = "four-wire"  # the drive whose pins can be in a wrong order


@dataclass(frozen=True)
class Example:
    """
    An example sketch: its name, its template, and what it shows, for the README.
    """

    name: str
    template: str
    shows: str

    @property
    def path(self) -> str:
        """
        Return where it lies in the library.
        """
        return f"examples/{self.name}/{self.name}.ino"


@dataclass(frozen=True)
class Ramp:
    """
    A change of speed by *count* update events, each *modification* I/O clocks, and back.
    """

    motor: str
    title: str
    slow_sps: int
    fast_sps: int
    slow_top: int
    fast_top: int
    modification: int
    interval_ms: int
    count: int


@dataclass(frozen=True)
class Coils:
    """
    The pins of a motor's coils as C++ initialisers: the numbers, and their names in the spec.
    """

    motor: str
    pins: str
    labels: str


@dataclass(frozen=True)
class ConsoleRow:
    """
    A motor of a console for several, and its functions for current and ramp, or ``nullptr``.
    """

    motor: str
    hold: str
    release: str
    ramp: str


@dataclass(frozen=True)
class ExamplesView:
    """
    All examples of a library, and what their templates need.

    *absent* says, a line each, which one is not there and why. *guarded* are the last lines of
    setup(), *kept_alive* the first ones of loop().
    """

    sketches: tuple[Example, ...]
    absent: tuple[str, ...]
    speed_sps: int
    baud: int
    waits_for_port: bool
    first_motor: str
    serial_note: tuple[str, ...]
    console_rows: tuple[ConsoleRow, ...]
    switches: bool
    ramps: tuple[Ramp, ...]
    ramped_names: str
    coils: tuple[Coils, ...]
    neighbours: tuple[Neighbour, ...]
    together_comment: tuple[str, ...]
    guarded: tuple[str, ...]
    kept_alive: tuple[str, ...]


def examples_view(plan: Plan) -> ExamplesView:
    """
    Return the examples that suit *plan*.

    Console and WiringTest speak through Serial: where its pins have another owner they are absent.
    """
    names = listed([motor.name for motor in plan.motors])
    changing = [motor for motor in plan.motors if motor.motion.changes_speed]
    ramps = tuple(ramp for ramp in (_ramp(motor, plan) for motor in changing) if ramp)
    ramped = {ramp.motor: f"{ramp.motor}Ramp" for ramp in ramps}
    coils = tuple(_coils(motor) for motor in plan.motors if _has_order(motor))
    beside, left_out = neighbours(plan, example_speed_sps(plan))
    beside_names = neighbour_names(beside)
    owner = serial_owner(plan)
    ways = _ways(plan)
    console = _console(plan, names)
    typed = (*([console] if console else []), *([_wiring_test(coils)] if coils else []))
    return ExamplesView(
        sketches=(
            Example("Smallest", "Smallest", f"{names} from the start, for ever: where to begin"),
            Example("Turn", "Turn", f"{names} to and fro, {ways} each way"),
            *(() if owner else typed),
            *([_ramp_example(ramps)] if ramps else []),
            *([_together(names, beside_names)] if beside else []),
        ),
        absent=tuple(
            f"There is no {example.name}, which needs Serial: {owner}."
            for example in typed
            if owner
        ),
        speed_sps=example_speed_sps(plan),
        baud=_baud(plan),
        # What is printed before somebody opens a port over USB is lost, and no reset follows.
        waits_for_port=plan.board.mcu.has_usb,
        first_motor=plan.motors[0].name,
        serial_note=_serial_note(plan),
        console_rows=tuple(
            _console_row(motor, ramped.get(motor.name, "nullptr")) for motor in plan.motors
        ),
        switches=any(motor.switches_current for motor in plan.motors),
        ramps=ramps,
        ramped_names=listed(list(ramped)) if ramped else "",
        coils=coils,
        neighbours=beside,
        guarded=_guarded(plan),
        kept_alive=_kept_alive(plan),
        together_comment=comment_lines(
            f"{names} beside {beside_names}, which the spec names in `uses`: ten times a second "
            f"the sketch does something small with {'each' if beside[1:] else 'it'}. "
            f"{' '.join(left_out)}"
        ),
    )


def _guarded(plan: Plan) -> tuple[str, ...]:
    """
    Return what comes last in setup().
    """
    if plan.watchdog_ms is None:
        return ()
    return ("motorWatchdogStart();  // from here on loop() has to feed it",)


def _kept_alive(plan: Plan) -> tuple[str, ...]:
    """
    Return what loop() does first so that the watchdog and the command time-outs do nothing.
    """
    fed = f"motorWatchdogFeed();  // or the chip resets after {plan.watchdog_ms} ms"
    return (
        *((fed,) if plan.watchdog_ms is not None else ()),
        *(
            f"{motor.name}KeepAlive();  // or it stops after {motor.command_timeout_ms} ms"
            for motor in plan.motors
            if motor.command_timeout_ms is not None
        ),
    )


def _ways(plan: Plan) -> str:
    """
    Return how far the motors go in Turn.
    """
    ways = {"a turn" if motor.steps_per_turn else "200 steps" for motor in plan.motors}
    return " or ".join(sorted(ways, reverse=True))


def _baud(plan: Plan) -> int:
    """
    Return the baud of the examples: at 8 MHz 115200 would be 3.5 % off, 57600 is 2.1 %.
    """
    return _BAUD if plan.board.f_cpu_hz >= _FAST_HZ else _BAUD // 2


def _console(plan: Plan, names: str) -> Example | None:
    """
    Return the console: of axes, of one other motor or of several; none where both kinds are.
    """
    axes = [motor for motor in plan.motors if motor.motion.ladder]
    if axes and len(axes) < len(plan.motors):
        return None
    template = "AxisConsole" if axes else "ConsoleOfSeveral" if plan.motors[1:] else "Console"
    return Example(
        "Console",
        template,
        f"{names} by hand: type `help` into the Serial Monitor, {_baud(plan)} baud",
    )


def _wiring_test(coils: tuple[Coils, ...]) -> Example:
    names = listed([row.motor for row in coils])
    return Example(
        "WiringTest",
        "WiringTest",
        f"finds a wrong order of the coils of {names}, and prints the `pins` for the spec",
    )


def _ramp_example(ramps: tuple[Ramp, ...]) -> Example:
    names = listed([ramp.motor for ramp in ramps])
    return Example("Ramp", "Ramp", f"update events: the speed of {names} goes up and down")


def _together(names: str, others: str) -> Example:
    return Example("Together", "Together", f"{names} beside {others}")


def _serial_note(plan: Plan) -> tuple[str, ...]:
    if any(use.name == "Serial" for use in spec_uses(plan)):
        return ()
    return comment_lines(
        "The spec's `uses` does not name Serial: the highest rate is proven without its "
        "interrupts. Name it there before going to that limit."
    )


def example_speed_sps(plan: Plan) -> int:
    """
    Return the steps per second of the examples: 200, or the most that the library accepts.
    """
    return max(1, min(_SPEED_SPS, plan.board.f_cpu_hz // plan.minimum_period_cycles))


def _ramp(motor: MotorPlan, plan: Plan) -> Ramp | None:
    """
    Return a ramp to 400 steps/s or the most that the library accepts; None if that is nearly none.
    """
    f_cpu_hz = plan.board.f_cpu_hz
    fast_sps = min(_FAST_SPS, f_cpu_hz // plan.minimum_period_cycles)
    slow_sps = fast_sps // _RAMP_FACTOR
    if not slow_sps:
        return None
    wish = Wish(
        f_cpu_hz // slow_sps,
        f_cpu_hz // fast_sps,
        duration_ms=Fraction(_RAMP_SECONDS * MILLISECONDS_PER_SECOND),
    )
    change = plan_wish(wish, Clock(f_cpu_hz))
    return Ramp(
        motor=motor.name,
        title=motor.name[0].upper() + motor.name[1:],
        slow_sps=slow_sps,
        fast_sps=fast_sps,
        slow_top=change.start_clocks,
        fast_top=change.end.virtual_clocks,
        modification=change.modification_clocks,
        interval_ms=change.interval_ms,
        count=change.count,
    )


def _console_row(motor: MotorPlan, ramp: str) -> ConsoleRow:
    if not motor.switches_current:
        return ConsoleRow(motor.name, "nullptr", "nullptr", ramp)
    on, off = ("EnableOutputs", "DisableOutputs") if motor.motion.ladder else ("Hold", "Release")
    return ConsoleRow(motor.name, f"{motor.name}{on}", f"{motor.name}{off}", ramp)


def _has_order(motor: MotorPlan) -> bool:
    """
    Tell whether the order of the coils of *motor* is that of its pins: not so in an own table.
    """
    drive = motor.drive
    return isinstance(drive, CoilDrive) and drive.kind == _BY_COILS and drive.sequence != "table"


def _coils(motor: MotorPlan) -> Coils:
    pins = [pin_view(wire.pin) for wire in motor.drive.wires]
    return Coils(
        motor.name,
        _initialiser(pin.number for pin in pins),
        _initialiser(f'"{pin.label}"' for pin in pins),
    )


def _initialiser(items: Iterable[str]) -> str:
    return f"{{{', '.join(items)}}}"

"""
Which example sketches a library has, and what they print beside its motors.
"""

from collections.abc import Iterable
from dataclasses import dataclass

from stepgen.library.api_view import position_name
from stepgen.library.console_extras import Meaning, faults
from stepgen.library.console_view import ConsoleView, console_view
from stepgen.library.example_speeds import Ramp, example_ramp, example_speed_sps
from stepgen.library.example_trips import Trip, example_trip
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

_BAUD, _FAST_HZ = 115_200, 16_000_000

_BY_COILS = "four-wire"  # the drive whose pins can be in a wrong order


@dataclass(frozen=True)
class Example:
    """
    An example sketch: its name, which is that of its template, and what it shows, for the README.
    """

    name: str
    shows: str

    @property
    def path(self) -> str:
        """
        Return where it lies in the library.
        """
        return f"examples/{self.name}/{self.name}.ino"


@dataclass(frozen=True)
class Coils:
    """
    The pins of a motor's coils as C++ initialisers: the numbers, and their names in the spec.
    """

    motor: str
    pins: str
    labels: str


@dataclass(frozen=True)
class ExamplesView:
    """
    All examples of a library, and what their templates need.

    *absent* says, a line each, which one is not there and why. *guarded* are the last lines of
    setup(), *kept_alive* the first ones of loop(); *where* tells the position of the first motor.
    """

    sketches: tuple[Example, ...]
    how_long: str
    absent: tuple[str, ...]
    baud: int
    waits_for_port: bool
    where: str
    serial_note: tuple[str, ...]
    console: ConsoleView
    ramps: tuple[Ramp, ...]
    ramped_names: str
    coils: tuple[Coils, ...]
    trips: tuple[Trip, ...]
    home_comment: tuple[str, ...]
    faults: tuple[Meaning, ...]
    neighbours: tuple[Neighbour, ...]
    together_comment: tuple[str, ...]
    guarded: tuple[str, ...]
    kept_alive: tuple[str, ...]


def examples_view(plan: Plan) -> ExamplesView:
    """
    Return the examples that suit *plan*.

    Those that speak through Serial are absent where its pins have another owner.
    """
    names = listed([motor.name for motor in plan.motors])
    changing = [motor for motor in plan.motors if motor.motion.changes_speed]
    ramps = tuple(ramp for ramp in (example_ramp(motor, plan) for motor in changing) if ramp)
    trips = tuple(trip for trip in map(example_trip, plan.motors) if trip)
    coils = tuple(_coils(motor) for motor in plan.motors if _has_order(motor))
    beside, left_out = neighbours(plan, example_speed_sps(plan))
    beside_names = neighbour_names(beside)
    owner = serial_owner(plan)
    ways = _ways(plan)
    typed = (
        _console(names, _baud(plan)),
        *([_home(trips)] if trips else []),
        *([_wiring_test(coils)] if coils else []),
    )
    return ExamplesView(
        sketches=(
            Example("Smallest", f"{names} from the start, {_how_long(plan)}: where to begin"),
            Example("Turn", f"{names} to and fro, {ways} each way"),
            *(() if owner else typed),
            *([_ramp_example(ramps)] if ramps else []),
            *([_together(names, beside_names)] if beside else []),
        ),
        how_long=_how_long(plan),
        absent=tuple(
            f"There is no {example.name}, which needs Serial: {owner}."
            for example in typed
            if owner
        ),
        baud=_baud(plan),
        # What is printed before somebody opens a port over USB is lost, and no reset follows.
        waits_for_port=plan.board.mcu.has_usb,
        where=position_name(plan.motors[0]),
        serial_note=_serial_note(plan),
        console=console_view(plan, ramps, _baud(plan)),
        ramps=ramps,
        ramped_names=listed([ramp.motor for ramp in ramps]) if ramps else "",
        coils=coils,
        trips=trips,
        home_comment=comment_lines(
            f"Looks for home first, and then moves {_named(trips)} to and fro. Open the Serial "
            f"Monitor at {_baud(plan)} baud: the sketch says that it is there, or what went wrong."
        ),
        faults=faults(plan),
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


def _how_long(plan: Plan) -> str:
    """
    Return how long the motors turn in Smallest: one with a range goes to its end.
    """
    ranged = {bool(motor.end_stops and motor.end_stops.range) for motor in plan.motors}
    ways = {False: "for ever", True: "to the end of its range"}
    return " or ".join(ways[one] for one in sorted(ranged))


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


def _console(names: str, baud: int) -> Example:
    shows = f"{names} by hand: type `help` into the Serial Monitor, {baud} baud"
    return Example("Console", shows)


def _home(trips: tuple[Trip, ...]) -> Example:
    return Example("Home", f"{_named(trips)} home by the limit switch, then to and fro")


def _named(trips: tuple[Trip, ...]) -> str:
    return listed([trip.motor for trip in trips]) if trips else ""


def _wiring_test(coils: tuple[Coils, ...]) -> Example:
    names = listed([row.motor for row in coils])
    return Example(
        "WiringTest",
        f"finds a wrong order of the coils of {names}, and prints the `pins` for the spec",
    )


def _ramp_example(ramps: tuple[Ramp, ...]) -> Example:
    names = listed([ramp.motor for ramp in ramps])
    return Example("Ramp", f"update events: the speed of {names} goes up and down")


def _together(names: str, others: str) -> Example:
    return Example("Together", f"{names} beside {others}")


def _serial_note(plan: Plan) -> tuple[str, ...]:
    if any(use.name == "Serial" for use in spec_uses(plan)):
        return ()
    return comment_lines(
        "The spec's `uses` does not name Serial: the highest rate is proven without its "
        "interrupts. Name it there before going to that limit."
    )


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

"""
A driver with STEP and DIR inputs: which pins they are on, and what its datasheet asks of them.
"""

import math
from collections.abc import Sequence

from stepgen.devices import (
    DRIVERS,
    SHIELDS,
    UNFIT_DRIVERS,
    Board,
    Pin,
    PulseTimes,
    Socket,
    SocketShield,
    StepDriver,
)
from stepgen.plan.faults import Faults
from stepgen.plan.pins import missing_pin
from stepgen.plan.pulses import PulseCycles, PulseDrive
from stepgen.plan.wires import Wire
from stepgen.spec.base import KindModel
from stepgen.spec.drives.step_dir import StepDir

_NO_DRIVER = StepDriver("step/dir driver", PulseTimes(0, 0, 0, 0, 0), tuple(range(1, 257)))


def plan(
    spec: StepDir, beside: Sequence[KindModel], board: Board, faults: Faults
) -> PulseDrive | None:
    """
    Return the wires and times of the driver, or None after reporting why it cannot be.
    """
    driver = _driver(spec, faults)
    names = _names(spec, board, faults)
    if driver is None or names is None:
        return None
    is_low = _is_active_low(spec)
    wires = _wires(names, board, is_low=is_low, faults=faults)
    if wires is None:
        return None
    step, direction, *enables = wires
    others = [
        other
        for other in beside
        if isinstance(other, StepDir) and enables and _enable(other, board) == enables[0].pin
    ]
    levels = {_is_active_low(other) for other in others}
    if spec.enable and levels - {is_low}:
        faults.at("enable").report(
            f"{enables[0].pin.label} is active LOW for one driver and active HIGH for another that "
            "shares it; give each a pin of its own"
        )
        return None
    return PulseDrive(
        kind=spec.kind,
        title=driver.title,
        step=step,
        direction=direction,
        enables=tuple(enables),
        microsteps=spec.microsteps,
        cycles=_cycles(spec, driver.times, board.f_cpu_hz),
        shared_enables=bool(others),
    )


def _driver(spec: StepDir, faults: Faults) -> StepDriver | None:
    if spec.driver is None:
        return _NO_DRIVER
    driver = DRIVERS.get(spec.driver.lower())
    unfit = UNFIT_DRIVERS.get(spec.driver.lower())
    if unfit:
        faults.at("driver").report(
            f"{unfit}; take a driver with STEP and DIR, such as {next(iter(DRIVERS))}"
        )
        return None
    if driver is None:
        faults.at("driver").report(
            f"is no driver that stepgen knows; choose one of {', '.join(DRIVERS)}, or leave it out "
            "and give its `times`"
        )
        return None
    if spec.microsteps not in driver.microsteps:
        known = ", ".join(str(number) for number in driver.microsteps)
        faults.at("microsteps").report(
            f"the {driver.title} has no such setting; write one of {known}"
        )
        return None
    return driver


def _names(spec: StepDir, board: Board, faults: Faults) -> tuple[tuple[str, str], ...] | None:
    """
    Return the names of the pins of STEP, DIR and, if there is one, ENABLE, each with its field.
    """
    if spec.socket is not None:
        socket = _socket(spec.socket, board, faults)
        pins = (socket.step, socket.direction, socket.enable) if socket else ()
        return tuple((pin, "socket") for pin in pins) or None
    enable = ((spec.enable.pin, "enable"),) if spec.enable else ()
    return ((str(spec.step), "step"), (str(spec.dir), "dir"), *enable)


def _socket(text: str, board: Board, faults: Faults) -> Socket | None:
    shield, socket = _find(text)
    if shield is None or socket is None:
        known = "; ".join(f"{key} {', '.join(each.sockets)}" for key, each in SHIELDS.items())
        faults.at("socket").report(f"is no socket that stepgen knows; choose one of {known}")
        return None
    if board.name not in shield.boards:
        faults.at("socket").report(
            f"the {shield.title} does not fit the {board.title}, only {', '.join(shield.boards)}; "
            "take such a board, or give `step`, `dir` and `enable` pins"
        )
        return None
    return socket


def _find(text: str) -> tuple[SocketShield | None, Socket | None]:
    """
    Return the shield and the socket that *text* names, such as ``ramps-1.4 Z``.
    """
    name, _, place = text.strip().partition(" ")
    shield = SHIELDS.get(name.lower())
    return shield, shield.sockets.get(place.strip().upper()) if shield else None


def _is_active_low(spec: StepDir) -> bool:
    return not (spec.enable and spec.enable.active == "high")


def _wires(
    names: tuple[tuple[str, str], ...], board: Board, *, is_low: bool, faults: Faults
) -> tuple[Wire, ...] | None:
    wires: list[Wire] = []
    for signal, (name, field) in zip(("STEP", "DIR", "ENABLE"), names, strict=False):
        pin = board.find_pin(name)
        same = [wire.signal for wire in wires if wire.pin == pin]
        if pin is None:
            faults.at(field).report(f"{signal}: {missing_pin(name, board)}")
        elif same:
            faults.at(field).report(
                f"{name} is {pin.label}, which is {same[0]} already; take another pin"
            )
        else:
            wires.append(Wire(signal, pin, active_low=is_low and signal == "ENABLE"))
    return tuple(wires) if len(wires) == len(names) else None


def _enable(spec: StepDir, board: Board) -> Pin | None:
    """
    Return the pin of ENABLE of another motor; its own faults are reported where it is planned.
    """
    if spec.enable:
        return board.find_pin(spec.enable.pin)
    _, socket = _find(spec.socket or "")
    return board.find_pin(socket.enable) if socket else None


def _cycles(spec: StepDir, times: PulseTimes, f_cpu_hz: int) -> PulseCycles:
    """
    Return the times in CPU cycles, rounded up; those of the spec before those of the driver.
    """

    def cycles(given_us: float | None, known_ns: int) -> int:
        nanoseconds = known_ns if given_us is None else round(given_us * 1000)
        return math.ceil(nanoseconds * f_cpu_hz / 1_000_000_000)

    given = spec.times
    return PulseCycles(
        high=cycles(given.step_high_us, times.step_high_ns),
        low=cycles(given.step_low_us, times.step_low_ns),
        setup=cycles(given.dir_setup_us, times.dir_setup_ns),
        hold=cycles(given.dir_hold_us, times.dir_hold_ns),
        enable=cycles(given.enable_us, times.enable_ns),
    )

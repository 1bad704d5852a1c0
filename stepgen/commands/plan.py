"""
``stepgen plan``: what the planner decided, for people and for programs.
"""

import json
from collections.abc import Iterable
from pathlib import Path
from typing import Annotated

import typer

from stepgen import api
from stepgen.commands import plan_options as options
from stepgen.commands.dump import plain
from stepgen.commands.plan_rates import show_rates
from stepgen.commands.report import print_tables, say
from stepgen.plan.kernels import Drive
from stepgen.plan.limit_facts import limit_facts
from stepgen.plan.model import MotorPlan, Plan

EXAMPLE = (
    "Example: stepgen plan specs/uno_motor_shield.yaml --json or "
    "stepgen plan --from 6 --to 800 --time 7.25 --plot ramp.svg"
)

Row = tuple[str, ...]


def plan(  # noqa: PLR0913 - one parameter for each option
    spec: Annotated[
        Path | None, typer.Argument(metavar="SPEC", help="A YAML file.", show_default=False)
    ] = None,
    *,
    as_json: Annotated[bool, typer.Option("--json", help="Print all of it as JSON.")] = False,
    rate: options.RateOption = None,
    rpm: options.RpmOption = None,
    virtual: options.VirtualOption = None,
    table: options.TableOption = False,
    start: options.FromOption = None,
    to: options.ToOption = None,
    faster: options.FasterOption = None,
    slower: options.SlowerOption = None,
    updates: options.UpdatesOption = None,
    interval_ms: options.IntervalOption = None,
    time: options.TimeOption = None,
    turns: options.TurnsOption = None,
    steps: options.StepsOption = None,
    halving: options.HalvingOption = False,
    plot: options.PlotOption = None,
    f_cpu: options.OscillatorOption = None,
    clkpr: options.ClkprOption = None,
    steps_per_turn: options.StepsPerTurnOption = None,
) -> None:
    """
    Show every number that stepgen decides for a spec, or the timer's numbers for a speed.

    A SPEC gives wires, kernel, timer, range and cycles. Without one: a rate, or a speed change.
    """
    rates = options.RateWish(rate, rpm, virtual, table)
    change = options.ChangeWish(
        *(start, to, faster, slower, updates, interval_ms),
        *(time, turns, steps, halving, plot),
    )
    clock = options.ClockWish(f_cpu, clkpr, steps_per_turn)
    options.choose_form(spec, rates, change, clock)
    if spec is not None:
        _show_spec(spec, as_json=as_json)
    elif options.given(rates):
        show_rates(rates, clock.clock, as_json=as_json)
    else:
        from stepgen.commands.plan_changes import show_change  # noqa: PLC0415 - draws with XML

        show_change(change, clock.clock, as_json=as_json)


def _show_spec(spec: Path, *, as_json: bool) -> None:
    decided = api.plan(spec)
    if as_json:
        say(json.dumps(plain(decided), indent=2, ensure_ascii=False))
        return
    motors = [
        (f"Motor {motor.name}", (), (*_motor_rows(decided, motor), *_rate_rows(decided, motor)))
        for motor in decided.motors
    ]
    tables = [("Library", (), _library_rows(decided)), *motors]
    print_tables([*tables, ("Interrupts off", _HELD_HEADING, _held_rows(decided))])


def _library_rows(decided: Plan) -> Iterable[Row]:
    board = decided.board
    clock_hz = board.f_cpu_hz
    yield ("library", f"{decided.library.name} {decided.library.version}")
    yield ("board", f"{board.title}: {board.mcu.title} at {clock_hz / 1e6:g} MHz")
    yield ("uses", ", ".join(decided.uses) or "no other library")
    watchdog = decided.watchdog_ms
    yield ("watchdog", "none" if watchdog is None else f"{watchdog} ms")
    yield ("shortest period", _period(decided.minimum_period_cycles, clock_hz))
    yield ("longest period", _period(decided.largest_period_cycles, clock_hz))


def _rate_rows(decided: Plan, motor: MotorPlan) -> Iterable[Row]:
    """
    Yield the highest safe rates of *motor*, and what the last of them is made of.
    """
    limits = decided.rates[motor.name]
    for limit in limits:
        yield (f"safe {limit.beside}", _period(limit.period_cycles, decided.board.f_cpu_hz))
    yield ("limited by", limits[-1].cause)
    parts = (f"{part.cycles} {part.cause}" for part in limits[-1].parts if part.cycles)
    for name, basis in limits[-1].unproven.items():
        yield ("not proven", f"{name}: {basis}")
    yield ("cycles of a step", "\n".join(parts))


_HELD_HEADING = ("steps/s", "longest stretch of the sketch", "a step late by up to")


def _held_rows(decided: Plan) -> Iterable[Row]:
    for held in decided.held_off:
        yield (
            f"{held.steps_per_second:.6g}",
            _duration(held.stretch_cycles, decided.board.f_cpu_hz),
            _duration(held.late_cycles, decided.board.f_cpu_hz),
        )


def _duration(cycles: int, clock_hz: int) -> str:
    return f"{cycles} cycles = {cycles * 1e6 / clock_hz:.6g} us"


def _period(cycles: int, clock_hz: int) -> str:
    microseconds = cycles * 1e6 / clock_hz
    return f"{cycles} cycles = {microseconds:.10g} us: {clock_hz / cycles:.6g} steps/s"


def _motor_rows(decided: Plan, motor: MotorPlan) -> Iterable[Row]:
    path = motor.hot_path
    yield ("drive", f"{motor.drive.title}, {motor.drive.steps_text}")
    yield ("wires", "\n".join(_wires(motor.drive)))
    yield from motor.drive.facts
    yield ("ports", f"{motor.port_letters}, {'owned' if motor.owns_ports else 'shared'}")
    yield ("kernel", motor.kernel.kind)
    yield ("timer", f"{motor.timing.timer.number}, {motor.timing.kind}, {motor.timing.vector}")
    yield ("motion", motor.motion.kind)
    yield ("steps per turn", _turn(motor))
    if motor.steps_per_mm:
        yield ("steps per mm", f"{float(motor.steps_per_mm):.10g}")
    yield ("at rest", "coils off" if motor.releases_at_rest else "coils hold")
    timeout = motor.command_timeout_ms
    yield ("command time-out", "none" if timeout is None else f"{timeout} ms")
    yield from limit_facts(motor, decided.board.f_cpu_hz)
    yield ("step interrupt", f"{path.usual_cycles} cycles, response to RETI")
    if path.lap_cycles:
        yield (
            "between steps",
            f"{path.lap_cycles[0]} cycles a lap, {path.lap_cycles[-1]} the last",
        )
    yield ("at a boundary", f"at most {motor.isr_bound_cycles} cycles")
    yield (
        "until the edge",
        f"{path.edge_cycles} cycles, {path.boundary_edge_cycles} at a boundary",
    )


def _wires(drive: Drive) -> Iterable[str]:
    enable = ", shared enable" if drive.shared_enables else ", enable"
    for wire in drive.every_wire:
        active = ", active LOW" if wire.active_low else ""
        role = f"{enable}{active}" if wire in drive.enables else ""
        quiet = ", stays LOW" if wire in drive.quiet else ""
        yield f"{wire.signal}: {wire.pin.label} ({wire.pin.bit.name}){role}{quiet}"


def _turn(motor: MotorPlan) -> str:
    steps = motor.steps_per_turn
    if steps is None:
        return "not given"
    return str(steps) if steps.denominator == 1 else f"{steps} = {float(steps):.8g}"

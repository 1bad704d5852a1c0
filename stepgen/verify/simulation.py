"""
One scenario on a simulated chip, for somebody who wants to look at it.
"""

from collections.abc import Iterator
from pathlib import Path

from stepgen.plan.model import Plan
from stepgen.plan.planner import make_plan
from stepgen.spec import LoadedSpec
from stepgen.verify.firmware import build_firmware
from stepgen.verify.runner import Outcome, run_scenario
from stepgen.verify.scenario_file import default_scenario, load_scenario
from stepgen.verify.toolchain import compiler_named, default_compiler

Row = tuple[str, ...]


def simulate_spec(
    loaded: LoadedSpec, scenario: Path | None, compiler: str | None
) -> tuple[Plan, Outcome]:
    """
    Return the plan of *loaded* and how *scenario* went; without one, eight steps there and back.

    Raises:
        StepgenError: The scenario or the spec has faults, or a tool is missing.
    """
    plan = make_plan(loaded)
    chosen = load_scenario(scenario, plan) if scenario else default_scenario(plan)
    tools = compiler_named(compiler) if compiler else default_compiler()
    firmware = build_firmware(plan, loaded.document.text, tools)
    return plan, run_scenario(loaded, plan, firmware.bench, chosen)


def port_rows(plan: Plan, outcome: Outcome) -> Iterator[Row]:
    """
    Yield cycle, milliseconds, cycles since the row before, port and wires for each change.
    """
    wires = [
        (wire.pin.bit, f"{motor.name} {wire.signal}")
        for motor in plan.motors
        for wire in motor.drive.every_wire
    ]
    held: dict[str, int] = {}
    first = outcome.answers[0].begin_cycle if outcome.answers else 0
    before = first
    for state in outcome.trace.ports:
        changed = held.get(state.port, 0) ^ state.value
        held[state.port] = state.value
        moved = [
            f"{name} {'on' if state.value >> bit.bit & 1 else 'off'}"
            for bit, name in wires
            if bit.port == state.port and changed >> bit.bit & 1
        ]
        if moved and state.cycle >= first:
            since_start_ms = (state.cycle - first) * 1000 / plan.board.f_cpu_hz
            yield (
                str(state.cycle),
                f"{since_start_ms:.4f}",
                str(state.cycle - before),
                f"{state.port} {state.value:08b}",
                ", ".join(moved),
            )
            before = state.cycle


def call_rows(plan: Plan, outcome: Outcome) -> Iterator[Row]:
    """
    Yield cycle, motor, call and what it returned.
    """
    for answer in outcome.answers:
        call = answer.call
        name = plan.motors[call.motor].name
        arguments = f"0x{call.control:02X}, {call.top}, {call.limit}"
        result = f"returned {answer.result}"
        if call.kind.name == "READ":
            arguments, result = "", f"status 0x{answer.status:02X}, position {answer.position}"
        shown = f"{call.kind.name.lower()}({arguments if call.kind.name == 'SET_SPEED' else ''})"
        yield (str(answer.begin_cycle), name, shown, result)

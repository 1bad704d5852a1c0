"""
At the highest rate nothing is lost, beside what is named; beyond it steps are, and that is seen.
"""

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest

from stepgen import api
from stepgen.plan.model import Plan
from stepgen.verify.events import Kind
from stepgen.verify.firmware import build_firmware
from stepgen.verify.runner import run_scenario
from stepgen.verify.scenarios import standard_scenarios
from stepgen.verify.simavr import Machine
from stepgen.verify.toolchain import default_compiler
from stepgen.verify.trace import Run, Trace

SPECS = Path(__file__).parents[2] / "specs"
RUN_CYCLES = 8_000_000
SETTLE_CYCLES = 200_000  # setup() is over, and the motor runs

MachineWith = Callable[[str, str], Machine]

HELD_OFF = """
#include <Arduino.h>
#include <{library}.h>
void setup() {{
  motorShieldInit();
  motorSetSpeed(MOTOR_CTRL_DRV_EN, {top}UL);
}}
void loop() {{
  cli();
  __builtin_avr_delay_cycles({stretch} - 2);
  sei();
  __builtin_avr_delay_cycles(1009);
}}
"""
BUSY_LINE = """
#include <Arduino.h>
#include <{library}.h>
volatile uint16_t received;
void setup() {{
  motorShieldInit();
  Serial.begin(115200);
  motorSetSpeed(MOTOR_CTRL_DRV_EN, MOTOR_MIN_TOP);
}}
void loop() {{
  if (Serial.availableForWrite()) Serial.write('U');
  if (Serial.available() && Serial.read() == 'x') ++received;
}}
"""


def runs_of(machine: Machine, plan: Plan) -> list[Run]:
    """
    Return the step interrupts of the first motor, once it runs.
    """
    mcu = plan.board.mcu
    trace = Trace(machine.events(), mcu)
    runs = trace.runs(mcu.vector(plan.motors[0].timing.vector).number)
    return [run for run in runs if run.raised > SETTLE_CYCLES]


def held_off(machine_with: MachineWith, stem: str, top: int, stretch: int) -> list[Run]:
    """
    Return the step interrupts beside a sketch that has interrupts off for *stretch* over and over.
    """
    plan = api.plan(SPECS / f"{stem}.yaml")
    sketch = HELD_OFF.format(library=plan.library.name, top=top, stretch=stretch)
    with machine_with(stem, sketch) as machine:
        machine.run_until(RUN_CYCLES)
        return runs_of(machine, plan)


def gaps(runs: list[Run]) -> set[int]:
    """
    Return the times between two interrupts that were raised.
    """
    return {after.raised - before.raised for before, after in pairwise(runs)}


@pytest.mark.parametrize("stem", ["uno_motor_shield", "uno_variable_speed", "mega_uln2003_port_k"])
@pytest.mark.parametrize("row", [-1, -2, -4])
def test_interrupts_off_for_as_long_as_stated_lose_no_step(
    stem: str, row: int, machine_with: MachineWith
) -> None:
    """
    Each step comes, late by the stretch and what else it waits for at most.
    """
    held = api.plan(SPECS / f"{stem}.yaml").held_off[row]

    runs = held_off(machine_with, stem, held.period_cycles, held.stretch_cycles)

    assert gaps(runs) == {held.period_cycles}
    late = max(run.entered - run.raised for run in runs)
    assert 0.9 * held.stretch_cycles < late <= held.late_cycles


@pytest.mark.parametrize("row", [-1, -4])
def test_interrupts_off_for_longer_lose_steps(row: int, machine_with: MachineWith) -> None:
    """
    A stretch of a whole period and more lets a second overflow go by unnoticed.
    """
    held = api.plan(SPECS / "uno_motor_shield.yaml").held_off[row]

    runs = held_off(machine_with, "uno_motor_shield", held.period_cycles, held.period_cycles + 100)

    assert 2 * held.period_cycles in gaps(runs)


def test_a_line_that_is_busy_both_ways_loses_no_step(machine_with: MachineWith) -> None:
    """
    `uses: [Serial]`: at the highest rate, with bytes at 115200 baud out and in without a pause.
    """
    plan = api.plan(SPECS / "nano_uln2003_port_c.yaml")
    sketch = BUSY_LINE.format(library=plan.library.name)
    with machine_with("nano_uln2003_port_c", sketch) as machine:
        machine.run_until(SETTLE_CYCLES)
        machine.send_serial(b"x" * 4000)
        machine.run_until(RUN_CYCLES)
        runs = runs_of(machine, plan)
        received = int.from_bytes(machine.read_ram(machine.symbol("received"), 2), "little")
        sent = int((machine.events()["kind"] == Kind.UART).sum())

    assert gaps(runs) == {plan.minimum_period_cycles}
    assert len(runs) > (RUN_CYCLES - SETTLE_CYCLES) // plan.minimum_period_cycles - 2
    assert received == 4000
    assert sent > 5000  # of 5735 that last 1360 clocks each


def test_a_rate_far_beyond_the_bound_fails_verification() -> None:
    """
    A step each 100 clocks: its longest interrupt is over 150, and that of millis over 100.
    """
    path = SPECS / "uno_motor_shield.yaml"
    loaded, plan = api.load(path), replace(api.plan(path), minimum_period_cycles=100)
    firmware = build_firmware(plan, loaded.document.text, default_compiler())
    long_run = standard_scenarios(plan)[0]

    outcome = run_scenario(loaded, plan, firmware.bench, long_run)

    assert "steps at the fastest rate" in long_run.name
    assert any("no step interrupt for the step due" in finding for finding in outcome.findings)

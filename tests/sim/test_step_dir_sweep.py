"""
System 4: the Z axis of a RAMPS 1.4, swept from 0 to 3 mm/s, and what CTC does with late interrupts.
"""

import shutil
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

from stepgen import api
from stepgen.devices import find_board
from stepgen.library.render import template_dir
from stepgen.verify.bench import Call, CallKind, Loop
from stepgen.verify.firmware import build_firmware
from stepgen.verify.runner import run_scenario
from stepgen.verify.scenarios import BACK, DRIVE, Action, Scenario, Wait
from stepgen.verify.simavr import Machine
from stepgen.verify.toolchain import default_compiler
from stepgen.verify.trace import Trace

MachineWith = Callable[..., Machine]

SPEC = Path(__file__).parents[2] / "specs" / "mega_ramps_z.yaml"
F_CPU_HZ = 16_000_000
NM_PER_STEP = 250  # 4000 pulses in a millimetre
SPEEDS_NM_PER_S = range(0, 3_000_001, 500)  # 0 to 3 mm/s in steps of 0.0005 mm/s
STEP_BIT = 3  # D46 is PL3

SWEEP = """
#include <Arduino.h>
#include <RampsZ.h>

volatile int32_t nanometres = 0, steps = 0;
volatile int32_t phase = 0;

static void sweep(uint8_t control) {
  for (uint32_t speed = 0; speed <= 3000000; speed += 20000) {
    zSetSpeed(control, zTimerCalcNanometresPerSecond(speed));
    const uint32_t start = millis();
    do Serial.println(zReadNanometres());
    while (millis() - start < 20);
  }
}

void setup() {
  Serial.begin(1000000);
  zShieldInit();
  sweep(MOTOR_CTRL_DRV_EN);
  sweep(MOTOR_CTRL_DRV_EN | MOTOR_CTRL_DIRECTION);
  zSetSpeed(MOTOR_CTRL_DRV_EN, 0);
  nanometres = zReadNanometres();
  steps = zReadPosition();
  phase = 1;
}

void loop() {}
"""

# The motor runs slowly and is made fast; then interrupts are off while its step falls due, for much
# longer than a fast interval.
HELD_UP = """
#include <Arduino.h>
#include <RampsZ.h>

void setup() {
  zShieldInit();
  for (uint8_t turn = 0; turn < 40; ++turn) {
    zSetSpeed(MOTOR_CTRL_DRV_EN, 40000);
    delay(10);
    zSetSpeed(MOTOR_CTRL_DRV_EN, 640);
    cli();
    __builtin_avr_delay_cycles(42000);
    sei();
    delayMicroseconds(400 + turn);
  }
}

void loop() {}
"""


def test_every_step_of_the_sweep_is_the_models() -> None:
    """
    All 6001 speeds, a call for each while the motor runs: no slow step, none lost, at its cycle.
    """
    plan = api.plan(SPEC)
    firmware = build_firmware(plan, SPEC.read_text(encoding="utf-8"), default_compiler())
    actions: list[Action] = []
    for control in (DRIVE, BACK):
        for speed in SPEEDS_NM_PER_S[:: 1 if control == DRIVE else 50]:
            top = F_CPU_HZ * NM_PER_STEP // speed if speed else 0
            actions += [Call(CallKind.SET_SPEED, 0, control, top), Wait(top * 3 // 2 + 200)]
            if speed % 25_000 == 0:
                actions.append(Call(CallKind.READ))

    outcome = run_scenario(
        api.load(SPEC), plan, firmware.bench, Scenario("sweep", Loop.BUSY, tuple(actions))
    )

    assert outcome.findings == ()
    assert outcome.comparisons[0].steps > len(SPEEDS_NM_PER_S)


def _rises(trace: Trace) -> list[int]:
    """
    Return when STEP rises.
    """
    states = [state for state in trace.ports if state.port == "L"]
    return [
        after.cycle
        for before, after in pairwise(states)
        if (after.value & ~before.value) >> STEP_BIT & 1
    ]


def test_a_sketch_sweeps_and_prints_all_the_while(machine_with: MachineWith) -> None:
    """
    Each interval is at most that of the slower speed; the location comes back in nanometres.
    """
    board = find_board("mega")
    assert board is not None
    with machine_with(SPEC.stem, SWEEP) as machine:
        machine.run_until(7 * F_CPU_HZ)
        trace = Trace(machine.events(), board.mcu)
        values = {
            name: int.from_bytes(machine.read_ram(machine.symbol(name), 4), "little", signed=True)
            for name in ("nanometres", "steps", "phase")
        }
    rises = _rises(trace)

    assert values["phase"] == 1
    assert values["nanometres"] == NM_PER_STEP * values["steps"]
    assert len(rises) > 10_000
    gaps = sorted(after - before for before, after in pairwise(rises))
    # The slowest of these speeds, 20 um/s, is 80 steps/s: 200 000 cycles, and a step can be late by
    # the millis and USART interrupts. The one longer gap is the stop between the two sweeps: 20 ms.
    assert gaps[-2] <= 200_000 + 500
    assert 320_000 <= gaps[-1] <= 320_000 + 200_000 + 16_000
    assert gaps[0] >= 32  # twice what an A4988 needs


def test_a_match_that_has_passed_is_served_at_once(machine_with: MachineWith) -> None:
    """
    Held up past a new and shorter TOP, the step comes as soon as it can, and not a lap later.
    """
    board = find_board("mega")
    assert board is not None
    with machine_with(SPEC.stem, HELD_UP) as machine:
        machine.run_until(16_000_000)
        rises = _rises(Trace(machine.events(), board.mcu))

    gaps = [after - before for before, after in pairwise(rises)]
    late = [after for before, after in pairwise(gaps) if before > 40_000 + 2_000]
    assert len(late) >= 20  # steps that came more than three new intervals after they were due
    assert max(late) <= 640


def test_a_match_that_is_waited_for_is_seen(tmp_path: Path, machine_with: MachineWith) -> None:
    """
    The test above can fail: without the line that serves it, a step comes a lap later.
    """
    board = find_board("mega")
    assert board is not None
    templates = tmp_path / "templates"
    shutil.copytree(template_dir(), templates)
    file = templates / "timings" / "ctc.j2"
    text = file.read_text(encoding="utf-8")
    served = "  if ({{ timer.tcnt }} > next.top) {{ timer.tcnt }} = next.top - 1;\n"
    assert text.count(served) == 1
    file.write_text(text.replace(served, ""), encoding="utf-8")

    with machine_with(SPEC.stem, HELD_UP, templates) as machine:
        machine.run_until(16_000_000)
        rises = _rises(Trace(machine.events(), board.mcu))

    assert max(after - before for before, after in pairwise(rises)) > 65_000

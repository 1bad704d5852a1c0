"""
Random commands at random moments: position equals edges, no step lost or extra, no slow step.

The comparison with the model is that of every scenario. Seeds are stored, so that a failure can
be repeated: it names its seed.
"""

from pathlib import Path
from random import Random

import pytest

from stepgen import api
from stepgen.plan.model import Plan
from stepgen.verify.bench import Call, CallKind, Loop
from stepgen.verify.firmware import build_firmware
from stepgen.verify.runner import run_scenario
from stepgen.verify.scenarios import Action, Scenario, Wait
from stepgen.verify.toolchain import default_compiler

SPECS = Path(__file__).parents[2] / "specs"
KINDS = (
    "uno_motor_shield",
    "uno_uln2003_28byj48",
    "uno_mixed_ports",
    "mega_pan_tilt",
    "mega_uln2003_port_g",
    "mega_stacked_shields",
    "mega_stacked_shields_variable",
    "uno_variable_speed",
    "uno_three_ports_variable",
    "pro-mini-8mhz_28byj48",
    "uno_servo_beside",
    "uno_servo_beside_variable",
    "uno_two_motors",
)
WEIGHTS = {
    CallKind.SET_SPEED: 60,
    CallKind.HOLD: 5,
    CallKind.RELEASE: 5,
    CallKind.READ: 15,
    CallKind.INIT: 1,
}
CHANGING_WEIGHTS = {CallKind.UPDATE_CHECK: 10, CallKind.CALLBACKS: 4}
COMMANDS = 300  # each followed by a wait of up to a few periods
FIRST_SEED = 20_260_101
CAMPAIGN_SEEDS = 40  # 12 000 commands for each kind of spec


def random_scenario(seed: int, plan: Plan) -> Scenario:
    """
    Return calls with any control bits, speeds of every prescaler, and limits that end soon.
    """
    random = Random(seed)  # noqa: S311 - repeatable, not secret
    motors = len(plan.motors)
    actions: list[Action] = []
    for _ in range(COMMANDS):
        motor = random.randrange(motors)
        changes = plan.motors[motor].motion.watches_clock
        weights = {**WEIGHTS, **CHANGING_WEIGHTS} if changes else WEIGHTS
        kind = random.choices(list(weights), weights=list(weights.values()))[0]
        control = random.choice([0x80, 0x81, 0x84, 0x85, 0x80 | random.randrange(128), 0])
        top = random.choice([0, random.randrange(600, 3_000), int(2 ** random.uniform(9, 21))])
        limit = random.choice([0, 1, 2, random.randrange(1, 600)])
        update = (int(2 ** random.uniform(0, 20)), random.randrange(0, 20), random.randrange(0, 9))
        actions.append(Call(kind, motor, control, top, limit, *update))
        actions.append(Wait(int(2 ** random.uniform(4, 17))))
        actions.append(Call(CallKind.READ, motor))
    return Scenario(f"seed {seed}", random.choice([Loop.BUSY, Loop.HOSTILE]), tuple(actions))


def findings_of(stem: str, seed: int) -> tuple[str, ...]:
    """
    Run one random scenario of the spec *stem*; return what differs from the model.
    """
    path = SPECS / f"{stem}.yaml"
    loaded, plan = api.load(path), api.plan(path)
    firmware = build_firmware(plan, loaded.document.text, default_compiler())
    return run_scenario(loaded, plan, firmware.bench, random_scenario(seed, plan)).findings


@pytest.mark.parametrize("stem", KINDS)
def test_random_commands_lose_no_step(stem: str) -> None:
    """
    Three hundred commands at any point of any period, and every edge is the model's.
    """
    assert findings_of(stem, FIRST_SEED) == ()


@pytest.mark.campaign
@pytest.mark.parametrize("seed", range(FIRST_SEED + 1, FIRST_SEED + 1 + CAMPAIGN_SEEDS))
@pytest.mark.parametrize("stem", KINDS)
def test_a_campaign_of_random_commands_loses_no_step(stem: str, seed: int) -> None:
    """
    Many more of them, each with a seed of its own.
    """
    assert findings_of(stem, seed) == ()

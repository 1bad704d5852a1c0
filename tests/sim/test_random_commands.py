"""
Random commands at random moments: position equals edges, no step lost or extra, no slow step.

The comparison with the model is that of every scenario. Seeds are stored, so that a failure can
be repeated; what fails is shrunk to a scenario file.
"""

from random import Random

import pytest

from stepgen.plan.model import Plan
from stepgen.verify.bench import Call, CallKind, Loop
from stepgen.verify.scenarios import Action, Scenario, Wait
from tests.sim.kinds import KINDS
from tests.sim.shrinking import Library

WEIGHTS = {
    CallKind.SET_SPEED: 60,
    CallKind.HOLD: 5,
    CallKind.RELEASE: 5,
    CallKind.READ: 15,
    CallKind.INIT: 1,
}
TIMED_WEIGHTS = {CallKind.KEEP_ALIVE: 10}
CHANGING_WEIGHTS = {CallKind.UPDATE_CHECK: 10, CallKind.CALLBACKS: 4}
SILENCES = 0.02  # how often the sketch says nothing for as long as a command time-out
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
        changes = plan.motors[motor].motion.changes_speed
        timed = plan.motors[motor].command_timeout_ms
        weights = WEIGHTS | (CHANGING_WEIGHTS if changes else {}) | (TIMED_WEIGHTS if timed else {})
        kind = random.choices(list(weights), weights=list(weights.values()))[0]
        control = random.choice([0x80, 0x81, 0x84, 0x85, 0x80 | random.randrange(128), 0])
        top = random.choice([0, random.randrange(600, 3_000), int(2 ** random.uniform(9, 21))])
        limit = random.choice([0, 1, 2, random.randrange(1, 600)])
        update = (int(2 ** random.uniform(0, 20)), random.randrange(0, 20), random.randrange(0, 9))
        if kind is CallKind.SET_SPEED:
            actions.append(Call(kind, motor, control, top, limit, *(update if changes else ())))
        else:
            actions.append(Call(kind, motor, control & 3 if kind is CallKind.CALLBACKS else 0))
        actions.append(Wait(int(2 ** random.uniform(4, 17))))
        if timed and random.random() < SILENCES:
            actions.append(Wait(timed * plan.board.f_cpu_hz // 1000))
        actions.append(Call(CallKind.READ, motor))
    return Scenario(f"seed {seed}", random.choice([Loop.BUSY, Loop.HOSTILE]), tuple(actions))


@pytest.mark.parametrize("stem", KINDS)
def test_random_commands_lose_no_step(stem: str) -> None:
    """
    Three hundred commands at any point of any period, and every edge is the model's.
    """
    library = Library.of(stem)

    library.must_pass(random_scenario(FIRST_SEED, library.plan))


@pytest.mark.campaign
@pytest.mark.parametrize("seed", range(FIRST_SEED + 1, FIRST_SEED + 1 + CAMPAIGN_SEEDS))
@pytest.mark.parametrize("stem", KINDS)
def test_a_campaign_of_random_commands_loses_no_step(stem: str, seed: int) -> None:
    """
    Many more of them, each with a seed of its own.
    """
    library = Library.of(stem)

    library.must_pass(random_scenario(seed, library.plan))

"""
Random commands at random moments: position equals edges, no step lost or extra, no slow step.

The comparison with the model is that of every scenario. Seeds are stored, so that a failure can
be repeated; what fails is shrunk to a scenario file.
"""

from random import Random

import pytest

from stepgen.plan.model import Plan
from stepgen.verify.bench import Call, CallKind, Loop, has_call, is_axis
from stepgen.verify.scenario_model import fields_of
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
AXIS_WEIGHTS = {
    CallKind.MOVE_TO: 14,
    CallKind.MOVE: 14,
    CallKind.RUN_FORWARD: 6,
    CallKind.RUN_BACKWARD: 6,
    CallKind.STOP: 8,
    CallKind.HALT: 3,
    CallKind.SET_PACE: 12,
    CallKind.QUEUE_MOVE_TO: 14,
    CallKind.SET_POSITION: 3,
    CallKind.HOLD: 3,
    CallKind.RELEASE: 3,
    CallKind.READ: 10,
    CallKind.INIT: 1,
}
SPRINTS = 0.03  # how often an axis runs until its levels have several steps, about
SPRINT_CYCLES = 3_000_000
SILENCES = 0.02  # how often the sketch says nothing for as long as a command time-out
LONGEST_WAIT, LONGEST_AXIS_WAIT = 17, 18  # as powers of two, in clocks; an axis has a way to go
COMMANDS = 300  # each followed by a wait of up to a few periods
FIRST_SEED = 20_260_101
CAMPAIGN_SEEDS = 40  # 12 000 commands for each kind of spec


def random_command(random: Random, motor: int, plan: Plan) -> Call:
    """
    Return a call with any control bits, a speed of any prescaler, and a limit that ends soon.
    """
    changes = plan.motors[motor].motion.changes_speed
    timed = plan.motors[motor].command_timeout_ms
    weights = WEIGHTS | (CHANGING_WEIGHTS if changes else {}) | (TIMED_WEIGHTS if timed else {})
    kind = random.choices(list(weights), weights=list(weights.values()))[0]
    control = random.choice([0x80, 0x81, 0x84, 0x85, 0x80 | random.randrange(128), 0])
    top = random.choice([0, random.randrange(600, 3_000), int(2 ** random.uniform(9, 21))])
    limit = random.choice([0, 1, 2, random.randrange(1, 600)])
    update = (int(2 ** random.uniform(0, 20)), random.randrange(0, 20), random.randrange(0, 9))
    if kind is CallKind.SET_SPEED:
        return Call(kind, motor, control, top, limit, *(update if changes else ()))
    return Call(kind, motor, control & 3 if kind is CallKind.CALLBACKS else 0)


def random_axis_command(random: Random, motor: int, plan: Plan) -> Call:
    """
    Return a call of an axis: ways from one step on, paces from too fast to slower than its start.
    """
    motion = plan.motors[motor].motion
    first = motion.ladder.first_interval_256 if motion.ladder else 0
    weights = {
        kind: weight for kind, weight in AXIS_WEIGHTS.items() if has_call(plan.motors[motor], kind)
    }
    kind = random.choices(list(weights), weights=list(weights.values()))[0]
    steps = random.choice([-1, 1]) * int(2 ** random.uniform(0, 11))
    pace = random.choice(
        [
            motion.cruise_interval_256,
            int(random.uniform(0.9, 4) * motion.cruise_interval_256),
            int(random.uniform(0.5, 1.2) * first),
            0xFFFF_FFFF if random.random() < 0.1 else motion.cruise_interval_256,
        ]
    )
    if kind is CallKind.SET_PACE:
        return Call(kind, motor, top=pace)
    return Call(kind, motor, steps=steps if "steps" in fields_of(kind) else 0)


def random_scenario(seed: int, plan: Plan) -> Scenario:
    """
    Return calls of all kinds that the motors of *plan* have, at any moments, each read after.
    """
    random = Random(seed)  # noqa: S311 - repeatable, not secret
    motors = len(plan.motors)
    actions: list[Action] = []
    for _ in range(COMMANDS):
        motor = random.randrange(motors)
        if is_axis(plan.motors[motor]) and random.random() < SPRINTS:
            run = random.choice([CallKind.RUN_FORWARD, CallKind.RUN_BACKWARD])
            actions += [Call(run, motor), Wait(SPRINT_CYCLES)]
        timed = plan.motors[motor].command_timeout_ms
        of_kind = random_axis_command if is_axis(plan.motors[motor]) else random_command
        actions.append(of_kind(random, motor, plan))
        longest = LONGEST_AXIS_WAIT if is_axis(plan.motors[motor]) else LONGEST_WAIT
        actions.append(Wait(int(2 ** random.uniform(4, longest))))
        if timed and random.random() < SILENCES:
            actions.append(Wait(timed * plan.board.f_cpu_hz // 1000))
        actions.append(Call(CallKind.READ, motor))
    # Axes take long to come to speed, minutes with a hostile sketch: that has its own scenario.
    has_axis = any(is_axis(motor) for motor in plan.motors)
    loop = random.choice([Loop.BUSY] if has_axis else [Loop.BUSY, Loop.HOSTILE])
    return Scenario(f"seed {seed}", loop, tuple(actions))


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

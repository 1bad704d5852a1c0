"""
Interrupts held up for any length at any moment: what comes too late is counted, nothing is lost.
"""

from pathlib import Path

import pytest

from stepgen import api
from stepgen.plan.model import Plan
from stepgen.spec import LoadedSpec
from stepgen.verify.bench import Call, CallKind, Loop
from stepgen.verify.firmware import build_firmware
from stepgen.verify.late_scenarios import hold_up, random_holds
from stepgen.verify.runner import Outcome, run_scenario
from stepgen.verify.scenarios import DRIVE, Action, Scenario, Wait
from stepgen.verify.toolchain import Compiler, default_compiler, find_compilers

SPECS = Path(__file__).parents[2] / "specs"
KINDS = ("uno_servo_beside", "uno_servo_beside_variable", "uno_two_motors", "mega_timer2")
FIRST_SEED = 20_260_401
HOLDS = 400
CAMPAIGN_SEEDS = 40  # 16 000 holds for each kind of spec
PERIOD = 2_048


def _outcome(
    stem: str, actions: tuple[Action, ...], loop: Loop, compiler: Compiler | None = None
) -> Outcome:
    path = SPECS / f"{stem}.yaml"
    loaded: LoadedSpec = api.load(path)
    plan: Plan = api.plan(path)
    firmware = build_firmware(plan, loaded.document.text, compiler or default_compiler())
    return run_scenario(loaded, plan, firmware.bench, Scenario("held up", loop, actions))


def _held_up_often(cycles: int) -> Outcome:
    """
    Return a run at the shortest period with interrupts off for *cycles* at all points of it.
    """
    actions: list[Action] = [Call(CallKind.SET_SPEED, control=DRIVE, top=PERIOD)]
    for index in range(300):
        actions += [Wait(PERIOD + 7 * index), hold_up(cycles)]
    return _outcome("uno_servo_beside", (*actions, Call(CallKind.READ)), Loop.BUSY)


def test_up_to_the_limit_nothing_is_counted() -> None:
    """
    970 cycles are allowed, whatever they come upon.
    """
    outcome = _held_up_often(970)

    assert outcome.findings == ()
    assert (outcome.answers[-1].missed, outcome.answers[-1].status & 0x80) == (0, 0)


def test_beyond_the_limit_as_many_are_counted_as_came_upon_a_step() -> None:
    """
    1500 cycles pass the limit of 970 if the step falls into their first 530: one in four of 2048.
    """
    outcome = _held_up_often(1_500)

    assert outcome.findings == ()
    assert outcome.answers[-1].status & 0x80
    assert 300 * 0.15 < outcome.answers[-1].missed < 300 * 0.35


@pytest.mark.parametrize("compiler", find_compilers(), ids=lambda compiler: compiler.name)
@pytest.mark.parametrize("stem", KINDS)
def test_random_holds_lose_no_step(stem: str, compiler: Compiler) -> None:
    """
    Four hundred of them between calls, and every edge, status and count is the model's.
    """
    actions = tuple(random_holds(0, FIRST_SEED, HOLDS))
    outcome = _outcome(stem, actions, Loop.HOSTILE, compiler)

    assert outcome.findings == ()
    assert any(answer.missed for answer in outcome.answers)


@pytest.mark.campaign
@pytest.mark.parametrize("seed", range(FIRST_SEED + 1, FIRST_SEED + 1 + CAMPAIGN_SEEDS))
@pytest.mark.parametrize("stem", KINDS)
def test_a_campaign_of_random_holds_loses_no_step(stem: str, seed: int) -> None:
    """
    Many more of them, each with a seed of its own, in a sketch that sleeps, waits or is busy.
    """
    loop = (Loop.BUSY, Loop.HOSTILE, Loop.SLEEP)[seed % 3]

    assert _outcome(stem, tuple(random_holds(0, seed, HOLDS)), loop).findings == ()

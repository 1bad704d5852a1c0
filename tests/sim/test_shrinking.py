"""
A scenario that fails is shrunk to a file that `stepgen simulate` replays.
"""

import shutil
from itertools import pairwise
from pathlib import Path
from random import Random

import pytest
from typer.testing import CliRunner

from stepgen.cli import app
from stepgen.library.render import template_dir
from stepgen.verify.bench import Call, CallKind, Loop
from stepgen.verify.hazard_run import run_hazards
from stepgen.verify.hazards import commands, ways
from stepgen.verify.scenario_file import load_scenario
from stepgen.verify.scenarios import Action, Scenario, Wait
from stepgen.verify.trials import Trial
from tests.sim.shrinking import Library, shrink

SEED = 20_260_501


def test_only_what_is_needed_to_fail_is_left() -> None:
    """
    Of 300 actions that fail because a hold comes after a stop, these two are left.
    """
    random = Random(SEED)  # noqa: S311 - repeatable, not secret
    every: list[Action] = [Wait(cycles) for cycles in range(300)]
    stop, hold = Call(CallKind.SET_SPEED), Call(CallKind.HOLD)
    for place, call in zip(
        sorted(random.sample(range(300), 4)), [hold, stop, hold, stop], strict=True
    ):
        every[place] = call

    def fails(scenario: Scenario) -> bool:
        seen = [action for action in scenario.actions if isinstance(action, Call)]
        return (stop, hold) in pairwise(seen)

    assert shrink(Scenario("", Loop.BUSY, tuple(every)), fails).actions == (stop, hold)


def test_a_planted_bug_becomes_a_short_file_that_replays(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """
    A period that ends while a call changes it: the file fails with the bug and passes without it.

    The bug: a call leaves a new period to the timer though the old one is already over.
    """
    templates = tmp_path / "templates"
    shutil.copytree(template_dir(), templates)
    file = templates / "timings/fast_pwm.j2"
    text, old = file.read_text(encoding="utf-8"), "if (!({{ timer.tifr }} & _BV({{ timer.tov }}))) "
    assert old in text
    file.write_text(text.replace(old, ""), encoding="utf-8")
    broken, right = Library.of("uno_motor_shield", templates), Library.of("uno_motor_shield")
    faster = commands(right.plan, 0)[0]
    usual = ways(right.plan, 0)[0]
    trials = [(0, Trial(usual, faster, offset)) for offset in range(-560, 40, 5)]
    scenario = run_hazards(broken.loaded, broken.plan, broken.elf, trials).outcome.scenario

    said = broken.failure(scenario, tmp_path)

    replay = next(tmp_path.glob("*.yaml"))
    shrunk = load_scenario(replay, right.plan)
    assert len(scenario.actions) > 1000
    assert len(shrunk.actions) <= 6
    assert "the step due at" in said
    assert replay.read_text() in said
    assert broken.fails(shrunk)
    command = ["simulate", str(right.path), "--scenario", str(replay)]
    passing = CliRunner().invoke(app, command)
    assert passing.exit_code == 0
    assert "every edge as the model says" in passing.output
    monkeypatch.setattr("stepgen.library.render.template_dir", lambda: templates)
    failing = CliRunner().invoke(app, command)
    assert failing.exit_code == 1
    assert "differs from the model: motor: no step interrupt for the step due" in failing.output

"""
Arbitrary valid specs: each compiles without a warning, runs as the model says, and within its plan.

What motors take from each other is drawn too, so that some specs are refused; those count for
nothing here, and how they are refused is tested with the loader.
"""

from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, Phase, given, reject, settings
from hypothesis import seed as seeded
from hypothesis.strategies import SearchStrategy

from stepgen import api
from stepgen.errors import StepgenError
from stepgen.verify.axis_scenarios import axis_scenarios
from stepgen.verify.bounds.judge import judge_worst_case
from stepgen.verify.firmware import build_firmware
from stepgen.verify.report import MotorFigures, SpecReport
from stepgen.verify.runner import run_scenario
from stepgen.verify.scenarios import standard_scenarios
from stepgen.verify.timeout_scenarios import timeout_scenarios
from stepgen.verify.toolchain import default_compiler
from stepgen.verify.watchdog_run import judge_watchdog
from tests.fuzz.specs import axis_specs, specs, to_yaml

FOUND = sorted((Path(__file__).parents[1] / "fuzz" / "found").iterdir())
SILENCE = ": left alone at any point of a millisecond"
FIRST_SEED = 20_260_201
GROUPS, CAMPAIGN_GROUPS = 4, 100
SPECS_IN_A_GROUP = 5
AXIS_CAMPAIGN_GROUPS = 21
SCENARIOS = ("single steps both ways", "stop while running", "refused calls", "hold and release",
             "all motors at once", "a busy, hostile sketch")  # fmt: skip


OF_AXES = (": short moves both ways", ": endless runs", ": a queue that is full",
           ": targets that change in flight", ": speeds that change in flight",
           ": outputs on and off", ": emergency stops", ": switches that are run into",
           ": moves beyond the range", ": homing")  # fmt: skip


def prove(path: Path) -> None:
    """
    Build the library of the spec in *path*, run it, and compare it with the model.
    """
    try:
        loaded, plan = api.load(path), api.plan(path)
    except StepgenError:
        reject()
    compiler = default_compiler()
    firmware = build_firmware(plan, loaded.document.text, compiler)
    report = SpecReport(str(path), compiler.name, "simavr")
    report.motors = {motor.name: MotorFigures(0) for motor in plan.motors}
    kinds = (standard_scenarios, timeout_scenarios, axis_scenarios)
    for scenario in (scenario for kind in kinds for scenario in kind(plan)):
        if scenario.name in SCENARIOS or scenario.name.endswith((SILENCE, *OF_AXES)):
            outcome = run_scenario(loaded, plan, firmware.bench, scenario)
            assert outcome.findings == (), (scenario.name, path.read_text(encoding="utf-8"))
            report.masked_cycles = max(report.masked_cycles, outcome.masked_cycles)
    if plan.watchdog_ms is not None:
        assert judge_watchdog(loaded, plan, firmware.bench) == (), path.read_text(encoding="utf-8")
    judge_worst_case(loaded, plan, firmware, compiler, report)
    assert report.passed, (report.checks, path.read_text(encoding="utf-8"))


def run_group(folder: Path, seed: int, strategy: SearchStrategy[dict[str, Any]]) -> None:
    """
    Prove the specs that hypothesis draws from *seed*: always the same ones.
    """

    @seeded(seed)
    @settings(
        max_examples=SPECS_IN_A_GROUP,
        deadline=None,
        database=None,
        phases=[Phase.generate],  # to shrink a failure takes minutes; its spec is in the message
        suppress_health_check=list(HealthCheck),
    )
    @given(data=strategy)
    def check(data: dict[str, Any]) -> None:
        path = folder / "spec.yaml"
        path.write_bytes(to_yaml(data))
        prove(path)

    check()


@pytest.mark.parametrize("path", FOUND, ids=lambda path: path.stem)
def test_what_the_campaign_found(path: Path) -> None:
    """
    Specs that once did not compile, or did not keep to their plan.
    """
    prove(path)


@pytest.mark.parametrize("seed", range(FIRST_SEED, FIRST_SEED + GROUPS))
def test_random_specs_run_as_the_model_says(tmp_path: Path, seed: int) -> None:
    """
    Twenty specs in all, of any board, drive, pins, sequence, timing and motion.
    """
    run_group(tmp_path, seed, specs())


@pytest.mark.campaign
@pytest.mark.parametrize("seed", range(FIRST_SEED + GROUPS, FIRST_SEED + GROUPS + CAMPAIGN_GROUPS))
def test_a_campaign_of_random_specs(tmp_path: Path, seed: int) -> None:
    """
    Five hundred more, each group with a seed of its own.
    """
    run_group(tmp_path, seed, specs())


def test_random_axes_run_as_the_model_says(tmp_path: Path) -> None:
    """
    Five specs of axes, of any board, drive, pins, sequence and ramp.
    """
    run_group(tmp_path, FIRST_SEED, axis_specs())


@pytest.mark.campaign
@pytest.mark.parametrize("seed", range(FIRST_SEED + 1, FIRST_SEED + AXIS_CAMPAIGN_GROUPS))
def test_a_campaign_of_random_axes(tmp_path: Path, seed: int) -> None:
    """
    A hundred more, each group with a seed of its own.
    """
    run_group(tmp_path, seed, axis_specs())

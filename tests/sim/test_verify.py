"""
Every spec is proven, with the figures that the project promises.
"""

import functools
import json
from pathlib import Path

import pytest

from stepgen import api
from stepgen.verify.report import SpecReport
from stepgen.verify.toolchain import Compiler, default_compiler, find_compilers

SPECS = sorted((Path(__file__).parents[2] / "specs").glob("*.yaml"))


verified = functools.cache(api.verify)


@pytest.fixture(scope="session")
def shield_report() -> SpecReport:
    """
    Verify the spec that most people try first.
    """
    return verified(next(path for path in SPECS if path.stem == "uno_motor_shield"))


@pytest.mark.parametrize("path", SPECS, ids=lambda path: path.stem)
def test_each_spec_moves_its_motors_as_the_model_says(path: Path) -> None:
    """
    Every scenario of every spec gives the model's edges, codes, status and positions.

    Neither is the bound of the plan so far above the proven one that it says nothing.
    """
    report = verified(path)

    assert [check for check in report.checks if not check.passed] == []
    for motor in api.plan(path).motors:
        assert motor.isr_bound_cycles < 1.2 * report.motors[motor.name].bound


@pytest.mark.parametrize("stem", ["uno_mixed_ports", "pro-mini-8mhz_28byj48"])
def test_the_newer_compiler_gives_the_same_motion(stem: str) -> None:
    """
    GCC 7.3, which the Arduino IDE ships, passes every check too.
    """
    path = next(path for path in SPECS if path.stem == stem)

    report = api.verify(path, compiler="gcc-7.3")

    assert report.compiler == "gcc-7.3"
    assert [check for check in report.checks if not check.passed] == []


def test_a_step_of_the_motor_shield_takes_thirty_cycles_at_most(shield_report: SpecReport) -> None:
    """
    The aim of the first issue: 30 cycles a step, 170 for the longest step interrupt.
    """
    motor = shield_report.motors["motor"]

    assert 20 < motor.cycles_per_step <= 30
    assert motor.measured_max <= 170
    assert motor.measured_max <= motor.bound


@pytest.mark.parametrize("compiler", find_compilers(), ids=lambda compiler: compiler.name)
def test_the_bound_of_the_motor_shield_is_what_was_measured(compiler: Compiler) -> None:
    """
    At most 190 cycles and 15 % over the longest measured; in fact a scenario goes that very way.
    """
    shield = next(path for path in SPECS if path.stem == "uno_motor_shield")

    chosen = {} if compiler == default_compiler() else {"compiler": compiler.name}
    motor = verified(shield, **chosen).motors["motor"]

    assert 0 < motor.bound <= 190
    assert motor.bound <= 1.15 * motor.measured_max
    assert motor.bound == motor.measured_max


def test_the_motor_shield_library_is_small(shield_report: SpecReport) -> None:
    """
    At most 1500 bytes of flash and 40 bytes of RAM over an empty sketch.
    """
    assert 0 < shield_report.flash_bytes <= 1500
    assert 0 < shield_report.ram_bytes <= 40


def test_the_report_is_plain_json(shield_report: SpecReport) -> None:
    """
    `verify --json` prints the keys that the design promises, and nothing that JSON lacks.
    """
    shown = json.loads(json.dumps(shield_report.as_json()))

    assert shown["passed"] is True
    assert set(shown["motors"]["motor"]["isr_cycles"]) == {"measured_max", "bound"}
    assert {"spec", "checks", "flash_bytes", "ram_bytes", "stack_bytes"} <= set(shown)
    assert {"name", "passed", "detail"} == set(shown["checks"][0])

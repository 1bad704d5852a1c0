"""
``stepgen doctor`` and ``stepgen verify --simulator``.
"""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from stepgen import api
from stepgen.cli import app
from stepgen.verify import doctor
from stepgen.verify.simulators import AVR8JS, SIMAVR

Stepgen = Callable[..., Any]


@pytest.fixture
def two_simulators(monkeypatch: pytest.MonkeyPatch) -> None:
    """
    Let there be simavr and avr8js only.
    """
    monkeypatch.setattr(doctor, "SIMULATORS", (SIMAVR, AVR8JS))


def test_it_shows_tools_points_and_what_is_wrong(stepgen: Stepgen) -> None:
    """
    Compilers and simulators with versions, a row for each point, what differs and who needs it.
    """
    run = stepgen("doctor")

    assert run.code == 0
    for text in ("gcc-5.4", "5.4.0", "simavr", "avr8js", "0.21.1", "corrected"):
        assert text in run.out
    assert (
        "  avr8js: mode 4: OCR1A below TCNT1 is met after a lap of 65 536 (ctc-wrap)\n" in run.out
    )
    assert "    needed by: nothing\n" in run.out
    assert "/usr" not in run.out


def test_its_json_has_every_point(stepgen: Stepgen) -> None:
    """
    `doctor --json` gives each point with its section, who needs it, and each verdict.
    """
    shown = json.loads(stepgen("doctor", "--json").out)
    by_name = {point["name"]: point for point in shown["points"]}

    assert shown["fit"] is True
    assert shown["simulators"]["simavr"] == "1.6"
    buffer = by_name["double-buffer"]
    assert buffer["section"] == "16.9.3"
    assert buffer["needed_by"] == ["timing fast-pwm"]
    assert buffer["simulators"]["simavr"] == {"verdict": "corrected", "findings": []}
    assert buffer["simulators"]["avr8js"] == {"verdict": "ok", "findings": []}


@pytest.mark.usefixtures("two_simulators")
def test_without_a_compiler_it_fails(monkeypatch: pytest.MonkeyPatch) -> None:
    """
    Exit code 1 when nothing can be verified here.
    """
    monkeypatch.setattr(doctor, "find_compilers", lambda: ())

    result = CliRunner().invoke(app, ["doctor"])

    assert result.exit_code == 1
    assert "none" in result.output


def test_without_the_extra_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    """
    Exit code 2 and a way out, not a traceback, where only generating was installed.
    """

    def fail() -> None:
        raise ModuleNotFoundError(name="cffi")

    monkeypatch.setattr(api, "doctor", fail)

    result = CliRunner().invoke(app, ["doctor"])

    assert result.exit_code == 2
    assert "pip install 'stepgen[verify]'" in result.output


def test_an_unknown_simulator_is_refused(stepgen: Stepgen, pan: Path) -> None:
    """
    Exit code 2, and the names to choose from.
    """
    run = stepgen("verify", pan, "--simulator", "proteus")

    assert run.code == 2
    assert "choose one of simavr, avr8js, yasimavr, or all" in run.err

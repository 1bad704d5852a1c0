"""
``stepgen doctor`` and ``stepgen verify --simulator``.
"""

import dataclasses
import json
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from stepgen import api
from stepgen.cli import app
from stepgen.verify import avr8js, doctor
from stepgen.verify.report import SpecReport
from stepgen.verify.simulators import AVR8JS, SIMAVR, Simulator

Stepgen = Callable[..., Any]


def test_it_shows_tools_points_and_what_is_wrong() -> None:
    """
    Compilers and simulators with versions, a row for each point, what differs and who needs it.
    """
    run = CliRunner().invoke(app, ["doctor"])

    assert run.exit_code == 0
    for text in ("gcc-5.4", "5.4.0", "simavr", "avr8js", "0.21.1", "corrected"):
        assert text in run.output
    assert (
        "  avr8js: mode 12: capture flag each p x (ICR1 + 1) cycles (ctc-icr-period)\n"
        in run.output
    )
    assert "    needed by: nothing\n" in run.output
    assert "/usr" not in run.output


def test_its_json_has_every_point() -> None:
    """
    `doctor --json` gives each point with its section, who needs it, and each verdict.
    """
    shown = json.loads(CliRunner().invoke(app, ["doctor", "--json"]).output)
    by_name = {point["name"]: point for point in shown["points"]}

    assert shown["fit"] is True
    assert shown["simulators"]["simavr"] == "1.6"
    buffer = by_name["double-buffer"]
    assert buffer["section"] == "16.9.3"
    assert buffer["needed_by"] == ["timing fast-pwm"]
    assert buffer["simulators"]["simavr"] == {"verdict": "corrected", "findings": []}
    assert buffer["simulators"]["avr8js"] == {"verdict": "ok", "findings": []}


def test_without_a_compiler_it_fails(monkeypatch: pytest.MonkeyPatch) -> None:
    """
    Exit code 1 when nothing can be verified here.
    """
    monkeypatch.setattr(doctor, "find_compilers", lambda: ())

    result = CliRunner().invoke(app, ["doctor"])

    assert result.exit_code == 1
    assert "none" in result.output


GONE = dataclasses.replace(SIMAVR, find_version=lambda: None)
# It calls itself simavr, but its prescaler restarts with the clock, and so on.
LIAR = dataclasses.replace(SIMAVR, open=partial(avr8js.Machine, correct=False))


@pytest.mark.parametrize("simavr", [GONE, LIAR], ids=["missing", "unlike the chip"])
def test_without_a_right_simavr_it_fails(
    monkeypatch: pytest.MonkeyPatch, simavr: Simulator
) -> None:
    """
    Exit code 1 where simavr is missing or fails a point that specs depend on.
    """
    monkeypatch.setattr(doctor, "SIMULATORS", (simavr, AVR8JS))

    result = CliRunner().invoke(app, ["doctor"])

    assert result.exit_code == 1
    assert ("not here" in result.output) == (simavr is GONE)
    assert ("    needed by: timing fast-pwm\n" in result.output) == (simavr is LIAR)


def test_without_the_extra_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    """
    Exit code 2 and a way out, not a traceback, where only generating was installed.
    """

    def fail(**_: object) -> None:
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


def test_all_runs_on_each_simulator_that_fits(monkeypatch: pytest.MonkeyPatch, pan: Path) -> None:
    """
    `--simulator all` gives a report for each usable simulator and names the others.
    """
    reasons = {"simavr": "", "avr8js": "", "yasimavr": "yasimavr 0.1.6 has no ATmega2560"}

    def verify(path: Path, *, simulator: str, **_: object) -> SpecReport:
        report = SpecReport(str(path), "gcc-5.4", simulator)
        report.check("steps", (), "fine")
        return report

    monkeypatch.setattr(api, "usable_simulators", lambda *_, **__: reasons)
    monkeypatch.setattr(api, "verify", verify)

    result = CliRunner().invoke(app, ["verify", str(pan), "--simulator", "all", "--json"])

    assert result.exit_code == 0
    assert [one["simulator"] for one in json.loads(result.stdout)] == ["simavr", "avr8js"]
    assert f"{pan}: left out: yasimavr 0.1.6 has no ATmega2560" in result.stderr

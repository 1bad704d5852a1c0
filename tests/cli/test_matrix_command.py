"""
``stepgen matrix``: one table of every spec on every compiler and simulator.
"""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from stepgen import api
from stepgen.cli import app
from stepgen.verify.report import MotorFigures, SpecReport

SPECS = Path(__file__).parents[2] / "specs"
UNO, MEGA = SPECS / "uno_servo_beside.yaml", SPECS / "mega_timer2.yaml"
NO_CHIP = "yasimavr 0.1.6 has no ATmega2560"


@pytest.fixture(autouse=True)
def no_simulation(monkeypatch: pytest.MonkeyPatch) -> None:
    """
    Three simulators are here; all that is verified passes, but what runs on avr8js for the Mega.
    """

    def verify(path: Path, *, compiler: str, simulator: str) -> SpecReport:
        report = SpecReport(str(path), compiler, simulator, motors={"motor": MotorFigures()})
        is_wrong = simulator == "avr8js" and path == MEGA
        report.check("stop while running", ("an edge too many",) if is_wrong else (), "fine")
        return report

    def usable(path: Path, *, compiler: str) -> dict[str, str]:
        assert compiler.startswith("gcc")
        return {"simavr": "", "avr8js": "", "yasimavr": NO_CHIP if path == MEGA else ""}

    monkeypatch.setattr(api, "tolerances", lambda: {"simavr": 0, "avr8js": 0, "yasimavr": 1})
    monkeypatch.setattr(api, "verify", verify)
    monkeypatch.setattr(api, "usable_simulators", usable)


def rows(output: str) -> dict[tuple[str, ...], list[str]]:
    """
    Return the columns of the first table, those of the simulators, by spec and compiler.
    """
    verdicts, _, _ = output.partition("flash")
    lines = [line.split() for line in verdicts.splitlines() if " gcc-" in line]
    return {(line[0], line[1]): line[2:] for line in lines}


def test_all_simulators_have_a_column_with_their_tolerance() -> None:
    """
    A simulator without the chip is left out with the reason, and an edge too many fails.
    """
    result = CliRunner().invoke(app, ["matrix", str(UNO), str(MEGA), "--simulator", "all"])

    assert result.exit_code == 1
    heading = result.output.splitlines()[0]
    assert heading.split()[:6] == ["spec", "compiler", "simavr", "avr8js", "yasimavr", "+-1"]
    assert rows(result.output) == {
        ("uno_servo_beside", "gcc-5.4"): ["passed", "passed", "passed"],
        ("uno_servo_beside", "gcc-7.3"): ["passed", "passed", "passed"],
        ("mega_timer2", "gcc-5.4"): ["passed", "FAILED", "-"],
        ("mega_timer2", "gcc-7.3"): ["passed", "FAILED", "-"],
    }
    assert result.output.count(f"left out: {NO_CHIP}: mega_timer2\n") == 1
    assert "(gcc-7.3, avr8js): stop while running: an edge too many" in result.output


def test_where_all_agree_it_succeeds() -> None:
    """
    Exit code 0, with simavr alone by default and with all.
    """
    for options in ([], ["--simulator", "all"]):
        assert CliRunner().invoke(app, ["matrix", str(UNO), *options]).exit_code == 0
    assert CliRunner().invoke(app, ["matrix", str(MEGA)]).exit_code == 0


def test_the_tables_fit_80_columns(monkeypatch: pytest.MonkeyPatch) -> None:
    """
    With every simulator and the spec of the longest name each word stands whole on its line.
    """
    monkeypatch.setenv("COLUMNS", "80")
    spec = max(SPECS.glob("*.yaml"), key=lambda path: len(path.stem))

    output = CliRunner().invoke(app, ["matrix", str(spec), "--simulator", "all"]).output

    lines = [line for line in output.splitlines() if " gcc-" in line]
    assert [line.split()[0] for line in lines] == [spec.stem] * 4
    headings = [line.split() for line in output.splitlines() if line.startswith("spec ")]
    assert headings == [
        ["spec", "compiler", "simavr", "avr8js", "yasimavr", "+-1"],
        ["spec", "compiler", "flash", "RAM", "a", "step", "longest"],
    ]
    assert max(map(len, output.splitlines())) <= 80

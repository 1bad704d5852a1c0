"""
``stepgen matrix``: one table of every spec on every compiler and simulator.
"""

import json
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest
from typer.testing import CliRunner, Result

from stepgen import api
from stepgen.cli import app
from stepgen.verify.ide_matrix import Build, Builds, Outcome
from stepgen.verify.report import MotorFigures, SpecReport

SPECS = Path(__file__).parents[2] / "specs"
UNO, MEGA = SPECS / "uno_servo_beside.yaml", SPECS / "mega_timer2.yaml"
PRO_MINI = SPECS / "pro-mini-8mhz_28byj48.yaml"
NO_CHIP = "yasimavr 0.1.6 has no ATmega2560"


@pytest.fixture(autouse=True)
def no_simulation(monkeypatch: pytest.MonkeyPatch) -> None:
    """
    Three simulators are here; all that is verified passes, but what runs on avr8js for the Mega.
    """

    def remembered(
        path: Path, compiler: str, simulator: str, *, may_refuse: bool
    ) -> SpecReport | str:
        assert compiler.startswith("gcc")
        if may_refuse and simulator == "yasimavr" and path == MEGA:
            return NO_CHIP
        report = SpecReport(str(path), compiler, simulator, motors={"motor": MotorFigures()})
        is_wrong = simulator == "avr8js" and path == MEGA
        report.check("stop while running", ("an edge too many",) if is_wrong else (), "fine")
        return report

    monkeypatch.setattr(api, "tolerances", lambda: {"simavr": 0, "avr8js": 0, "yasimavr": 1})
    monkeypatch.setattr(api, "_remembered", remembered)


def rows(output: str) -> dict[tuple[str, ...], list[str]]:
    """
    Return the columns of the simulators, by spec and compiler.
    """
    found: dict[tuple[str, ...], list[str]] = {}
    spec = ""
    for line in output.splitlines():
        words = line.split()
        if line.startswith("  gcc-"):
            found[spec, words[0]] = words[1:4]
        elif words:
            spec = words[0]
    return found


def matrix(*arguments: str | Path) -> Result:
    """
    Return what ``stepgen matrix`` gives.
    """
    return CliRunner().invoke(app, ["matrix", *map(str, arguments)])


def test_all_simulators_have_a_column_with_their_tolerance() -> None:
    """
    A simulator without the chip is left out with the reason, and an edge too many fails.

    All fits into 80 columns, and no cell is broken.
    """
    result = matrix(UNO, MEGA, "--no-builds", "--simulator", "all")

    assert result.exit_code == 1
    heading = result.output.splitlines()[1]
    assert heading.split()[:4] == ["simavr", "avr8js", "yasimavr", "+-1"]
    assert max(len(line) for line in result.stdout.splitlines()) <= 80
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
        assert matrix(UNO, "--no-builds", *options).exit_code == 0
    assert matrix(MEGA, "--no-builds").exit_code == 0


Pretence = Callable[[Build], Outcome]


@pytest.fixture
def pretend(monkeypatch: pytest.MonkeyPatch) -> Callable[[Pretence], None]:
    """
    Return a function that has a function say what comes of each build.
    """

    def replace(build: Pretence) -> None:
        def run(
            builds: Builds, *, libraries: Sequence[Path], jobs: int
        ) -> Iterator[tuple[Build, Outcome]]:
            assert jobs >= 1
            assert not libraries
            yield from ((job, build(job)) for job in reversed(builds.jobs))

        monkeypatch.setattr(api, "build", run)
        monkeypatch.setattr(api, "core_warnings", lambda _: {"gcc-5.4": ("/core/new.cpp:1: w",)})

    return replace


def junit_suite(report: Path) -> ET.Element:
    """
    Return the first suite of a JUnit report.
    """
    return ET.parse(report).getroot()[0]  # noqa: S314 - our own


def built(job: Build) -> Outcome:
    """
    Return a build that passed: the more letters its example has the more flash it takes.
    """
    return Outcome(1000 * len(job.example), 100)


def test_the_builds_have_a_row_for_each_board_that_fits(
    pretend: Callable[[Pretence], None],
) -> None:
    """
    With the flash of the largest example; boards of another clock are named with the reason.
    """
    pretend(built)
    result = matrix(MEGA, PRO_MINI, "--no-verify")
    table = [line.split() for line in result.stdout.splitlines()]

    assert result.exit_code == 0
    assert table[1] == ["examples", "gcc-5.4", "RAM", "gcc-7.3", "RAM"]
    assert [words[0] for words in table[3:]] == [
        *("mega_timer2", "mega:atmega2560", "megaADK"),
        *("pro-mini-8mhz_28byj48", "fio", "lilypad:atmega328", "pro:8MHzatmega328"),
    ]
    assert table[4][1:] == ["4", "10000", "100", "10000", "100"]  # WiringTest
    assert "unowifi (16 MHz, not 8 MHz): pro-mini-8mhz_28byj48" in result.stderr
    assert "1 warnings of gcc-5.4 about the Arduino core (new.cpp)" in result.stderr


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        (Outcome(1, 1, warnings=("lib.cpp:3: warning: unused",)), "lib.cpp:3: warning: unused"),
        (Outcome(failure="avr-g++ failed"), "avr-g++ failed"),
    ],
)
def test_a_warning_about_our_code_and_a_failure_fail(
    wrong: Outcome, words: str, pretend: Callable[[Pretence], None], tmp_path: Path
) -> None:
    """
    The cell says FAILED, the reason comes below, and the JUnit report has it.
    """
    pretend(lambda job: wrong if job.target.board_id == "megaADK" else built(job))
    report = tmp_path / "junit.xml"
    result = matrix(MEGA, "--no-verify", "--compiler", "gcc-7.3", "--junit", report)
    suite = junit_suite(report)
    failures = [case for case in suite if case.find("failure") is not None]

    assert result.exit_code == 1
    assert "megaADK           4          FAILED" in result.stdout
    first = "mega_timer2.yaml: Console (megaADK, gcc-7.3), and 3 builds more"
    assert f"{first}: {words}\n" in result.stderr
    assert (suite.get("tests"), suite.get("failures"), len(failures)) == ("8", "4", 4)
    assert failures[0].get("classname") == "mega_timer2 on megaADK (gcc-7.3)"


def test_warnings_about_others_and_missing_libraries_fail_nothing(
    pretend: Callable[[Pretence], None], tmp_path: Path
) -> None:
    """
    Both are said; an example without its library is skipped in the JUnit report.
    """
    pretend(
        lambda job: (
            Outcome(needs="Servo.h")
            if job.example == "Turn"
            else Outcome(9, 9, others=("Wire.cpp:1: warning: unused",))
        )
    )
    report = tmp_path / "junit.xml"
    result = matrix(MEGA, "--no-verify", "--junit", report)

    assert result.exit_code == 0
    assert result.stderr.count("not ours: Wire.cpp:1: warning: unused\n") == 1
    assert "no library has Servo.h: Turn of mega_timer2; install it" in result.stderr
    assert junit_suite(report).get("skipped") == "4"


def test_a_workflow_gets_a_job_for_each_board_and_compiler() -> None:
    """
    Each job has the specs for its board; nothing is built.
    """
    result = matrix(MEGA, UNO, "--github", "--board", "uno", "--board", "mega:atmega2560")

    assert json.loads(result.stdout) == {
        "include": [
            {"board": board, "compiler": compiler, "specs": str(spec)}
            for board, spec in (("mega:atmega2560", MEGA), ("uno", UNO))
            for compiler in ("gcc-5.4", "gcc-7.3")
        ]
    }


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        (["--board", "due"], "is no board of the Arduino core, which has yun, uno,"),
        (["--board", "fio"], "fio: none of the specs fits this board"),
        (["--compiler", "gcc-9.9"], "this compiler is not installed"),
        (["--libraries", "nowhere"], "'nowhere' does not exist"),
        (["--no-verify", "--no-builds"], "leave nothing to do"),
    ],
)
def test_what_cannot_be_is_refused(options: list[str], reason: str) -> None:
    """
    Exit code 2, before anything is verified or built.
    """
    result = matrix(MEGA, *options)

    assert result.exit_code == 2
    assert reason in result.stderr
    assert result.stdout == ""

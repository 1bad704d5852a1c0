"""
Every spec in ``specs/refused``: one fault each, refused with words, a place and a way out.

The first line of each says which words: ``# refused: <words>``.
"""

import re
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from stepgen.cli import app

ROOT = Path(__file__).resolve().parents[2]
REFUSED = sorted((ROOT / "specs" / "refused").iterdir())
FIRST_LINE = re.compile(rb"# refused: (.+)\n")


def _words(path: Path) -> str:
    match = FIRST_LINE.match(path.read_bytes())
    assert match is not None, f"{path} does not begin with `# refused: ...`"
    return match[1].decode("ascii")


def _run(*arguments: str | Path) -> Result:
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def test_there_are_enough_of_them() -> None:
    """
    Bad input of every kind is collected, as YAML files and nothing else.
    """
    assert len(REFUSED) >= 20
    assert {path.suffix for path in REFUSED} == {".yaml"}


@pytest.mark.parametrize("path", REFUSED, ids=lambda path: path.stem)
def test_check_says_what_is_wrong_and_where(path: Path) -> None:
    """
    Exactly one fault, with the words that the file asks for, at a line and column of the file.
    """
    run = _run("check", path)

    assert run.exit_code == 2
    assert run.stdout == ""
    reports = [line for line in run.stderr.splitlines() if ": error: " in line]
    assert len(reports) == 1
    place, _, message = reports[0].partition(": error: ")
    assert _words(path) in message
    assert re.fullmatch(rf"{re.escape(str(path))}:[1-9]\d*:[1-9]\d*", place)
    assert "Traceback" not in run.stderr
    assert isinstance(run.exception, SystemExit)


@pytest.mark.parametrize("path", REFUSED, ids=lambda path: path.stem)
def test_generate_writes_nothing(path: Path, tmp_path: Path) -> None:
    """
    A refused spec leaves no file and no folder behind, not even beside a spec that is fine.
    """
    fine = ROOT / "specs" / "uno_motor_shield.yaml"

    run = _run("generate", fine, path, "--output", tmp_path / "out")

    assert run.exit_code == 2
    assert _words(path) in run.stderr
    assert list(tmp_path.iterdir()) == []

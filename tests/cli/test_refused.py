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
FOLDER = ROOT / "specs" / "refused"
REFUSED = sorted(FOLDER.glob("*.yaml"))
TABLE = (FOLDER / "README.md").read_text(encoding="utf-8")
FILE_ROW = re.compile(r"^\| `(\w+\.yaml)` \| (.+) \|$", re.MULTILINE)
TEST_ROW = re.compile(r"^\| .+ \| `(tests/[\w/]+\.py)::(test_\w+)` \|$", re.MULTILINE)
WAY_OUT = re.compile(
    r"\b(?:add|choose|give|lists|look|make|move|name|put|remove|rename|save|shorten|split|take|use"
    r"|write|compare|knows|begins|runs?)\b"
)
FIRST_LINE = re.compile(rb"# refused: (.+)\n")


def _words(path: Path) -> str:
    match = FIRST_LINE.match(path.read_bytes())
    assert match is not None, f"{path} does not begin with `# refused: ...`"
    return match[1].decode("ascii")


def _run(*arguments: str | Path) -> Result:
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def test_the_table_is_that_of_the_folder() -> None:
    """
    README.md lists each file with its words, at least 60, and nothing else is in the folder.
    """
    rows = FILE_ROW.findall(TABLE)

    assert len(REFUSED) >= 60
    assert sorted(name for name, _ in rows) == [path.name for path in REFUSED]
    shown = {name: words.replace("&lt;", "<") for name, words in rows}
    assert shown == {path.name: _words(path) for path in REFUSED}
    assert {path.name for path in FOLDER.iterdir()} == {"README.md", *shown}


def test_the_table_names_tests_that_there_are() -> None:
    """
    What cannot be a file of the folder has a test, which README.md names.
    """
    rows = TEST_ROW.findall(TABLE)

    assert len(rows) == TABLE.count("| `tests/") > 20
    for path, name in rows:
        assert f"\ndef {name}(" in (ROOT / path).read_text(encoding="utf-8"), (path, name)


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
    assert WAY_OUT.search(message)
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

"""
``stepgen check``: exit codes, and faults with file, line, column and a caret.
"""

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

Stepgen = Callable[..., Any]
SpecOf = Callable[..., Path]


def test_a_good_spec_is_fine(stepgen: Stepgen, pan: Path) -> None:
    """
    A valid spec gives one line on stdout and exit code 0; warnings, on stderr, change nothing.
    """
    run = stepgen("check", pan.name)

    assert (run.code, run.out) == (0, "Pan.yaml: fine\n")
    warnings = run.err.splitlines()
    assert warnings[0].startswith("Pan.yaml: warning: motor motor: Servo needs timer 1")
    assert all(line.startswith("Pan.yaml: warning: motor motor: ") for line in warnings)


def test_a_spec_that_takes_nothing_from_others_has_no_warning(
    stepgen: Stepgen, tmp_path: Path
) -> None:
    """
    With what the sketch uses named, and a timer and pins that nobody needs, stderr is empty.
    """
    (tmp_path / "a.yaml").write_text(
        "library: A\nboard: mega\nuses: [Servo D22, analogWrite D11]\nmotors:\n"
        "  m: {drive: {kind: four-wire, pins: [A8, A9, A10, A11]}, timer: 4}\n",
        encoding="utf-8",
    )

    run = stepgen("check", "a.yaml")

    assert (run.code, run.out, run.err) == (0, "a.yaml: fine\n", "")


def test_faults_are_shown_in_their_line(stepgen: Stepgen, spec_of: SpecOf) -> None:
    """
    All faults of all specs are on stderr, each with its line and a caret; the others are fine.
    """
    spec_of("Good")
    spec_of("Bad", "{kind: four-wire, pins: [D2, D99, D4, D98]}")

    run = stepgen("check", "Bad.yaml", "Good.yaml")

    assert run.code == 2
    assert run.out == "Good.yaml: fine\n"
    # Column: 2 blanks, "motor: {drive: {kind: four-wire, pins: [" is 40 characters, "D2, " 4.
    first, line, caret, second, *_ = run.err.splitlines()
    assert first.startswith("Bad.yaml:4:47: error: D99: ")
    assert line.strip().startswith("motor: {drive: ")
    assert caret == " " * (4 + 46) + "^~~"
    assert second.startswith("Bad.yaml:4:56: error: D98: ")


def test_the_caret_stands_under_wide_characters_and_tabs(stepgen: Stepgen, tmp_path: Path) -> None:
    """
    Characters that take two columns move the caret by two.
    """
    text = 'library: {name: Pan, author: "電子"}\nboard: uno\nmotors: {m: {drive: motor-shield}}\n'
    (tmp_path / "a.yaml").write_text(text.replace('"}', '", url: 5}'), encoding="utf-8")

    _, line, caret = stepgen("check", "a.yaml").err.splitlines()

    assert caret.index("^") == line.index("5") + len("電子")


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "a.yaml:1:1: error: holds no spec"),
        (b"- 1\n", "a.yaml:1:1: error: holds no spec"),
        (b"library: A\nboard: \xff\n", "a.yaml:2:8: error: is not UTF-8"),
        (b"\xef\xbb\xbf# \xf3\n", "a.yaml:1:3: error: is not UTF-8"),
        (b"library: [A\n", "a.yaml:2:1: error: is no YAML"),
        (b"library: A\nlibrary: B\n", "a.yaml:2:1: error: the key"),
        (
            b"library: A\nboard: due\nmotors:\n  m: {drive: motor-shield}\n",
            "a.yaml:2:8: error: due: is no board that stepgen knows; choose one of",
        ),
        (b"library: A\nboard: uno\n", "error: motors is missing"),
        (b"library: A\x1b[2J\n", "a.yaml"),
        (b"library: 'A\\e'\nboard: \"u\\e[2J\"\nmotors: {m: {drive: motor-shield}}\n", "a.yaml"),
    ],
)
def test_what_is_no_spec_is_refused(
    stepgen: Stepgen, tmp_path: Path, content: bytes, message: str
) -> None:
    """
    Whatever the file holds, the answer is a message, without anything that steers a terminal.
    """
    (tmp_path / "a.yaml").write_bytes(content)

    run = stepgen("check", "a.yaml")

    assert run.code == 2
    assert message in run.err
    assert "\x1b" not in run.err


def test_what_cannot_be_read_is_refused(stepgen: Stepgen, tmp_path: Path) -> None:
    """
    A missing file, a folder and a name that is no text are faults like any other.
    """
    weird = tmp_path / os.fsdecode(b"\xff.yaml")
    weird.write_bytes(b"")

    run = stepgen("check", "missing.yaml", ".", weird.name)

    assert run.code == 2
    assert "missing.yaml: error: cannot be read (No such file or directory)" in run.err
    assert ".: error: cannot be read (Is a directory)" in run.err
    assert "\\udcff.yaml:1:1: error: holds no spec" in run.err

"""
Files that would cost time, memory or a traceback: refused with exit code 2 in 2 s and 300 MB.
"""

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from stepgen.cli import app

Stepgen = Callable[..., Any]

HEAD = "library: Mine\nboard: uno\nmotors:\n  motor: {drive: motor-shield}\n"
LIMIT_S, LIMIT_MB = 2.0, 300
ROOM = 64 * 1024 - len(HEAD) - 20  # the largest file that is read at all has 64 KiB
# A line that is repeated up to the largest size, and what is said of it.
REPEATED = {
    "comments": ("#\n", ""),
    "empty lines": ("\n", ""),
    "brackets": ("[", "a: "),
    "braces": ("{", "a: "),
    "empty lists": ("[],", "a: ["),
    "anchors": ("&a b,", "a: ["),
    "aliases": ("*a,", "a: [&a b,"),
    "dashes": ("- ", "a: "),
    "questions": ("? ", ""),
    "colons": (":", "a: "),
    "quoted strings": ("'',", "a: ["),
    "escapes": ("\\x41", 'a: "'),
    "one word": ("x", "a: "),
    "one key": ("x", ""),
    "folded text": (" x\n", "a: >\n"),
    "tags": ("!!str ", "a: "),
    "documents": ("---\n", ""),
    "digits": ("9", "a: "),
    "underscores": ("_", "a: 1"),
    "zeros": ("0", "a: 1."),
}


# A process begins with the most memory that its parent had: a small one stands in between.
MEASURE = """
import resource, subprocess, sys
code = subprocess.run(sys.argv[1:], stdout=subprocess.DEVNULL).returncode
usage = resource.getrusage(resource.RUSAGE_CHILDREN)
print(code, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024)
"""


def check(path: Path) -> tuple[str, float, float]:
    """
    Run ``stepgen check`` on *path*; return its stderr, CPU seconds and most megabytes.

    CPU time, since other processes may take the machine meanwhile.
    """
    command = [sys.executable, "-m", "stepgen", "check", str(path)]
    done = subprocess.run(
        [sys.executable, "-c", MEASURE, *command], capture_output=True, text=True, check=True
    )
    code, seconds, megabytes = map(float, done.stdout.split())
    assert code == 2, done.stderr
    assert "Traceback" not in done.stderr
    assert ": error: " in done.stderr.splitlines()[0]
    return done.stderr, seconds, megabytes


@pytest.mark.parametrize("kind", REPEATED)
def test_no_file_costs_much(tmp_path: Path, kind: str) -> None:
    """
    The largest file that is read, filled with one thing: it is refused quickly.
    """
    piece, before = REPEATED[kind]
    path = tmp_path / "a.yaml"
    path.write_text(HEAD + before + piece * (ROOM // len(piece)) + "\nend: [\n", encoding="utf-8")

    _, seconds, megabytes = check(path)

    assert seconds < LIMIT_S
    assert megabytes < LIMIT_MB


def test_100_megabytes_are_not_read(tmp_path: Path) -> None:
    """
    A file of 100 MB is refused for its size, as quickly as any other.
    """
    path = tmp_path / "a.yaml"
    with path.open("wb") as stream:
        stream.write(HEAD.encode())
        for _ in range(100):  # not at once: a child process begins with the memory of its parent
            stream.write(b"# comment\n" * 100_000)

    said, seconds, megabytes = check(path)

    assert "a.yaml: error: is larger than 64 KiB; a spec is a few dozen lines" in said
    assert seconds < LIMIT_S
    assert megabytes < LIMIT_MB


@pytest.mark.parametrize(
    ("path", "reason"),
    [
        ("/dev/zero", "is no regular file; name the YAML file of a spec"),
        ("/dev/stdin", "is no regular file; name the YAML file of a spec"),
        ("/proc/self", "cannot be read (Is a directory); name the YAML file of a spec"),
        # Of its mode a file, which no permission of root's makes readable at its beginning.
        ("/proc/self/mem", "cannot be read (Input/output error); name the YAML file of a spec"),
        ("/dev/zero:1:1", "cannot be read (No such file or directory); name the YAML file of a"),
        ("missing.yaml", "cannot be read (No such file or directory); name the YAML file of a"),
    ],
)
def test_what_is_no_file_is_not_read(path: str, reason: str) -> None:
    """
    A device, a folder, a file that cannot be read and a missing one are faults like any other.
    """
    said, seconds, _ = check(Path(path))

    assert said.startswith(f"{path}: error: {reason}")
    assert seconds < LIMIT_S


def test_a_pipe_is_not_waited_for(tmp_path: Path) -> None:
    """
    A named pipe, which nobody writes to, is refused without opening it.
    """
    os.mkfifo(tmp_path / "a.yaml")

    assert "a.yaml: error: is no regular file" in check(tmp_path / "a.yaml")[0]


@pytest.mark.parametrize(
    ("encoding", "place"),
    # The umlaut is the eleventh character; in UTF-16 its second byte is the 22nd of the line. The
    # byte order mark of UTF-16 is no UTF-8 either.
    [("utf-16", "1:1"), ("utf-16-be", "1:22"), ("latin-1", "1:11"), ("cp437", "1:11")],
)
def test_other_encodings_are_refused(tmp_path: Path, encoding: str, place: str) -> None:
    """
    What is not UTF-8 is refused at the first byte that cannot be.
    """
    path = tmp_path / "a.yaml"
    path.write_bytes(HEAD.replace("Mine", "Müller").encode(encoding))

    said, _, _ = check(path)

    assert said.startswith(f"{path}:{place}: error: is not UTF-8; save the file with that encoding")


@pytest.mark.parametrize("mark", ["", "\ufeff"])
@pytest.mark.parametrize("line_end", ["\n", "\r\n", "\r"])
def test_what_editors_do_is_fine(
    stepgen: Stepgen, tmp_path: Path, mark: str, line_end: str
) -> None:
    """
    A byte order mark in front and the line ends of other systems are no fault.
    """
    text = mark + HEAD.replace("\n", line_end)
    (tmp_path / "a.yaml").write_bytes(text.encode())

    assert stepgen("check", "a.yaml").code == 0


def test_a_fault_is_one_line(stepgen: Stepgen, tmp_path: Path) -> None:
    """
    Text of a spec cannot make up a second fault, or the end of a report.
    """
    (tmp_path / "a.yaml").write_text(
        HEAD.replace("Mine", '"x\\na.yaml:9:9: error: made up"'), encoding="utf-8"
    )

    said = stepgen("check", "a.yaml").err.splitlines()

    assert [line for line in said if line.startswith("a.yaml:9")] == []
    assert len(said) == 3  # the fault, its line and the caret


@pytest.mark.parametrize(
    "scenario",
    [
        "steps: [&a {call: read}, *a]",
        "steps: [{call: !!python/name:os.system read}]",
        "steps: " + "[" * 3000 + "]" * 3000,
        "steps: [{wait_ms: .nan}]",
        "steps: [{wait_ms: .inf}]",
        "steps: [{wait_ms: 0x" + "F" * 6000 + "}]",
        "steps: [{call: set_speed, top: 18446744073709551616}]",
        "steps: [{call: set_speed, limit: true}]",
        'steps: [{call: read, motor: "x\\na.yaml:9:9: error: made up"}]',
        'steps: [{call: read, motor: "\\e[2J"}]',
        "steps: [{call: system}]",
        "steps: [1:30]",
        "steps: {}",
        "loop: on\nsteps: [{call: read}]",
        "",
    ],
)
def test_a_scenario_is_no_way_in_either(pan: Path, tmp_path: Path, scenario: str) -> None:
    """
    The same of the file of a scenario: faults with places, before anything is compiled.
    """
    path = tmp_path / "a.yaml"
    path.write_text(scenario, encoding="utf-8")

    run = CliRunner().invoke(app, ["simulate", str(pan), "--scenario", str(path)])

    assert (run.exit_code, run.stdout) == (2, "")
    reports = [line for line in run.stderr.splitlines() if not line.startswith("    ")]
    assert reports
    assert all(line.startswith(f"{path}:") and ": error: " in line for line in reports)
    assert not [line for line in reports if line.startswith("a.yaml:9")]
    assert "\x1b" not in run.stderr

"""
The command line as users run it: a process, an exit code and two streams.
"""

import json
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest


@dataclass(frozen=True)
class Run:
    """
    What one run of stepgen gave.
    """

    code: int
    out: str
    err: str


Stepgen = Callable[..., Run]


@pytest.fixture(scope="session")
def warm() -> Iterator["subprocess.Popen[str]"]:
    """
    Yield a process that has imported stepgen, and makes the runs that it is told to.
    """
    with subprocess.Popen(
        [sys.executable, "-m", "tests.cli.warm"],
        cwd=Path(__file__).parents[2],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        encoding="utf-8",
    ) as process:
        yield process


@pytest.fixture
def stepgen(tmp_path: Path, warm: "subprocess.Popen[str]") -> Stepgen:
    """
    Return a function that runs stepgen in *tmp_path* and checks that it shows no traceback.
    """
    out, err = (tmp_path.with_name(f"{tmp_path.name}.{name}") for name in ("out", "err"))

    def run(*arguments: str | Path) -> Run:
        request = {
            "arguments": [*map(str, arguments)],
            "folder": str(tmp_path),
            "environment": dict(os.environ),
        }
        assert warm.stdin is not None
        assert warm.stdout is not None
        warm.stdin.write(f"{json.dumps(request)}\n")
        warm.stdin.flush()
        code = int(warm.stdout.readline())
        said = Run(code, out.read_text(encoding="utf-8"), err.read_text(encoding="utf-8"))
        assert "Traceback" not in said.err
        return said

    return run


@pytest.fixture
def pan(tmp_path: Path) -> Path:
    """
    Return a valid spec of the library Pan.
    """
    return write_spec(tmp_path, "Pan")


def write_spec(folder: Path, name: str, drive: str = "motor-shield") -> Path:
    """
    Write ``NAME.yaml`` with a spec of the library *name* on the Uno.
    """
    path = folder / f"{name}.yaml"
    path.write_text(
        f"library: {name}\nboard: uno\nmotors:\n  motor: {{drive: {drive}, timer: 1}}\n",
        encoding="utf-8",
    )
    return path


@pytest.fixture
def spec_of(tmp_path: Path) -> Callable[..., Path]:
    """
    Return a function that writes a spec of a library's name and, perhaps, of another drive.
    """

    def make(name: str, drive: str = "motor-shield") -> Path:
        return write_spec(tmp_path, name, drive)

    return make

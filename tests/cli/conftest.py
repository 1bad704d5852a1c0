"""
The command line as users run it: a process, an exit code and two streams.
"""

import subprocess
import sys
from collections.abc import Callable
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


@pytest.fixture
def stepgen(tmp_path: Path) -> Stepgen:
    """
    Return a function that runs stepgen in *tmp_path* and checks that it shows no traceback.
    """

    def run(*arguments: str | Path) -> Run:
        command = [sys.executable, "-m", "stepgen", *map(str, arguments)]
        done = subprocess.run(
            command, cwd=tmp_path, capture_output=True, check=False, encoding="utf-8", timeout=300
        )
        assert "Traceback" not in done.stderr
        return Run(done.returncode, done.stdout, done.stderr)

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

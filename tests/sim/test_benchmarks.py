"""
`make benchmark` measures; what comes out depends on the machine, and is not tested.
"""

import re
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path

from benchmarks.newcomer import STEPS
from benchmarks.simavr_speed import SKETCHES

ROOT = Path(__file__).parents[2]


def figures(benchmark: str, names: Iterable[str]) -> dict[str, list[float]]:
    """
    Run *benchmark* once; return the figures in the rows called *names*.
    """
    command = [sys.executable, "-m", "benchmarks", benchmark, "--rounds", "1"]
    done = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, encoding="utf-8")
    lines = {
        name: next(line for line in done.stdout.splitlines() if line.startswith(f"{name}  "))
        for name in names
    }
    return {
        name: [float(text) for text in re.findall(r"[\d.]+", line.removeprefix(name))]
        for name, line in lines.items()
    }


def test_each_sketch_has_its_figures() -> None:
    """
    A row for each: simavr alone, stepgen without and with events, and events a second.
    """
    for found in figures("simavr_speed", SKETCHES).values():
        assert len(found) == 7  # three medians, each with its worst, and the events
        assert min(found) > 0


def test_a_newcomers_way_goes_to_its_end() -> None:
    """
    A row for each step from the installation to the datasheet, and one for all.
    """
    found = figures("newcomer", [*STEPS, "all"])

    assert all(len(row) == 2 and min(row) > 0 for row in found.values())

"""
`make benchmark` measures; what comes out depends on the machine, and is not tested.
"""

import re
import subprocess
import sys
from pathlib import Path

from benchmarks.simavr_speed import SKETCHES

ROOT = Path(__file__).parents[2]


def test_each_sketch_has_its_figures() -> None:
    """
    A row for each: simavr alone, stepgen without and with events, and events a second.
    """
    command = [sys.executable, "-m", "benchmarks", "--rounds", "1"]

    done = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, encoding="utf-8")

    for name in SKETCHES:
        row = next(line for line in done.stdout.splitlines() if line.startswith(f"{name}  "))
        figures = [int(text) for text in re.findall(r"\d+", row.removeprefix(name))]
        assert len(figures) == 7  # three medians, each with its worst, and the events
        assert min(figures) > 0

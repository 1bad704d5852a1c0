"""
A newcomer's way: from nothing to a verified first motor, each command timed as a process.

stepgen's own cache is empty at the start, so that the simulator's harness and the Arduino core are
compiled; pip's is as it is, which decides most of how long the installation takes.
"""

import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from statistics import median

TITLE = "A newcomer's way to the first motor: seconds, median of the rounds (3 at most)"
HEADING = ("step", "elapsed", "of processors")

ROOT = Path(__file__).parents[1]
_MOST_ROUNDS = 3
# The Arduino IDE's own engine compiles the first example, as it would for the IDE.
_COMPILE = (
    "from pathlib import Path\n"
    "from stepgen.verify.arduino_builder import build_with_ide\n"
    "from stepgen.verify.toolchain import default_compiler\n"
    "libraries, out = Path('libraries'), Path('out')\n"
    "sketch = libraries / 'MyMotor/examples/Smallest'\n"
    "build_with_ide(sketch, libraries, 'arduino:avr:uno', default_compiler(), out)"
)
STEPS = {
    "install": ("venv/bin/python", "-m", "pip", "install", "--quiet", f"{ROOT}[verify]"),
    "init": ("venv/bin/stepgen", "init", "my_motor.yaml", "--no-ask"),
    "generate": ("venv/bin/stepgen", "generate", "my_motor.yaml", "--output", "libraries"),
    "compile": ("venv/bin/python", "-c", _COMPILE),
    "verify": ("venv/bin/stepgen", "verify", "my_motor.yaml"),
    "datasheet": ("venv/bin/stepgen", "datasheet", "my_motor.yaml"),
}


def rows(rounds: int) -> Iterator[tuple[str, ...]]:
    """
    Yield a row for each step, and one for all of them.
    """
    turns = [_turn() for _ in range(min(rounds, _MOST_ROUNDS))]
    for name in STEPS:
        yield (name, *(f"{median(turn[name][i] for turn in turns):.1f}" for i in range(2)))
    totals = [[sum(took[i] for took in turn.values()) for i in range(2)] for turn in turns]
    yield ("all", *(f"{median(total[i] for total in totals):.1f}" for i in range(2)))


def _turn() -> dict[str, tuple[float, float]]:
    """
    Return what each step took: seconds that passed, and seconds of processors.
    """
    took = {}
    with tempfile.TemporaryDirectory() as folder:
        here = Path(folder)
        subprocess.run([sys.executable, "-m", "venv", here / "venv"], check=True)
        environment = os.environ | {"STEPGEN_CACHE": str(here / "cache")}
        for name, (program, *arguments) in STEPS.items():
            began, used = time.perf_counter(), _processor_s()
            subprocess.run(
                [str(here / program), *arguments],
                cwd=here,
                env=environment,
                check=True,
                stdout=subprocess.DEVNULL,
            )
            took[name] = (time.perf_counter() - began, _processor_s() - used)
    return took


def _processor_s() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime

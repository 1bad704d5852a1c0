"""
What moves with ramps take from the sketch, and how large their libraries are.

Axes with a ramp of 2500 steps up to 10 000 steps/s, in a sketch that uses move, stop and position
and only waits. All cycles are those of the simulated chip, so that every run gives the same
figures.
"""

import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from stepgen import api
from stepgen.library.render import render_library
from stepgen.plan.model import MotorPlan, Plan
from stepgen.verify.bench import watched_registers
from stepgen.verify.simavr import Machine
from stepgen.verify.toolchain import Build, Target, build, default_compiler, empty_sketch
from stepgen.verify.trace import Trace

TITLE = "Axes with STEP and DIR on compare channels of one timer, with ramps of 2500 steps"
HEADING = (
    "axes",
    "stolen a step in cruise",
    "mean in the ramp",
    "interrupts late for the next step",
    "flash / RAM",
)
PEERS = (
    ("peer: FastAccelStepper 1.2.7", "124 to 148", "", "", "9578 / 434"),
    ("peer: grbl 1.1h", "361", "", "", "30776 / 1633"),
    ("peer: GyverStepper 2.7.2", "299", "1063", "", "4532 / 88"),
    ("peer: AccelStepper 1.64", "911", "3500", "", "5476 / 110"),
)
RAMP_STEPS = 2_480
_CRUISE_STEPS = 4_000
_PINS = (("D2", "D5"), ("D3", "D6"), ("D4", "D7"))
_EVERYTHING = " with a queue, an S-curve, switches and homing"
_MORE = ", queue: 8, jerk: 100000"
_LIMITS = """    limits:
      low: D9
      high: D10
      range: [-10, 2000000]
      homing: {speed: 3000, slow_speed: 100, back_off: 100, travel: 20000}
"""
_SETTLE_CYCLES = 20_000
_SKETCH = """
#include <Arduino.h>
#include <Bench.h>

void setup() {{
  {init}
  TIMSK0 = 0;
  {start}
}}

void loop() {{
  if (GPIOR0 == 255) {{
    {stop}
  }}
}}
"""


@dataclass(frozen=True)
class Seen:
    """
    Cycles of the step interrupts for each step, and how many steps were due before the one before.
    """

    cruise_cycles: float
    ramp_cycles: float
    late_steps: int


def rows(_rounds: int) -> Iterator[tuple[str, ...]]:
    """
    Yield a row for one and two axes on a Uno and for three on a Mega, then the peers'.
    """
    for board, count, timer, everything in (
        ("uno", 1, 1, False),
        ("uno", 2, 1, False),
        ("mega", 3, 5, False),
        ("uno", 1, 1, True),
    ):
        plan = bench_plan(board, count, timer, everything=everything)
        made = build_program(plan)
        seen = measure(plan, made.elf)
        empty = empty_sketch(Target.from_fqbn(plan.board.fqbn), default_compiler())
        yield (
            f"{count} on a {plan.board.title}{_EVERYTHING if everything else ''}",
            f"{seen.cruise_cycles:.1f}",
            f"{seen.ramp_cycles:.1f}",
            f"{seen.late_steps}",
            f"{made.flash_bytes - empty.flash_bytes} / {made.ram_bytes - empty.ram_bytes}",
        )
    yield from PEERS


def bench_plan(board: str, count: int, timer: int, *, everything: bool = False) -> Plan:
    """
    Return the plan of *count* axes on the channels of *timer* of *board*, with all there is or not.
    """
    more, limits = (_MORE, _LIMITS) if everything else ("", "")
    folder = Path(tempfile.mkdtemp(prefix="stepgen-benchmark-"))
    motors = "".join(
        f"  m{index}:\n    drive: {{kind: step-dir, step: {step}, dir: {direction}, "
        f"driver: a4988}}\n    timing: {{kind: compare, timer: {timer}}}\n    at_rest: hold\n"
        f"    motion: {{kind: trapezoid, cruise_speed: 10000, acceleration: 20000{more}}}\n{limits}"
        for index, (step, direction) in enumerate(_PINS[:count])
    )
    path = folder / "bench.yaml"
    path.write_text(f"library: Bench\nboard: {board}\nmotors:\n{motors}", encoding="utf-8")
    return api.plan(path)


def build_program(plan: Plan) -> Build:
    """
    Return the program of the library of *plan* and of the sketch.
    """
    names = [motor.name for motor in plan.motors]
    calls = {
        "init": "\n  ".join(f"{name}Init();" for name in names),
        "start": "\n  ".join(f"{name}MoveTo(1000000);" for name in names),
        "stop": "\n    ".join(_calls(motor) for motor in plan.motors),
    }
    folder = Path(tempfile.mkdtemp(prefix="stepgen-benchmark-"))
    for path, text in render_library(plan, "").items():
        if path.startswith("src/"):
            (folder / path).parent.mkdir(exist_ok=True)
            (folder / path).write_text(text, encoding="utf-8")
    file = folder / "sketch.cpp"
    file.write_text(_SKETCH.format(**calls), encoding="utf-8")
    sources = [file, *sorted((folder / "src").glob("*.cpp"))]
    target = Target.from_fqbn(plan.board.fqbn)
    return build(sources, [folder / "src"], target, default_compiler(), folder / "out")


def _calls(motor: MotorPlan) -> str:
    """
    Return the calls of *motor* that the sketch has, but does not come to.
    """
    name = motor.name
    calls = f"{name}Stop(); GPIOR1 = {name}CurrentPosition();"
    return f"{calls} {name}Home(); {name}QueueMoveTo(5);" if motor.end_stops else calls


def measure(plan: Plan, elf: Path) -> Seen:
    """
    Return what the step interrupts of *elf*, for *plan*, take in a ramp and in cruise behind it.
    """
    mcu, f_cpu = plan.board.mcu, plan.board.f_cpu_hz
    seconds = 0.5 + _CRUISE_STEPS / 10_000
    watch = watched_registers(plan)
    with Machine(elf, mcu=mcu.name, f_cpu_hz=f_cpu, watch=watch) as machine:
        machine.run_until(_SETTLE_CYCLES + round(seconds * f_cpu))
        trace = Trace(machine.events(), mcu)
    every = [trace.runs(mcu.vector(motor.timing.vector).number) for motor in plan.motors]
    ramps: list[int] = []
    cruises: list[int] = []
    late = 0
    for runs in every:
        made = 0
        for run, following in pairwise(runs):
            made += bool(run.writes)
            (ramps if made <= RAMP_STEPS else cruises).append(run.left - run.entered)
            late += following.raised < run.left and following.entered > following.raised + 8
    steps = len(every) * RAMP_STEPS
    return Seen(sum(cruises) / len(cruises), sum(ramps) / steps, late)

"""
How fast motors on the compare channels of one timer can be, and what a step takes from the sketch.

A library accepts no rate at which calls and other interrupts could put it off for good. Here
it is made to accept any, and runs at constant speed in a sketch that only waits: this is what
peers were measured by (AccelStepper and others on the same chip, with the same work). All cycles
are those of the simulated chip, so that every run gives the same figures.
"""

import re
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from stepgen import api
from stepgen.library.render import render_library
from stepgen.plan.model import Plan
from stepgen.verify.bench import watched_registers
from stepgen.verify.simavr import Machine
from stepgen.verify.toolchain import Build, Target, build, default_compiler, empty_sketch
from stepgen.verify.trace import Run, Trace

TITLE = "Motors with STEP and DIR on compare channels of one timer, at constant speed"
HEADING = (
    "motors",
    "stolen a step",
    "steps/s in all, no other interrupt",
    "beside millis",
    "latest edge beside millis",
    "error of the mean",
    "flash / RAM",
)
PEERS = (
    ("peer: FastAccelStepper 1.2.7", "124 to 148", "50k / 74k / 60k", "", "", "to 1000 ppm"),
    ("peer: Klipper's firmware", "205", "155k / 98k / 98k", "", "465", ""),
    ("peer: grbl 1.1h", "361", "30k", "", "31", "to 3115 ppm"),
    ("peer: GyverStepper 2.7.2", "299", "53k", "", "105", "to 3.8 %"),
    ("peer: AccelStepper 1.64", "911", "17k", "", "271", "to 2.2 %"),
)
PEER_SIZES = ("9578 / 434", "42 KB", "30776 / 1633", "4532 / 88", "5476 / 110")

_PINS = (("D2", "D5"), ("D3", "D6"), ("D4", "D7"))
_STEPS = 10_000
_WARM_UP_STEPS = 600  # the start, and the first of the interrupt's boundaries
_SETTLE_CYCLES = 20_000
_EASY_CYCLES = 1_000
_SKETCH = """
#include <Arduino.h>
#include <Bench.h>

void setup() {
  {init}
  if (!MILLIS) TIMSK0 = 0;
  {start}
}

void loop() {}
"""


@dataclass(frozen=True)
class Seen:
    """
    What the motors did at one period.

    Args:
        late_steps: Steps that were due before the step before them was made.
        stolen_cycles: Cycles of all step interrupts for each step.
        latest_cycles: From a step's due moment to its edge, at most.
        error_cycles: By how many cycles the last of ten thousand steps is off.
    """

    late_steps: int
    stolen_cycles: float
    latest_cycles: int
    error_cycles: int


def rows(_rounds: int) -> Iterator[tuple[str, ...]]:
    """
    Yield a row for one and two motors on a Uno and for three on a Mega, then the peers'.
    """
    for board, count, timer in (("uno", 1, 1), ("uno", 2, 1), ("mega", 3, 5)):
        plan = bench_plan(board, count, timer)
        alone, beside = (_shortest(plan, millis=millis) for millis in (0, 1))
        easy = measure(plan, _EASY_CYCLES, millis=0)
        busy = measure(plan, max(beside, alone), millis=1)
        size, f_cpu = _size(plan), plan.board.f_cpu_hz
        yield (
            f"{count} on a {plan.board.title}",
            f"{easy.stolen_cycles:.1f}",
            f"{count * f_cpu // alone}",
            f"{count * f_cpu // beside}",
            f"{busy.latest_cycles}",
            f"{busy.error_cycles} cycles in {_STEPS} steps",
            f"{size.flash_bytes} / {size.ram_bytes}",
        )
    yield from ((*peer, size) for peer, size in zip(PEERS, PEER_SIZES, strict=True))


def _shortest(plan: Plan, *, millis: int) -> int:
    """
    Return the shortest period without a late step, as of all longer ones up to a thousand cycles.
    """
    low, high = 60, _EASY_CYCLES
    while low < high:
        middle = (low + high) // 2
        if measure(plan, middle, millis=millis).late_steps:
            low = middle + 1
        else:
            high = middle
    return low


@cache
def _plan_path(board: str, count: int, timer: int) -> Path:
    folder = Path(tempfile.mkdtemp(prefix="stepgen-benchmark-"))
    motors = "".join(
        f"  m{index}:\n    drive: {{kind: step-dir, step: {step}, dir: {direction}, "
        f"driver: a4988}}\n    timing: {{kind: compare, timer: {timer}}}\n    at_rest: hold\n"
        for index, (step, direction) in enumerate(_PINS[:count])
    )
    path = folder / "bench.yaml"
    path.write_text(f"library: Bench\nboard: {board}\nmotors:\n{motors}", encoding="utf-8")
    return path


def bench_plan(board: str, count: int, timer: int) -> Plan:
    """
    Return the plan of *count* motors on the channels of *timer* of *board*.
    """
    return api.plan(_plan_path(board, count, timer))


def _build(plan: Plan, period: int, millis: int) -> Build:
    """
    Return a program of the library of *plan*, made to accept any period, whose motors have that.
    """
    names = [motor.name for motor in plan.motors]
    init = "\n  ".join(f"{name}ShieldInit();" for name in names)
    start = "\n  ".join(f"{name}SetSpeed(MOTOR_CTRL_DRV_EN, {period});" for name in names)
    sketch = _SKETCH.replace("{init}", init).replace("{start}", start)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for path, text in render_library(plan, "").items():
            if path.startswith("src/"):
                (folder / path).parent.mkdir(exist_ok=True)
                any_rate = re.sub(r"(MOTOR_MIN_TOP = )\d+", r"\g<1>60", text)
                (folder / path).write_text(any_rate, encoding="utf-8")
        file = folder / "sketch.cpp"
        file.write_text(f"#define MILLIS {millis}\n{sketch}", encoding="utf-8")
        sources = [file, *sorted((folder / "src").glob("*.cpp"))]
        target = Target.from_fqbn(plan.board.fqbn)
        made = build(sources, [folder / "src"], target, default_compiler(), folder / "out")
        kept = Path(tempfile.mkdtemp(prefix="stepgen-benchmark-")) / "bench.elf"
        made.elf.rename(kept)
        return Build(kept, made.flash_bytes, made.ram_bytes)


def _size(plan: Plan) -> Build:
    made = _build(plan, _EASY_CYCLES, 1)
    empty = empty_sketch(Target.from_fqbn(plan.board.fqbn), default_compiler())
    return Build(made.elf, made.flash_bytes - empty.flash_bytes, made.ram_bytes - empty.ram_bytes)


def measure(plan: Plan, period: int, *, millis: int) -> Seen:
    """
    Return what the motors of *plan* do with a step each *period* cycles, with or without *millis*.
    """
    mcu, elf = plan.board.mcu, _build(plan, period, millis).elf
    watch = watched_registers(plan)
    with Machine(elf, mcu=mcu.name, f_cpu_hz=plan.board.f_cpu_hz, watch=watch) as machine:
        machine.run_until(_SETTLE_CYCLES + (_STEPS + _WARM_UP_STEPS + 10) * period)
        trace = Trace(machine.events(), mcu)
    each = [
        _of_motor(trace.runs(mcu.vector(motor.timing.vector).number), period)
        for motor in plan.motors
    ]
    return Seen(
        late_steps=sum(one.late_steps for one in each),
        stolen_cycles=sum(one.stolen_cycles for one in each) / len(each),
        latest_cycles=max(one.latest_cycles for one in each),
        error_cycles=max((one.error_cycles for one in each), key=abs),
    )


def _of_motor(every: list[Run], period: int) -> Seen:
    runs = [run for run in every if run.writes]
    if len(runs) < _WARM_UP_STEPS + _STEPS:  # the sketch did not even get round to starting it
        return Seen(_STEPS, 0, 0, 0)
    first = runs[0].raised
    measured = list(enumerate(runs))[_WARM_UP_STEPS : _WARM_UP_STEPS + _STEPS]
    late = sum(run.raised != first + index * period for index, run in measured)
    latest = max(run.writes[0].cycle - first - index * period for index, run in measured)
    last, run = measured[-1]
    return Seen(
        late_steps=late,
        stolen_cycles=sum(run.left - run.entered for _, run in measured) / len(measured),
        latest_cycles=latest,
        error_cycles=run.raised - first - last * period,
    )

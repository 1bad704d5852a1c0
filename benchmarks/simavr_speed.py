"""
How many cycles a second simavr simulates: as it comes, and with what stepgen puts around it.

CPU time of one core is counted, so that other work on the machine disturbs little. The runs of all
variants take turns, for what still disturbs to meet all of them alike.
"""

import time
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from pathlib import Path
from statistics import median

from stepgen import api
from stepgen.plan.model import Plan
from stepgen.reference.contract import Control
from stepgen.verify.bench import Bench, Call, CallKind, Loop, mail
from stepgen.verify.elf import read_firmware
from stepgen.verify.firmware import build_firmware
from stepgen.verify.simavr import Machine, build
from stepgen.verify.toolchain import default_compiler

TITLE = "Simulated MHz of simavr on one core: median of the rounds (and the worst)"
HEADING = ("sketch", "simavr alone", "stepgen, no events", "stepgen", "events a second")

SPEC = Path(__file__).parents[1] / "specs" / "uno_motor_shield.yaml"
MEASURED_CYCLES = 64_000_000
_SETUP_CYCLES = 2_000_000

# What loop() does, and the clocks between two steps; 0: the motor stands still.
SKETCHES: Mapping[str, tuple[Loop, int]] = {
    "idle": (Loop.BUSY, 0),
    "400 steps/s": (Loop.BUSY, 40_000),
    "25 000 steps/s": (Loop.BUSY, 640),
    "25 000 steps/s, hostile sketch": (Loop.HOSTILE, 640),
}


def rows(rounds: int) -> Iterator[tuple[str, ...]]:
    """
    Yield a row for each sketch.
    """
    loaded, plan = api.load(SPEC), api.plan(SPEC)
    elf = build_firmware(plan, loaded.document.text, default_compiler()).bench
    variants: tuple[Callable[[Loop, int], float], ...] = (
        partial(_alone, plan, elf),
        partial(_with_stepgen, plan, elf, record=False),
        partial(_with_stepgen, plan, elf, record=True),
    )
    for name, sketch in SKETCHES.items():
        turns = [[variant(*sketch) for variant in variants] for _ in range(rounds)]
        shown = [f"{median(one):.0f} ({min(one):.0f})" for one in zip(*turns, strict=True)]
        yield (name, *shown, f"{_events_per_second(plan, elf, *sketch):.0f}")


def _alone(plan: Plan, elf: Path, loop: Loop, top: int) -> float:
    """
    Return the simulated MHz of simavr without anything of stepgen's.
    """
    module = build.load()
    firmware = read_firmware(elf)
    image, mcu = firmware.image, plan.board.mcu.name.encode()
    avr = module.lib.plain_new(mcu, plan.board.f_cpu_hz, image, len(image))
    module.lib.plain_run(avr, _SETUP_CYCLES)
    message = mail(_start(top), loop)
    mailbox = module.lib.plain_data(avr) + firmware.symbols["mailbox"]
    module.ffi.buffer(mailbox, len(message))[:] = message
    module.lib.plain_run(avr, 2 * _SETUP_CYCLES)
    mhz = _mhz(lambda: module.lib.plain_run(avr, 2 * _SETUP_CYCLES + MEASURED_CYCLES))
    module.lib.plain_free(avr)
    return mhz


def _with_stepgen(plan: Plan, elf: Path, loop: Loop, top: int, *, record: bool) -> float:
    """
    Return the simulated MHz of the machine that verification uses.
    """
    with _running(plan, elf, loop, top) as bench:
        if not record and isinstance(bench.machine, Machine):
            bench.machine.record(on=False)
        return _mhz(lambda: bench.wait(MEASURED_CYCLES))


def _events_per_second(plan: Plan, elf: Path, loop: Loop, top: int) -> float:
    with _running(plan, elf, loop, top) as bench:
        before = len(bench.events())
        bench.wait(plan.board.f_cpu_hz)
        return len(bench.events()) - before


def _running(plan: Plan, elf: Path, loop: Loop, top: int) -> Bench:
    bench = Bench(plan, elf)
    bench.set_loop(loop)
    bench.call(_start(top))
    return bench


def _start(top: int) -> Call:
    if not top:
        return Call(CallKind.READ)
    return Call(CallKind.SET_SPEED, control=Control.DRV_EN, top=top)


def _mhz(run: Callable[[], object]) -> float:
    began = time.process_time()
    run()
    return MEASURED_CYCLES / (time.process_time() - began) / 1e6

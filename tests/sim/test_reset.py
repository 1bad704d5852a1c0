"""
A reset in the middle of a move: no wire is driven until ShieldInit, and then to rest at once.

Any reset, of the watchdog, a brown-out or the button, gives each I/O register its initial value at
once and leaves RAM alone (ATmega328P datasheet, System Control and Reset): the chip after it is a
fresh one with the old RAM. Its pins are inputs without pull-ups.
"""

import shutil
from pathlib import Path
from random import Random

import pytest

from stepgen.library.render import template_dir
from stepgen.verify.bench import Bench, Call, CallKind, Loop, is_axis
from stepgen.verify.events import Kind
from stepgen.verify.resets import restless_wires
from stepgen.verify.simavr import Machine
from stepgen.verify.subject import subjects
from tests.sim.kinds import KINDS
from tests.sim.shrinking import Library

SEED = 20_260_801
RESETS = 3
_READY, _SETUP_CYCLES = 3, 2_000_000
_DRIVE = 0x80


def moving(library: Library, cycles: int) -> tuple[Bench, bytes]:
    """
    Return a chip whose motors have run for *cycles*, and its RAM.
    """
    mcu = library.plan.board.mcu
    bench = Bench(library.plan, library.elf)
    bench.set_loop(Loop.BUSY)
    for index, motor in enumerate(library.plan.motors):
        top = 4 * library.plan.minimum_period_cycles + motor.wake_cycles
        start = Call(CallKind.SET_SPEED, index, _DRIVE, top)
        bench.call(Call(CallKind.RUN_FORWARD, index) if is_axis(motor) else start)
    bench.wait(cycles)
    return bench, bench.machine.read_ram(mcu.ram_start, mcu.ram_bytes)


@pytest.mark.parametrize("stem", KINDS)
def test_a_reset_in_mid_move_leaves_every_wire_at_rest(stem: str) -> None:
    """
    Each wire goes from high impedance to its level at rest, and shows nothing in between.
    """
    random = Random(SEED)  # noqa: S311 - repeatable, not secret
    library = Library.of(stem)

    assert [
        wrong
        for _ in range(RESETS)
        for wrong in not_at_rest(library, random.randrange(20_000, 400_000))
    ] == []


def test_pins_that_become_outputs_too_early_are_noticed(tmp_path: Path) -> None:
    """
    An ENABLE that is active LOW lets current through for a moment, and the test above sees it.
    """
    templates = tmp_path / "templates"
    shutil.copytree(template_dir(), templates)
    file = templates / "src/library.cpp.j2"
    text = file.read_text(encoding="utf-8")
    levels_first = "{{ port.write(motor.at_start) | block(2) }}\n"
    outputs = "{{ port.outputs(motor.outputs) | block(2) }}\n"
    assert levels_first + outputs in text
    file.write_text(text.replace(levels_first + outputs, outputs + levels_first), encoding="utf-8")

    assert not_at_rest(Library.of("mega_ramps_z", templates), 50_000)


def not_at_rest(library: Library, cycles: int) -> list[str]:
    """
    Reset a chip whose motors have run for *cycles*; return which wires show something else.
    """
    mcu = library.plan.board.mcu
    bench, ram = moving(library, cycles)
    with bench:
        assert (bench.machine.events()["kind"] == Kind.ISR_ENTER).any()
    fresh = Machine(library.elf, mcu=mcu.name, f_cpu_hz=library.plan.board.f_cpu_hz)
    fresh.write_ram(mcu.ram_start, ram)
    assert fresh.run_until_mark(_READY, limit_cycles=_SETUP_CYCLES)
    motors = subjects(library.loaded, library.plan, library.elf)
    wrong = list(restless_wires(motors, fresh.events(), mcu))
    fresh.close()
    return wrong

"""
A reset in the middle of a move: no wire is driven until ShieldInit, and then to rest at once.

Any reset gives each I/O register its initial value at once; the pins are inputs without pull-ups
(ATmega328P datasheet, System Control and Reset). The watchdog's and the button's leave RAM alone.
A brown-out holds the chip for as long as the supply is below the level of its fuses, and what RAM
holds then nobody knows: here it is noise. What a supply does on its way down is not simulated.
"""

import shutil
from pathlib import Path
from random import Random

import pytest

from stepgen.devices import Mcu
from stepgen.library.render import template_dir
from stepgen.verify.bench import Bench, Call, CallKind, Loop, is_axis
from stepgen.verify.resets import restless_wires
from stepgen.verify.simavr import Machine
from stepgen.verify.subject import subjects
from tests.sim.kinds import KINDS
from tests.sim.shrinking import Library

SEED = 20_260_801
_SETUP_CYCLES = 2_000_000
_MCUSR = 0x54  # the same on each chip that stepgen knows
_DRIVE = 0x80
# Bits of MCUSR (datasheet, section "MCU Status Register").
WATCHDOG, BROWN_OUT, BUTTON = 0x08, 0x04, 0x02
CAUSES = {"the watchdog": WATCHDOG, "a brown-out": BROWN_OUT, "the button": BUTTON}


def moving(library: Library, cycles: int) -> Bench:
    """
    Return a chip whose motors have run for *cycles*.
    """
    bench = Bench(library.plan, library.elf)
    bench.set_loop(Loop.BUSY)
    for index, motor in enumerate(library.plan.motors):
        top = 4 * library.plan.minimum_period_cycles + motor.wake_cycles
        start = Call(CallKind.SET_SPEED, index, _DRIVE, top)
        bench.call(Call(CallKind.RUN_FORWARD, index) if is_axis(motor) else start)
    bench.wait(cycles)
    return bench


@pytest.mark.parametrize("stem", KINDS)
def test_a_reset_in_mid_move_leaves_every_wire_at_rest(stem: str) -> None:
    """
    Each wire goes from high impedance to its level at rest, and shows nothing in between.
    """
    random = Random(SEED)  # noqa: S311 - repeatable, not secret
    library = Library.of(stem)

    assert {
        cause: not_at_rest(library, random.randrange(20_000, 400_000), bit)
        for cause, bit in CAUSES.items()
    } == {cause: [] for cause in CAUSES}


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

    assert not_at_rest(Library.of("mega_ramps_z", templates), 50_000, BUTTON)


def not_at_rest(library: Library, cycles: int, cause: int) -> list[str]:
    """
    Reset a chip whose motors have run for *cycles*; return which wires show something else.
    """
    mcu = library.plan.board.mcu
    with moving(library, cycles) as bench:
        machine = bench.machine
        assert isinstance(machine, Machine)
        assert driven(machine, mcu)
        reset_cycle = machine.cycle
        machine.reset(cause)
        if cause == BROWN_OUT:
            noise = Random(SEED).randbytes(mcu.ram_bytes)  # noqa: S311 - repeatable, not secret
            machine.write_ram(mcu.ram_start, noise)
        assert machine.register(_MCUSR) & cause
        assert not driven(machine, mcu)
        assert bench.come_back(_SETUP_CYCLES)
        events = machine.events()
        since = events[events["cycle"] > reset_cycle]
        motors = subjects(library.loaded, library.plan, library.elf)
        return list(restless_wires(motors, since, mcu))


def driven(machine: Machine, mcu: Mcu) -> list[str]:
    """
    Return the ports with a pin that the chip drives or pulls up.
    """
    return [
        port.letter
        for port in mcu.ports
        if machine.register(port.ddr.address) or machine.register(port.port.address)
    ]

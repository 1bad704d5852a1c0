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

from stepgen.devices import PortBit
from stepgen.library.render import template_dir
from stepgen.verify.bench import Bench, Call, CallKind, Loop, is_axis
from stepgen.verify.events import Events, Kind
from stepgen.verify.simavr import Machine
from stepgen.verify.subject import Subject, subjects
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


def levels(library: Library, events: Events, bit: PortBit) -> list[bool | None]:
    """
    Return what *bit* showed since reset, in order: LOW, HIGH, or None where nothing drives it.

    A pull-up drives nothing, but is HIGH where it is not the first thing that happens.
    """
    port = library.plan.board.mcu.port(bit.port)
    held = {port.port.address: 0, port.ddr.address: 0}
    shown: list[bool | None] = [None]
    for event in events[events["kind"] == Kind.PORT]:
        if int(event["source"]) not in held:
            continue
        held[int(event["source"])] = int(event["value"])
        is_output = held[port.ddr.address] >> bit.bit & 1
        level = bool(held[port.port.address] >> bit.bit & 1)
        now = level if is_output or level else None
        if now != shown[-1]:
            shown.append(now)
    return shown


def at_rest(subject: Subject, bit: PortBit) -> list[tuple[bool, ...]]:
    """
    Return which levels *bit* may show after ShieldInit: no current, no pulse on STEP.
    """
    place = subject.drive.wires.index(bit)
    off = subject.drive.coils_off
    if off.care[place]:
        return [(off.driven[place],)]
    if subject.drive.pulse is not None and place == 0:
        return [(False,)]
    return [(False,), (True,)]


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
    events = fresh.events()
    wrong = []
    for subject in subjects(library.loaded, library.plan, library.elf):
        for bit in subject.drive.wires:
            first, *after = levels(library, events, bit)
            if first is not None or tuple(after) not in at_rest(subject, bit):
                wrong.append(f"{subject.name}: {bit.name} shows {first}, {after}")
    fresh.close()
    return wrong

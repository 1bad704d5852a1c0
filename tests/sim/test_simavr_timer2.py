"""
The simulated timer 2 behaves as the datasheet's chapter "8-bit Timer/Counter2" says.
"""

import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from stepgen.verify.conformance.lab import PROGRAMS
from stepgen.verify.events import Kind
from stepgen.verify.simavr import Machine

PROGRAM = PROGRAMS / "timer2.c"
TCCR2B, GTCCR = 0xB1, 0x43  # data addresses, chapter "Register Summary"
CLOCKS = {1: 1, 8: 2, 32: 3, 64: 4, 128: 5, 256: 6, 1024: 7}  # table "Clock Select Bit Description"
PSRSYNC, PSRASY = 1, 2  # "GTCCR - General Timer/Counter Control Register"
COMPA = {"atmega328p": 7, "atmega2560": 13}  # tables of vectors

Start = Callable[..., Machine]


@pytest.fixture
def start(tmp_path: Path) -> Start:
    """
    Return a function that compiles the program with macros and puts it into a machine.
    """

    def run(mcu: str = "atmega328p", **macros: int) -> Machine:
        elf = tmp_path / "timer2.elf"
        defines = [f"-D{name}={value}" for name, value in macros.items()]
        options = [f"-mmcu={mcu}", "-Os", "-Wall", "-Werror", *defines]
        subprocess.run(["avr-gcc", *options, str(PROGRAM), "-o", str(elf)], check=True)
        return Machine(elf, mcu=mcu, f_cpu_hz=16_000_000, watch=(TCCR2B, GTCCR))

    return run


def _cycles(machine: Machine, kind: Kind, source: int) -> list[int]:
    events = machine.events()
    return [
        int(c) for c in events[(events["kind"] == kind) & (events["source"] == source)]["cycle"]
    ]


@pytest.mark.parametrize("mcu", COMPA)
@pytest.mark.parametrize("prescaler", CLOCKS)
@pytest.mark.parametrize(("match", "nops"), [(0, 0), (127, 3), (200, 1001), (255, 64)])
def test_a_match_comes_once_in_256_ticks(
    start: Start, mcu: str, prescaler: int, match: int, nops: int
) -> None:
    """
    The first tick is the next multiple of the prescaler; OCF2A is set where OCR2A is left.
    """
    machine = start(mcu, CLOCK=CLOCKS[prescaler], MATCH=match, NOPS=nops)
    machine.run_until(4 * 256 * prescaler + 20_000)
    clock_on = _cycles(machine, Kind.REGISTER, TCCR2B)[-1]
    matches = _cycles(machine, Kind.RAISE, COMPA[mcu])

    # The counter leaves 0 with the first tick, and MATCH with the tick number MATCH + 1.
    assert matches[0] == (clock_on // prescaler + match + 1) * prescaler
    assert len(matches) > 2
    assert set(np.diff(matches).tolist()) == {256 * prescaler}


@pytest.mark.parametrize(("bit", "restarts"), [(PSRASY, True), (PSRSYNC, False)])
def test_timer_2_has_a_prescaler_of_its_own(start: Start, bit: int, *, restarts: bool) -> None:
    """
    PSRASY restarts it; PSRSYNC, which restarts that of the other timers, leaves it alone.
    """
    machine = start(CLOCK=CLOCKS[1024], MATCH=9, NOPS=7, RESTART=bit)
    machine.run_until(40_000)
    clock_on = _cycles(machine, Kind.REGISTER, TCCR2B)[-1]
    restart = _cycles(machine, Kind.REGISTER, GTCCR)[-1]
    ticks_before = restart // 1024 - clock_on // 1024

    expected = restart + (10 - ticks_before) * 1024 if restarts else (clock_on // 1024 + 10) * 1024
    assert _cycles(machine, Kind.RAISE, COMPA["atmega328p"])[0] == expected

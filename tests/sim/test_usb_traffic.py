"""
A Leonardo beside a computer that opens its port: the figures of USB hold in a run.
"""

import re
from pathlib import Path

import numpy as np
import pytest

from stepgen import api
from stepgen.devices import CORE, UNBOUND
from stepgen.plan.warnings import plan_warnings
from stepgen.verify.compilers import Compiler, find_compilers
from stepgen.verify.events import Kind
from stepgen.verify.simavr import Machine
from tests.sim.example_builds import build_example

SPEC = Path(__file__).parents[2] / "specs" / "leonardo_motor_shield.yaml"
F_CPU_HZ = 16_000_000
FRAME_CYCLES = F_CPU_HZ // 1000
OPEN_MS = 50  # by then the port is open
EACH_COMPILER = pytest.mark.parametrize(
    "compiler", find_compilers(), ids=lambda compiler: compiler.name
)
# A sketch that fills each packet to the last byte, as fast as the computer takes them.
TALKS = (
    ("void setup", "static uint8_t text[64];\n\nvoid setup"),
    ("void loop() {}", "void loop() { Serial.write(text, sizeof text); }"),
)
AFTER_OPENING = (("  motorShieldInit();", "  while (!Serial) {}\n  motorShieldInit();"),)


def running(
    compiler: Compiler, rate_sps: int, ms: int, *edits: tuple[str, str], fine: bool = False
) -> Machine:
    """
    Return the board whose motor runs at *rate_sps*, *ms* after a computer has begun to open it.
    """
    rate = ("motorTimerCalcPerSecond(200)", f"F_CPU / {rate_sps}")
    elf = build_example(SPEC, "Smallest", compiler, (rate, *TALKS, *edits))
    machine = Machine(elf, mcu="atmega32u4", f_cpu_hz=F_CPU_HZ)
    machine.fine = fine
    machine.send_usb(b"")
    machine.run_until(ms * FRAME_CYCLES)
    return machine


def safe_rate(cause: str) -> int:
    """
    Return the rate in steps/s that is called safe beside what nothing bounds.
    """
    (text,) = (one for one in map(str, plan_warnings(api.plan(SPEC))) if f"bounds {cause}," in one)
    match = re.search(r"up to (\d+) steps/s are safe", text)
    assert match
    return int(match[1])


def vector(name: str) -> int:
    """
    Return the number of an interrupt.
    """
    return api.plan(SPEC).board.mcu.vector(name).number


@EACH_COMPILER
def test_each_interrupt_of_usb_takes_what_is_stated(compiler: Compiler) -> None:
    """
    While the port is opened and while packets go out, each frame has one interrupt and no more.
    """
    machine = running(compiler, 200, 150)
    events = machine.events()
    exits = events[events["kind"] == Kind.ISR_EXIT]
    taken = exits["cycle"] - exits["since"]
    frames = taken[exits["source"] == vector("USB_GEN_vect")]
    requests = taken[exits["source"] == vector("USB_COM_vect")]
    entered = events[events["kind"] == Kind.ISR_ENTER]
    begun = entered[entered["source"] == vector("USB_GEN_vect")]["since"]

    assert len(frames) > 140
    assert frames.max() <= CORE["USB"].cycles
    assert np.diff(begun[1:]).min() >= CORE["USB"].spacing_us * F_CPU_HZ // 1_000_000
    assert len(requests) == 7  # who is there, twice; address, configuration twice, coding, DTR
    stated = UNBOUND["USB"]
    most = stated.microseconds * F_CPU_HZ // 1_000_000 + stated.cycles
    assert FRAME_CYCLES < requests.max() <= most  # it does wait for the computer


@EACH_COMPILER
def test_interrupts_are_off_as_long_as_stated_while_a_packet_is_filled(compiler: Compiler) -> None:
    """
    The longest stretch of USB_Send() is that of a whole packet, and no longer than stated.
    """
    machine = running(compiler, 200, OPEN_MS + 20, fine=True)
    events = machine.events()
    rows = events[np.isin(events["kind"], (Kind.MASKED, Kind.UNMASKED))]
    off = rows["kind"] == Kind.MASKED
    stretches = np.diff(rows["cycle"])[off[:-1] & ~off[1:]]

    assert UNBOUND["Serial"].cycles / 1.17 < stretches.max() <= UNBOUND["Serial"].cycles


@EACH_COMPILER
@pytest.mark.parametrize(("cause", "edits"), [("USB", ()), ("Serial", AFTER_OPENING)])
def test_no_step_is_lost_at_the_rate_that_is_called_safe(
    cause: str, edits: tuple[tuple[str, str], ...], compiler: Compiler
) -> None:
    """
    Beside USB while a program opens the port, and beside Serial while it is open.
    """
    rate_sps = safe_rate(cause)
    machine = running(compiler, rate_sps, OPEN_MS + 200, *edits)
    events = machine.events()
    step = vector(api.plan(SPEC).motors[0].timing.vector)
    raised = events[(events["kind"] == Kind.RAISE) & (events["source"] == step)]
    made = events[(events["kind"] == Kind.ISR_ENTER) & (events["source"] == step)]

    assert bytes(events[events["kind"] == Kind.UART]["value"].astype("u1"))[:64] == bytes(64)
    assert len(raised) > 0.18 * rate_sps
    assert not raised["value"].any()
    assert len(raised) - len(made) in {0, 1}


@EACH_COMPILER
def test_steps_are_lost_where_it_was_said_to_be_unsafe(compiler: Compiler) -> None:
    """
    Opening the port beside a motor at the rate that is safe only with the port open.
    """
    machine = running(compiler, safe_rate("Serial"), OPEN_MS)
    events = machine.events()
    step = vector(api.plan(SPEC).motors[0].timing.vector)

    assert events[(events["kind"] == Kind.RAISE) & (events["source"] == step)]["value"].any()

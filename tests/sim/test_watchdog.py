"""
The watchdog: a sketch that hangs is reset in time, one that feeds it never.

The period of 250 ms is that of 32768 ticks of the oscillator, 128 kHz (ATmega328P datasheet, table
"Watchdog Timer Prescale Select"): 4 096 000 cycles of 16 MHz.
"""

import re
from pathlib import Path
from random import Random

import pytest

from stepgen import api
from stepgen.spec import load_spec
from stepgen.spec.watchdog import WATCHDOG_MS
from stepgen.verify.compilers import default_compiler
from stepgen.verify.events import Kind
from stepgen.verify.firmware import build_firmware
from stepgen.verify.resets import restless_wires
from stepgen.verify.simavr import Machine
from stepgen.verify.subject import subjects
from stepgen.verify.watchdog_run import OSCILLATOR_TICKS
from tests.sim.conftest import SPECS, MachineWith

STEM = "uno_watchdog"
PERIOD_CYCLES = 4_096_000
SECOND_CYCLES = 16_000_000
WDTCSR, WDE = 0x60, 0x08
BROWN_OUT = 0x04  # the bit BORF of MCUSR
FED, BACK = 0x21, 0x22  # marks of the sketches below

HEADER = """
#include <Winch.h>
#include <avr/interrupt.h>
#include <avr/io.h>
#include <Arduino.h>
"""
# Turns for ever; after 0.1 s of it the sketch feeds the watchdog once more and hangs.
HANGS = (
    HEADER
    + """
volatile uint8_t never;
ISR(TIMER0_COMPA_vect) {
  for (;;) {}
}
void setup() {
  EEDR = 0x22;
  delay(100);  // longer than the 15 ms that the watchdog has after its reset
  drumShieldInit();
  EEDR = motorWatchdogFired();
  if (motorWatchdogFired()) return;
  motorWatchdogStart();
  drumSetSpeed(MOTOR_CTRL_DRV_EN, motorTimerCalcPerSecond(1000));
}
void loop() {
  if (motorWatchdogFired()) return;
  motorWatchdogFeed();
  if (millis() < 200) return;
  motorWatchdogFeed();
  EEDR = 0x21;
  %s
}
"""
)
WAYS_TO_HANG = {
    "a loop without end": "for (;;) {}",
    "interrupts off for good": "cli(); for (;;) {}",
    "in an interrupt": "TIMSK0 |= _BV(OCIE0A); for (;;) {}",
    "what never comes": "while (!never) {}",
    "a wait that is too long": "delay(300);",
}
# What boot loaders do before the program begins.
CLEARS_MCUSR = """
extern "C" void clearCauses() __attribute__((naked, used, section(".init0")));
void clearCauses() { asm volatile("ldi r24, 0 $ out %0, r24" ::"I"(_SFR_IO_ADDR(MCUSR))); }
"""
FEEDS = (
    HEADER
    + """
void setup() {
  drumShieldInit();
  motorWatchdogStart();
  drumSetSpeed(MOTOR_CTRL_DRV_EN, motorTimerCalcPerSecond(1000));
}
void loop() {
  motorWatchdogFeed();
  drumKeepAlive();
  delay(200);
}
"""
)


def cycles_of(machine: Machine, kind: Kind, value: int | None = None) -> list[int]:
    """
    Return when events of *kind*, and of one value if given, came.
    """
    rows = machine.events()[machine.events()["kind"] == kind]
    return [int(row["cycle"]) for row in rows if value is None or int(row["value"]) == value]


@pytest.mark.parametrize("way", WAYS_TO_HANG, ids=str)
def test_a_sketch_that_hangs_is_reset_in_time(machine_with: MachineWith, way: str) -> None:
    """
    One period after it was fed last, to the instruction; then every wire is at rest, for good.
    """
    machine = machine_with(STEM, HANGS % WAYS_TO_HANG[way])
    machine.run_until(SECOND_CYCLES)
    (fed,) = cycles_of(machine, Kind.MARK, FED)
    (reset,) = cycles_of(machine, Kind.RESET)

    assert abs(reset - fed - PERIOD_CYCLES) < 20
    path = SPECS / f"{STEM}.yaml"
    plan = api.plan(path)
    events = machine.events()
    steps = events[events["kind"] == Kind.ISR_ENTER]
    assert (steps["cycle"] < reset).sum() > 50
    bench = build_firmware(plan, "", default_compiler()).bench
    motors = subjects(load_spec(path), plan, bench)
    assert list(restless_wires(motors, events[events["cycle"] > reset], plan.board.mcu)) == []
    machine.close()


def test_after_the_reset_the_sketch_begins_anew(machine_with: MachineWith) -> None:
    """
    Though setup() takes longer than the 16 ms that are left of the watchdog, and knows the reason.
    """
    machine = machine_with(STEM, HANGS % WAYS_TO_HANG["a loop without end"])
    machine.run_until(2 * SECOND_CYCLES)

    assert len(cycles_of(machine, Kind.MARK, BACK)) == 2
    assert len(cycles_of(machine, Kind.MARK, 0)) == 1
    assert len(cycles_of(machine, Kind.MARK, 1)) == 1
    assert len(cycles_of(machine, Kind.RESET)) == 1
    assert not machine.register(WDTCSR) & WDE


def test_a_sketch_that_feeds_it_is_never_reset(machine_with: MachineWith) -> None:
    """
    Four fifths of the period between two feeds, for three seconds; the motor goes on.
    """
    machine = machine_with(STEM, FEEDS)
    machine.run_until(3 * SECOND_CYCLES)

    assert cycles_of(machine, Kind.RESET) == []
    assert machine.register(WDTCSR) & WDE
    ports = cycles_of(machine, Kind.PORT)
    assert len([cycle for cycle in ports if cycle > 2 * SECOND_CYCLES]) >= 1000


@pytest.mark.parametrize(("boot_loader", "fired"), [("", 0), (CLEARS_MCUSR, -1)])
def test_what_a_boot_loader_has_cleared_nobody_knows(
    machine_with: MachineWith, boot_loader: str, fired: int
) -> None:
    """
    MCUSR is never 0 after a reset, here at power-on: where the program finds that, it is -1.
    """
    sketch = HEADER + boot_loader + "void setup() { EEDR = motorWatchdogFired(); } void loop() {}"
    machine = machine_with(STEM, sketch)
    machine.run_until(SECOND_CYCLES // 10)

    assert len(cycles_of(machine, Kind.MARK, fired & 0xFF)) == 1


def test_a_brown_out_is_not_taken_for_the_watchdog(machine_with: MachineWith) -> None:
    """
    The watchdog is on as the supply breaks down: it is off afterwards, and has not fired.
    """
    sketch = (
        "void setup() { EEDR = 0x40 | motorWatchdogFired(); motorWatchdogStart(); } void loop() {}"
    )
    machine = machine_with(STEM, HEADER + sketch)
    machine.run_until(PERIOD_CYCLES // 2)
    assert machine.register(WDTCSR) & WDE

    machine.reset(BROWN_OUT)
    machine.write_ram(0x100, Random(1).randbytes(2048))  # noqa: S311 - repeatable, not secret
    assert not machine.register(WDTCSR) & WDE
    machine.run_until(PERIOD_CYCLES)

    assert len(cycles_of(machine, Kind.MARK, 0x40)) == 2
    assert len(cycles_of(machine, Kind.RESET)) == 1


@pytest.mark.parametrize("period_ms", WATCHDOG_MS)
def test_each_period_is_the_one_of_the_datasheet(
    machine_with: MachineWith, tmp_path: Path, period_ms: int
) -> None:
    """
    The prescaler bits stand for 2048 ticks, and each next period for twice as many.
    """
    spec = tmp_path / "spec.yaml"
    text = (SPECS / f"{STEM}.yaml").read_text(encoding="utf-8")
    spec.write_text(text.replace("watchdog_ms: 250", f"watchdog_ms: {period_ms}"), "utf-8")
    sketch = HEADER + "void setup() { motorWatchdogStart(); EEDR = 0x22; } void loop() {}"
    machine = machine_with(spec, sketch)
    assert machine.run_until_mark(BACK, limit_cycles=SECOND_CYCLES)
    control = machine.register(WDTCSR)
    select = (control & 0x20) >> 2 | control & 7

    assert control & ~0x27 == WDE
    assert 2048 << select == OSCILLATOR_TICKS[period_ms]
    assert abs((2048 << select) / 128 - period_ms) < 0.07 * period_ms


@pytest.mark.parametrize("spec", sorted(SPECS.glob("*.yaml")), ids=lambda path: path.stem)
def test_a_library_without_the_field_has_no_watchdog(spec: Path) -> None:
    """
    Not a word of it in the library, whose sketches have the chip's to themselves.
    """
    words = re.compile("watchdog|wdt|MCUSR|init3", re.IGNORECASE)
    named = {path for path, text in api.render(spec).items() if words.search(text)}

    assert (named == set()) == (api.plan(spec).watchdog_ms is None)

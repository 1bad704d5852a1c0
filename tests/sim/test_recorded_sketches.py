"""
The sketches of the recorded runs, whole: they print through Serial, as on the hardware.

Source: system 1, chapters 9 and 10.
"""

import re
from collections.abc import Callable, Iterator
from itertools import pairwise
from pathlib import Path
from statistics import mean

import pytest

from stepgen import api
from stepgen.library.render import render_library
from stepgen.verify.events import Kind
from stepgen.verify.simavr import Machine

SPECS = Path(__file__).parents[2] / "specs"
F_CPU_HZ = 16_000_000
MachineWith = Callable[[str, str], Machine]
LABELS = (
    "motor_ctrl_irq",
    "motor_timer_top32virt_irq",
    "motor_timer_modify_irq",
    "motor_step_count_limit_irq",
    "motor_time_irq",
    "motor_stat_irq",
    "motor_update_time_irq",
    "motor_millis_endtime_irq",
    "motor_modCounts_irq",
    "motor_pattern_irq",
)
CASE_1 = """
#include <Arduino.h>
#include <DebugMotor.h>
void setup() {
  Serial.begin(115200);
  motorShieldInit();
  motorSetSpeed(MOTOR_CTRL_SPEED_VARIABLE | MOTOR_CTRL_IRQ_TIMING | MOTOR_CTRL_VARIABLE_PWR |
                    MOTOR_CTRL_SLOWER | MOTOR_CTRL_DRV_EN,
                15000UL, 8900UL, 64UL, 1000, 19);
  debugDump();
}
void loop() {
  static uint32_t last = millis() - 950;
  static bool stopped = false;
  if (millis() - last < 1000 || stopped) return;
  last += 1000;
  if (motorReadStatus() & MOTOR_STAT_REACHED) {
    motorSetSpeed();
    stopped = true;
  }
  debugDump();
}
"""
CASE_3 = """
#include <Arduino.h>
#include <VariableSpeed.h>
void reached() { Serial.println(F("reached")); }
void setup() {
  Serial.begin(115200);
  motorShieldInit();
  motorCallBackPositionReached(reached);
  motorSetSpeed(MOTOR_CTRL_SPEED_VARIABLE | MOTOR_CTRL_VARIABLE_PWR | MOTOR_CTRL_FASTER |
                    MOTOR_CTRL_DRV_EN,
                4800000UL, 10000UL, 2385000UL, 1000, 11);
}
void loop() {
  static uint32_t counter = 0, second = 0, check = 0;
  const uint32_t now = millis();
  ++counter;
  if (now - check >= 50) {
    check += 50;
    motorTimerUpdateCheck();
  }
  if (now - second >= 1000) {
    second += 1000;
    Serial.println(counter);
    counter = 0;
  }
}
"""
# Case 1 as it was printed, once a second: TOP, modification, steps left, updates left, pattern 0-3.
RECORDED = (
    (15000, 64, 8844, 19),
    (15064, 128, 7656, 18),
    (15192, 256, 6594, 17),
    (15448, 512, 5543, 16),
    (15960, 1024, 4512, 15),
    (16984, 2048, 3519, 14),
    (19032, 4096, 2593, 13),
    (23128, 8192, 1777, 12),
    (31320, 16384, 1116, 11),
    (47704, 32768, 634, 10),
    (80472, 65536, 326, 9),
    (146008, 131072, 143, 8),
    (277080, 262144, 42, 7),
)


def printed(machine: Machine, seconds: float) -> str:
    """
    Return what the sketch in *machine* prints in so many seconds.
    """
    with machine:
        machine.run_until(round(seconds * F_CPU_HZ))
        events = machine.events()
        sent = events[events["kind"] == Kind.UART]
        return bytes(sent["value"].astype("u1")).decode("ascii")


def dumps(text: str) -> Iterator[dict[str, int]]:
    """
    Yield what each dump says, by its labels, which must come in the recorded order.
    """
    lines = [re.fullmatch(r"(\w+): (\w+)", line) for line in text.split("\r\n")[:-1]]
    for first in range(0, len(lines) - len(LABELS) + 1, len(LABELS)):
        group = lines[first : first + len(LABELS)]
        assert tuple(line[1] for line in group if line) == LABELS
        yield {line[1]: int(line[2], 0) for line in group if line}


@pytest.fixture(scope="module")
def case_1(machine_with: MachineWith) -> list[dict[str, int]]:
    """
    Return what the sketch of case 1 prints, dump by dump.
    """
    return list(dumps(printed(machine_with("uno_debug", CASE_1), seconds=14.5)))


def test_the_dump_shows_the_recorded_state(case_1: list[dict[str, int]]) -> None:
    """
    Once a second ten lines: bits, TOP, modification and updates left as recorded.

    The steps left are those of the print's moment: 50 ms after the event here, 50 to 230 ms in
    the recording, whose stamps say when the line had arrived.
    """
    running = case_1[1:14]

    assert len(running) == len(RECORDED)
    for dump, (top, modification, left, updates) in zip(running, RECORDED, strict=True):
        assert dump["motor_ctrl_irq"] == 0xF0
        assert dump["motor_timer_top32virt_irq"] == top
        assert dump["motor_timer_modify_irq"] == modification
        assert dump["motor_modCounts_irq"] == updates
        assert dump["motor_update_time_irq"] == 1000
        assert dump["motor_millis_endtime_irq"] == 0
        assert dump["motor_pattern_irq"] == (8900 - dump["motor_step_count_limit_irq"]) % 4
        assert abs(dump["motor_step_count_limit_irq"] - left) <= 0.23 * F_CPU_HZ / top + 1
    times = [dump["motor_time_irq"] for dump in running]
    assert {later - earlier for earlier, later in pairwise(times)} == {1000}


def test_after_a_stop_the_dump_is_empty(case_1: list[dict[str, int]]) -> None:
    """
    Halted and stopped, the last dump shows no motion any more, as recorded.
    """
    last = case_1[-1]
    emptied = set(LABELS) - {"motor_time_irq", "motor_stat_irq", "motor_pattern_irq"}

    assert {last[label] for label in emptied} == {0}
    assert last["motor_time_irq"] == case_1[13]["motor_time_irq"]


def test_without_the_option_there_is_nothing_of_it() -> None:
    """
    A library without `debug` has no byte of the dump: no function, no text, no include.
    """
    files = render_library(api.plan(SPECS / "uno_variable_speed.yaml"), "")

    for word in ("Dump", "_irq", "Print", "Arduino.h"):
        assert word not in files["src/VariableSpeed.h"] + files["src/VariableSpeed.cpp"]


def test_a_free_running_counter_shows_what_a_step_takes(machine_with: MachineWith) -> None:
    """
    Case 3: the counter of loop() says that a step takes at most 75 cycles; the source took 220.
    """
    stays_slow = CASE_3.replace("2385000UL, 1000, 11", "1UL, 1000, 60000")

    def counts_a_second(sketch: str) -> float:
        text = printed(machine_with("uno_variable_speed", sketch), seconds=27.5)
        return mean(int(line) for line in text.split()[12:26])

    slow, fast = counts_a_second(stays_slow), counts_a_second(CASE_3)  # 3.3 and 494.9 steps/s
    cycles = (slow - fast) / slow * F_CPU_HZ / (494.9 - 3.3)

    assert stays_slow != CASE_3
    assert 25 < cycles <= 75

"""
Millisecond limits that are too long to be waited for: the sketch moves the clock on by hand.
"""

from collections.abc import Callable

import pytest

from stepgen.verify.events import Kind
from stepgen.verify.simavr import Machine

MachineWith = Callable[[str, str], Machine]
PORTB = 0x25
CLOCKS_PER_MS = 16_000
LEFT_MS = 100
# millis() goes on in leaps of 8 s, with a step or two between them, and then to LEFT_MS before the
# end. A leap is shorter than a lap of 16 384 ms, as the time between two steps always is.
LEAPS = """
#include <Arduino.h>
#include <{library}.h>
extern volatile unsigned long timer0_millis;
void leap(unsigned long ms) {{
  cli();
  timer0_millis += ms;
  sei();
}}
void setup() {{
  motorShieldInit();
  const unsigned long start = millis();
  motorSetSpeed(MOTOR_CTRL_DRV_EN | MOTOR_CTRL_ENDPOINT_MILLIS, 16000UL, {limit}UL);
  while (millis() - start < {limit}UL - 8000 - {left}) {{
    leap(8000);
    delay(2);
  }}
  leap({limit}UL - {left} - (millis() - start));
  EEDR = 1;
}}
void loop() {{}}
"""
MANY_STEPS = """
#include <Arduino.h>
#include <{library}.h>
int32_t position __attribute__((used, externally_visible));
void setup() {{
  motorShieldInit();
  motorSetSpeed(MOTOR_CTRL_DRV_EN | MOTOR_CTRL_ENDPOINT_MILLIS, {top}UL, {limit}UL);
  while (!(motorReadStatus() & MOTOR_STAT_REACHED)) {{}}
  delay(2);
  position = motorReadPosition();
  EEDR = 1;
}}
void loop() {{}}
"""
BY_EACH_TIMING = pytest.mark.parametrize(
    ("stem", "library"), [("uno_motor_shield", "ShieldMotor"), ("uno_servo_beside", "ServoBeside")]
)


def step_cycles(machine: Machine) -> list[int]:
    """
    Return when port B changed by a step; at rest nothing but the enables changes.
    """
    events = machine.events()
    moved = events[(events["kind"] == Kind.PORT) & (events["source"] == PORTB)]
    pairs = zip(moved["value"][:-1], moved["value"][1:], moved["cycle"][1:], strict=True)
    return [int(cycle) for before, after, cycle in pairs if (before ^ after) & 0x30]


# 16 384 ms are a lap. The last lap and what is left of one are not counted; of those before them
# one byte counts 256, so 258 laps are the first that need the next byte.
@BY_EACH_TIMING
@pytest.mark.parametrize("laps", [1, 2, 3, 257, 258, 514])
def test_a_limit_of_many_laps_ends_on_time(
    stem: str, library: str, laps: int, machine_with: MachineWith
) -> None:
    """
    The motor steps until the limit, however often the count of milliseconds has gone round.
    """
    sketch = LEAPS.format(library=library, limit=laps * 16_384 + 5_000, left=LEFT_MS)
    with machine_with(stem, sketch) as machine:
        assert machine.run_until_mark(1, limit_cycles=100_000_000)
        mark = machine.cycle
        machine.run_until(mark + 3 * LEFT_MS * CLOCKS_PER_MS)
        last = step_cycles(machine)[-1]

    # README, "Limits": up to 2 ms early or 1 ms late; and the last step came up to 1 ms before it.
    assert LEFT_MS - 3 <= (last - mark) / CLOCKS_PER_MS <= LEFT_MS + 1


@BY_EACH_TIMING
def test_a_position_counts_more_than_65_536_steps_of_a_millisecond_limit(
    stem: str, library: str, machine_with: MachineWith
) -> None:
    """
    The position is the number of steps that the wires made, and is more than two bytes hold.
    """
    top, limit = 2_048, 9_000
    with machine_with(stem, MANY_STEPS.format(library=library, top=top, limit=limit)) as machine:
        assert machine.run_until_mark(1, limit_cycles=200_000_000)
        position = int.from_bytes(machine.read_ram(machine.symbol("position"), 4), "little")
        steps = len(step_cycles(machine))

    assert steps == position
    assert 65_536 < steps <= (limit + 1) * CLOCKS_PER_MS // top + 1

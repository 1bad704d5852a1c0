"""
Sketches that hold interrupts up, or change their callbacks from within one.
"""

from collections.abc import Callable
from itertools import pairwise

import pytest

from stepgen.verify.events import Kind
from stepgen.verify.simavr import Machine

MachineWith = Callable[[str, str], Machine]
PORTB = 0x25
# A change of prescaler is waiting for the step at the end of the interval; then interrupts are off
# from before that step until shortly before the old setting would end a second interval.
HELD_UP = """
#include <Arduino.h>
#include <{library}.h>
void setup() {{
  motorShieldInit();
  motorSetSpeed(MOTOR_CTRL_DRV_EN, 20000UL);
  delay(20);
  while (TCNT1 > 1000) {{}}
  motorSetSpeed(MOTOR_CTRL_DRV_EN, 200000UL, 5);
  while (TCNT1 < 19000) {{}}
  cli();
  while (TCNT1 >= 19000) {{}}
  while (TCNT1 < {until}) {{}}
  sei();
}}
void loop() {{}}
"""
CALLBACKS = """
#include <Arduino.h>
#include <VariableSpeed.h>
void fault() {}
void reached() { motorCallBackFault(nullptr); }
void setup() {
  motorShieldInit();
  motorCallBackPositionReached(reached);
  motorCallBackFault(fault);
  motorSetSpeed(MOTOR_CTRL_DRV_EN, 20000UL, 5);
  motorHold();  // refused, so a fault is to be told as well
  delay(20);
  motorTimerUpdateCheck();
  EEDR = 1;
}
void loop() {}
"""


@pytest.mark.parametrize(
    ("stem", "library"),
    [("uno_motor_shield", "ShieldMotor"), ("uno_variable_speed", "VariableSpeed")],
)
@pytest.mark.parametrize("until", [19_700, 19_850, 19_900, 19_930, 19_980])
def test_a_change_that_is_held_up_makes_no_early_step(
    stem: str, library: str, until: int, machine_with: MachineWith
) -> None:
    """
    The setting that is replaced ends no interval any more: the next step is 200 000 clocks later.
    """
    sketch = HELD_UP.format(library=library, until=until)
    with machine_with(stem, sketch) as machine:
        machine.run_until(2_000_000)
        events = machine.events()
        moved = events[(events["kind"] == Kind.PORT) & (events["source"] == PORTB)]
        gaps = [int(after - before) for before, after in pairwise(moved["cycle"])]

    # Held up for nearly 20 000, then four intervals of the new speed; a tick is 64 clocks there.
    assert [round(gap, -3) for gap in gaps[-4:]] == [200_000] * 4
    assert 38_000 < gaps[-5] < 41_000


def test_a_callback_may_take_the_other_one_away(machine_with: MachineWith) -> None:
    """
    A callback that is to be made is made, though the one before it set it to null.
    """
    with machine_with("uno_variable_speed", CALLBACKS) as machine:
        assert machine.run_until_mark(1, limit_cycles=1_000_000)

"""
Sketches that hold interrupts up, or change their callbacks from within one.
"""

import shutil
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import pytest

from stepgen.library.render import template_dir
from stepgen.verify.events import Kind
from stepgen.verify.simavr import Machine

MachineWith = Callable[..., Machine]
PORTB, PORTL = 0x25, 0x10B
STEP_OF_RAMPS_Z = 0x08  # PL3
# A change of prescaler is waiting for the step at the end of the interval; then interrupts are off
# from before that step until shortly before the old setting would end a second interval.
HELD_UP = """
#include <Arduino.h>
#include <{library}.h>
void setup() {{
  {motor}ShieldInit();
  {motor}SetSpeed(MOTOR_CTRL_DRV_EN, 20000UL);
  delay(20);
  while (TCNT{timer} > 1000) {{}}
  {motor}SetSpeed(MOTOR_CTRL_DRV_EN, 200000UL, 5);
  while (TCNT{timer} < 19000) {{}}
  cli();
  while (TCNT{timer} >= 19000) {{}}
  while (TCNT{timer} < {until}) {{}}
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


@dataclass(frozen=True)
class HeldUp:
    """
    A spec whose library is held up: its names, its timer, and where a step shows.

    *rising* are the bits of the port that rise with a step; 0 where any change is one.
    """

    stem: str
    library: str
    motor: str = "motor"
    timer: int = 1
    port: int = PORTB
    rising: int = 0

    def sketch(self, until: int) -> str:
        """
        Return the sketch that is held up until the counter shows *until*.
        """
        names = {"library": self.library, "motor": self.motor, "timer": self.timer}
        return HELD_UP.format(until=until, **names)

    def last_gaps(self, machine: Machine) -> list[int]:
        """
        Return the cycles between the last six steps of *machine*.
        """
        machine.run_until(2_000_000)
        events = machine.events()
        moved = events[(events["kind"] == Kind.PORT) & (events["source"] == self.port)]
        if self.rising:
            moved = moved[moved["value"] & self.rising != 0]
        return [int(after - before) for before, after in pairwise(moved["cycle"])][-5:]


CTC = HeldUp("mega_ramps_z", "RampsZ", "z", 5, PORTL, STEP_OF_RAMPS_Z)
TIMINGS = (
    HeldUp("uno_motor_shield", "ShieldMotor"),
    HeldUp("uno_variable_speed", "VariableSpeed"),
    CTC,
)


@pytest.mark.parametrize("held_up", TIMINGS, ids=lambda one: one.stem)
@pytest.mark.parametrize("until", [19_700, 19_850, 19_900, 19_930, 19_980])
def test_a_change_that_is_held_up_makes_no_early_step(
    held_up: HeldUp, until: int, machine_with: MachineWith
) -> None:
    """
    The setting that is replaced ends no interval any more: the next step is 200 000 clocks later.
    """
    with machine_with(held_up.stem, held_up.sketch(until)) as machine:
        first, *others = held_up.last_gaps(machine)

    # Held up for nearly 20 000, then four intervals of the new speed; a tick is 64 clocks there.
    assert [round(gap, -3) for gap in others] == [200_000] * 4
    assert 38_000 < first < 41_000


def test_a_match_that_is_not_dropped_makes_an_early_step(
    tmp_path: Path, machine_with: MachineWith
) -> None:
    """
    The test above can fail: with the line planted out, the old setting of CTC makes a step more.
    """
    templates = tmp_path / "templates"
    shutil.copytree(template_dir(), templates)
    file = templates / "timings" / "ctc.j2"
    text = file.read_text(encoding="utf-8")
    dropped = "  {{ wide.clear(timer) }}  // the old setting makes no step any more\n"
    assert text.count(dropped) == 1
    file.write_text(text.replace(dropped, ""), encoding="utf-8")

    gaps = []
    for until in (19_850, 19_900, 19_930, 19_980):
        with machine_with(CTC.stem, CTC.sketch(until), templates) as machine:
            gaps.append(CTC.last_gaps(machine)[1:])

    assert any(min(four) < 150_000 for four in gaps)


def test_a_callback_may_take_the_other_one_away(machine_with: MachineWith) -> None:
    """
    A callback that is to be made is made, though the one before it set it to null.
    """
    with machine_with("uno_variable_speed", CALLBACKS) as machine:
        assert machine.run_until_mark(1, limit_cycles=1_000_000)

"""
Sketches that do nothing but ask again: the compiler must not keep the first answer.
"""

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from stepgen.library.render import template_dir
from stepgen.verify.simavr import Machine

MachineWith = Callable[..., Machine]
WAITING = """
#include <Arduino.h>
#include <Conveyor.h>
void setup() {{
  beltShieldInit();
  beltSetSpeed(MOTOR_CTRL_DRV_EN, 20000UL, {limit});
  while ({waits}) {{}}
  EEDR = 1;
}}
void loop() {{}}
"""
TIMED_OUT = WAITING.format(limit=0, waits="!beltTimedOut()")
A_SECOND = 16_000_000


@pytest.mark.parametrize(
    "sketch",
    [
        TIMED_OUT,
        WAITING.format(limit=4, waits="!(beltReadStatus() & MOTOR_STAT_REACHED)"),
        WAITING.format(limit=4, waits="beltReadPosition() != 4"),
    ],
    ids=["timed out", "status", "position"],
)
def test_a_loop_that_waits_for_an_answer_ends(machine_with: MachineWith, sketch: str) -> None:
    """
    What an interrupt changes is read anew each time.
    """
    with machine_with("uno_command_timeout", sketch) as machine:
        assert machine.run_until_mark(1, limit_cycles=A_SECOND)


def test_without_cli_it_would_not(tmp_path: Path, machine_with: MachineWith) -> None:
    """
    That test can fail: the functions become part of the sketch's loop, and what is read is kept.
    """
    templates = tmp_path / "templates"
    shutil.copytree(template_dir(), templates)
    file = templates / "timeouts" / "command.j2"
    text = file.read_text(encoding="utf-8")
    masked = "  const Masked masked;  // or a loop that waits for it would look only once\n"
    assert masked in text
    file.write_text(text.replace(masked, ""), encoding="utf-8")

    with machine_with("uno_command_timeout", TIMED_OUT, templates) as machine:
        assert not machine.run_until_mark(1, limit_cycles=A_SECOND)

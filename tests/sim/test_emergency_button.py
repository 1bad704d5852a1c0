"""
The sketch of docs/spec/limits.md with a button for emergencies, and somebody who hits it.
"""

from pathlib import Path

import pytest

from stepgen import api
from stepgen.plan.model import Plan
from stepgen.verify.compilers import default_compiler
from stepgen.verify.toolchain import Target, build
from tests.docs.pages import DOCS, Page
from tests.sim.carriage import Carriage
from tests.sim.terminal import Terminal

PAGE = Page(DOCS / "spec" / "limits.md")
BUTTON = "D3"
STEPS = 8000  # what the sketch moves; at 8000 steps/s after a ramp of 0.2 s


@pytest.fixture
def plan(tmp_path: Path) -> Plan:
    """
    Return the plan of the spec of the page.
    """
    path = tmp_path / "slide.yaml"
    path.write_text(PAGE.files["slide.yaml"], encoding="utf-8")
    return api.plan(path)


@pytest.fixture
def there(tmp_path: Path, plan: Plan) -> Carriage:
    """
    Return the carriage of a board that runs the sketch, with its button out.
    """
    (sketch,) = (text for text in PAGE.blocks("cpp") if "kButton" in text)
    api.generate(tmp_path / "slide.yaml", tmp_path)
    source = tmp_path / "Slide" / "src"
    (tmp_path / "button.ino").write_text(sketch, encoding="utf-8")
    elf = build(
        [tmp_path / "button.ino", source / "Slide.cpp"],
        [source],
        Target.from_fqbn(plan.board.fqbn),
        default_compiler(),
        tmp_path / "out",
    ).elf
    board = Terminal(elf, plan)
    hit(board, plan, is_hit=False)
    return Carriage(board, plan)


def hit(board: Terminal, plan: Plan, *, is_hit: bool) -> None:
    """
    Hit the button, which opens, or pull it out.
    """
    pin = plan.board.find_pin(BUTTON)
    assert pin
    register = plan.board.mcu.port(pin.bit.port).pin
    board.machine.drive_pin(register.address, pin.bit.bit, high=is_hit)


def test_the_button_stops_the_motor_in_mid_move(there: Carriage, plan: Plan) -> None:
    """
    Not one step follows, and ENABLE goes off.
    """
    board = there.board
    there.wait(0.5)
    moving = there.place
    assert 0 < moving < STEPS
    hit(board, plan, is_hit=True)
    there.wait(0.001)
    stopped = there.place
    there.wait(0.2)

    assert there.place == stopped
    assert stopped - moving <= 1  # the step that was under way
    enable = plan.board.mcu.port("B")
    assert board.machine.register(enable.port.address) & 1  # D8, active LOW


def test_a_button_that_was_hit_before_lets_nothing_move(there: Carriage, plan: Plan) -> None:
    """
    The interrupt sees only the moment of the hit, so the sketch looks at the start, too.
    """
    hit(there.board, plan, is_hit=True)
    there.wait(0.5)

    assert there.place == 0

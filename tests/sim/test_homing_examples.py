"""
The examples of a motor that homes, with a carriage that presses its switches.
"""

from pathlib import Path

import pytest

from stepgen import api
from stepgen.verify.compilers import default_compiler
from tests.sim.carriage import Carriage
from tests.sim.example_builds import build_example
from tests.sim.terminal import Terminal

SPEC = Path(__file__).parents[2] / "specs" / "uno_homing.yaml"
# What the spec says, at 80 steps in a millimetre.
HIGHEST = 180 * 80  # of the range, whose lowest is 0
SWITCH = -1 * 80  # what the place of the low switch is called
TRAVEL_SECONDS = 220 / 30  # without the switch it goes so far, at that speed
CRUISE_SECONDS = 180 / 100  # from one end of the range to the other, less the ramps


def carriage(example: str, *, low: int | None = None, high: int | None = None) -> Carriage:
    """
    Return the carriage of a board that runs *example*, with switches at these places.
    """
    plan = api.plan(SPEC)
    board = Terminal(build_example(SPEC, example, default_compiler()), plan)
    return Carriage(board, plan, low=low, high=high)


def test_home_finds_its_switch_and_goes_to_and_fro() -> None:
    """
    The switch is 300 steps away: its place is called -80 from then on, and the range counts there.
    """
    there = carriage("Home", low=-300)
    origin = -300 - SWITCH
    there.wait(2.5)

    assert there.board.text == "slide is home\r\n"
    home = len(there.places)
    there.wait(2 * (CRUISE_SECONDS + 0.5))
    assert there.board.text == "slide is home\r\n"
    places = there.places[home:]
    assert min(places) == pytest.approx(origin, abs=1)
    assert max(places) == pytest.approx(origin + HIGHEST, abs=1)


def test_home_says_that_there_is_no_switch() -> None:
    """
    After the 220 mm of the spec it gives up, says so once and stays where it is.
    """
    there = carriage("Home")
    there.wait(TRAVEL_SECONDS - 0.1)
    assert there.board.text == ""
    there.wait(0.5)

    assert there.board.text == "slide has not found its switch, or that stays pressed\r\n"
    assert there.place == -220 * 80
    there.wait(0.5)
    assert there.place == -220 * 80
    assert there.board.text.count("\n") == 1


def test_home_says_that_a_switch_has_stopped_it() -> None:
    """
    A switch within the range: at 8000 steps/s the carriage is up to 8 steps beyond it when pressed.
    """
    there = carriage("Home", low=-300, high=5000)
    there.wait(4)

    assert there.board.text == "slide is home\r\nslide stopped at a limit switch\r\n"
    assert 5000 <= there.place <= 5009


def test_the_console_homes_and_says_why_it_moves_no_more() -> None:
    """
    Words for homing and for faults, and an answer for each way in which a move is refused.
    """
    there = carriage("Console", low=-300, high=5000)
    board = there.board
    there.wait(0.1)
    board.enter("fault", "no fault")
    board.enter("to 14401", "that is beyond its range")
    board.enter("home", "ok")
    board.enter("to 100", "not while it looks for home")
    board.enter("speed 500", "not while it looks for home")
    board.enter("home", "not while it runs")
    there.wait(2.5)
    board.enter("status", "slide at rest, at step 0")
    board.enter("run", "ok")
    there.wait(2)
    board.enter("to 0", "not until you clear the fault")
    board.enter("fault", "stopped at a limit switch")
    board.enter("clear", "ok")
    board.enter("fault", "no fault")
    board.enter("to 0", "ok")
    there.wait(2)
    board.enter("status", "slide at rest, at step 0")


def test_the_console_lists_the_words_of_a_motor_that_homes() -> None:
    """
    There is a line of help for each, and none that says a motor with a range runs without end.
    """
    there = carriage("Console")
    there.wait(0.1)
    there.board.type(b"help\n")
    shown = there.board.until("where is it\n", seconds=0.3)

    words = [line.split()[0] for line in shown.splitlines()[1:]]
    assert words == [
        *("to", "move", "speed", "run", "stop", "zero"),
        *("home", "fault", "clear", "on", "off", "status"),
    ]
    assert "without an end" not in shown

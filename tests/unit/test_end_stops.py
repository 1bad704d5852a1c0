"""
What the planner makes of the limits of an axis: steps, intervals, pins and cycles.
"""

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest
from pydantic import TypeAdapter, ValidationError

from stepgen import api
from stepgen.plan.end_stops import EndSwitch, HomingPlan, Pace
from stepgen.plan.instructions import total_cycles
from stepgen.plan.model import MotorPlan, Plan
from stepgen.plan.polls import Polls
from stepgen.spec.quantities import Place, Quantity, Way

Planner = Callable[[str], Plan]
SPECS = Path(__file__).parents[2] / "specs"
SLIDE = api.plan(SPECS / "uno_homing.yaml").motors[0]
X, Y, Z = api.plan(SPECS / "mega_ramps_limits.yaml").motors
PLAIN = """
board: {board}
motors:
  slide:
    drive: {{kind: step-dir, step: D2, dir: D5, enable: D8, driver: A4988}}
    timing: {{kind: compare, timer: 1}}
    motion: {{kind: trapezoid, cruise_speed: 2000, acceleration: 4000}}
{limits}
"""


def switches(motor: MotorPlan) -> list[tuple[str, str, str, bool, bool]]:
    """
    Return of each switch of *motor* its end, pin, register, and whether it is high and pulled up.
    """
    stops = motor.end_stops
    assert stops is not None
    return [
        (one.end, one.pin.label, one.register.name, one.active_high, one.pull_up)
        for one in stops.switches
    ]


def test_ways_and_places_are_whole_steps() -> None:
    """
    80 steps in a millimetre: 180 mm are 14 400, -1 mm is -80; it rests where its range begins.
    """
    stops = SLIDE.end_stops
    assert stops is not None
    assert stops.range == (0, 14_400)
    # 30 mm/s are 2400 steps/s: 16e6 * 256 / 2400 = 1 706 666.7; 5 mm/s are 400: 10 240 000.
    assert stops.homing is not None
    assert stops.homing.fast.interval_256 == 1_706_666
    assert stops.homing.slow == Pace(10_240_000, 0)
    ways = replace(stops.homing, fast=Pace(0, 0), slow=Pace(0, 0))
    assert ways == HomingPlan("low", Pace(0, 0), Pace(0, 0), 240, 17_600, -80, 0)


def test_the_way_behind_the_switch_is_that_of_the_ramp() -> None:
    """
    From 2400 to the start speed of 400 steps/s at 40 000 steps/s^2: (2400^2 - 400^2) / 80 000 = 70.
    """
    stops = SLIDE.end_stops
    assert stops is not None
    assert stops.homing is not None
    assert 67 <= stops.homing.fast.height <= 70


def test_switches_are_at_the_pins_of_the_board() -> None:
    """
    The Uno's D9 and D10 are PB1 and PB2, the Mega's D2 PE4, D14 PJ1 and D15 PJ0.
    """
    assert switches(SLIDE) == [
        ("low", "D9", "PINB", False, True),
        ("high", "D10", "PINB", True, True),
    ]
    assert switches(X) == [("high", "D2", "PINE", False, True)]
    assert switches(Y) == [
        ("low", "D14", "PINJ", True, True),
        ("high", "D15", "PINJ", True, False),
    ]
    assert switches(Z) == []


def test_turns_are_steps_of_the_driver() -> None:
    """
    1.5 turns of 200 full steps in 16 microsteps each are 4800.
    """
    assert Z.end_stops is not None
    assert Z.end_stops.range == (-4_800, 4_800)


@pytest.mark.parametrize(
    ("board", "limits", "more"),
    [
        ("uno", "range: [0, 9]", 0),
        ("uno", "low: D9", 2),
        ("uno", "{low: D9, high: D10}", 4),
        ("mega", "{low: D22, high: D14}", 6),  # PA0; PJ1 is beyond SBIS
        ("mega", "{low: D15, high: D14}", 8),
    ],
)
def test_each_switch_costs_the_step_so_many_cycles(
    planned: Planner, board: str, limits: str, more: int
) -> None:
    """
    SBIS that skips takes 2 cycles, LDS and SBRS that skips 4 (instruction set manual).
    """
    plain = planned(PLAIN.format(board=board, limits="")).motors[0].hot_path
    flow = limits if limits.startswith("{") else f"{{{limits}}}"
    path = planned(PLAIN.format(board=board, limits=f"    limits: {flow}")).motors[0].hot_path

    assert path.usual_cycles - plain.usual_cycles == more
    assert path.edge_cycles - plain.edge_cycles == more


def test_a_pressed_switch_costs_what_the_look_at_the_direction_takes() -> None:
    """
    By hand: SBIS 1, RJMP 2, LDS 2, ANDI 1, CPI 1, BREQ 1, RJMP 2 are 10 for the low switch.

    They are 9 for the high one, in place of 2 each.
    """
    assert SLIDE.end_stops is not None
    polls = Polls(SLIDE.end_stops.switches, "")

    assert polls.cycles == 4
    assert polls.pressed_cycles == (10 - 2) + (9 - 2)
    assert Polls((), "").pressed_cycles == total_cycles(Polls((), "").rare(())) == 0


def test_the_pins_of_switches_are_taken(planned: Planner) -> None:
    """
    Another motor cannot have them; `tests/cli/test_refused.py` has the words.
    """
    made = planned(PLAIN.format(board="uno", limits="    limits: {low: A0}"))
    stops = made.motors[0].end_stops
    assert stops is not None
    (switch,) = stops.switches
    assert isinstance(switch, EndSwitch)
    assert switch.pin.bit.name == "PC0"


@pytest.mark.parametrize(
    ("written", "number", "unit"),
    [
        (0, 0, "steps"),
        (-7, -7, "steps"),
        ("-2 mm", -2, "mm"),
        ("0.0 deg", 0, "deg"),
        ("1.5 turns", Fraction(3, 2), "turns"),
        ("1/3 mm", Fraction(1, 3), "mm"),
        (2_000_000_000, 2_000_000_000, "steps"),
    ],
)
def test_places_are_kept_as_they_are_written(
    written: float | str, number: Fraction, unit: str
) -> None:
    """
    Signs, zero, units and fractions.
    """
    place = TypeAdapter(Place).validate_python(written)

    assert (place.number, place.unit) == (number, unit)
    assert isinstance(place, Quantity)


@pytest.mark.parametrize("written", [True, None, "", "-", "mm", "--2", "1 2", "1e3", "nan", [1]])
def test_what_is_no_place(written: object) -> None:
    """
    Each is refused as a value, not with an exception of Python's own.
    """
    with pytest.raises(ValidationError):
        TypeAdapter(Place).validate_python(written)


@pytest.mark.parametrize("written", [0, -1, "-5 mm", "0 mm"])
def test_a_way_is_above_zero(written: float | str) -> None:
    """
    Backward or nowhere is no way.
    """
    with pytest.raises(ValidationError, match="is no way"):
        TypeAdapter(Way).validate_python(written)

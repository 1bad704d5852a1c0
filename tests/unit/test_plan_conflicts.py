"""
Conflicts: what two owners want, and what the board lacks, each with its place and a way out.
"""

from collections.abc import Callable
from pathlib import Path

import pytest

from stepgen.devices import boards
from stepgen.errors import Fault, StepgenError
from stepgen.plan.claims import Claim, report_conflicts
from stepgen.plan.faults import Faults
from stepgen.plan.model import Plan
from stepgen.spec import load_spec

Planner = Callable[[str], Plan]
Faulty = Callable[[str], tuple[Fault, ...]]

_FREE_UNO = "{drive: {kind: four-wire, pins: [D4, D5, D6, D7]}}"


@pytest.fixture
def faults(planned: Planner) -> Faulty:
    """
    Return a function that plans a spec in conflict and gives the faults.
    """

    def plan(text: str) -> tuple[Fault, ...]:
        with pytest.raises(StepgenError) as error:
            planned(text)
        return error.value.faults

    return plan


@pytest.fixture
def spec_faults(tmp_path: Path) -> Faults:
    """
    Return an empty list of faults of a spec.
    """
    path = tmp_path / "spec.yaml"
    path.write_text(f"library: M\nboard: uno\nmotors:\n  m: {_FREE_UNO}\n", encoding="utf-8")
    return Faults(load_spec(path))


def _lines(found: tuple[Fault, ...]) -> list[str]:
    return [f"{fault.place.split('spec.yaml', 1)[1]} {fault.reason}" for fault in found]


def test_an_unknown_board_is_refused_with_the_known_ones(faults: Faulty) -> None:
    """
    The message lists the boards there are.
    """
    (fault,) = faults("board: zero\nmotors:\n  motor: {drive: motor-shield}\n")

    assert (fault.place[-4:], fault.text) == (":2:8", "zero")
    known = ", ".join(board.name for board in boards())
    assert fault.reason == f"is no board that stepgen knows; choose one of {known}"


def test_a_timer_that_the_board_lacks_is_refused(faults: Faulty) -> None:
    """
    The Uno has one 16-bit timer, and the message names it.
    """
    found = faults("board: uno\nmotors:\n  motor: {drive: motor-shield, timer: 3}\n")

    assert found[0].text == "3"
    assert _lines(found) == [
        ":4:39 the Arduino Uno has no 16-bit timer 3; fast-pwm runs on timer 1"
    ]


def test_a_pin_that_the_board_lacks_is_refused(faults: Faulty) -> None:
    """
    Each pin that is not there is reported at its own place.
    """
    found = faults(
        "board: uno\nmotors:\n  motor: {drive: {kind: four-wire, pins: [D4, A8, D6, D53]}}\n"
    )

    assert [fault.text for fault in found] == ["A8", "D53"]
    assert _lines(found)[0] == (
        ":4:47 the Arduino Uno has no pin A8; `stepgen boards uno` lists them"
    )


def test_a_pin_under_two_names_is_one_pin(faults: Faulty) -> None:
    """
    D4 and PD4 are the same copper, which only the board knows.
    """
    found = faults(
        "board: uno\nmotors:\n  motor: {drive: {kind: four-wire, pins: [D4, D5, D6, PD4]}}\n"
    )

    assert [(fault.text, fault.reason) for fault in found] == [
        ("PD4", "PD4 is D4 again; give each of the four coils a pin of its own")
    ]


def test_two_motors_cannot_share_a_pin(faults: Faulty) -> None:
    """
    The second motor is told who has the pin, as what, and what to do.
    """
    found = faults(
        "board: mega\nmotors:\n"
        "  pan: {drive: {kind: four-wire, pins: [D22, D23, D24, D12]}, timer: 3}\n"
        "  tilt: {drive: motor-shield, timer: 4}\n"
    )

    (line,) = _lines(found)
    assert line == (
        ":5:17 pin D12 (PB6) is taken by motor pan, as coil D and wanted by motor tilt, as DIR A; "
        "move the other one, since a shield's pins are fixed (a second shield goes on top with "
        "`stacked: true`)"
    )


def test_two_motors_cannot_share_a_timer(faults: Faulty) -> None:
    """
    The way out names the timers that are left.
    """
    found = faults(
        "board: mega\nmotors:\n"
        "  pan: {drive: {kind: four-wire, pins: [D22, D23, D24, D25]}, timer: 3}\n"
        "  tilt: {drive: motor-shield, timer: 3}\n"
    )

    assert _lines(found) == [
        ":5:38 timer 3 is taken by motor pan and wanted by motor tilt; take timer 1 or 4 or 5"
    ]


def test_timers_that_are_named_are_given_away_first(planned: Planner) -> None:
    """
    A motor that takes any timer does not take the one that a later motor names.
    """
    plan = planned(
        "board: mega\nmotors:\n"
        "  pan: {drive: {kind: four-wire, pins: [D22, D23, D24, D25]}}\n"
        "  tilt: {drive: motor-shield, timer: 1}\n"
    )

    assert [motor.timing.timer.number for motor in plan.motors] == [3, 1]


def test_all_conflicts_are_reported_together(faults: Faulty) -> None:
    """
    Pins, timers and libraries come in one report, in the order of the lines.
    """
    found = faults(
        "board: uno\nuses: [Nothing]\nmotors:\n"
        "  pan: {drive: {kind: four-wire, pins: [D0, A9, D5, D6]}, timer: 2}\n"
        "  tilt: {drive: motor-shield, timer: 1}\n"
    )

    assert [fault.text for fault in found] == ["Nothing", "A9", "2"]


@pytest.mark.parametrize(
    ("one", "other", "conflicts"),
    [
        ("", "", ["vector PCINT0_vect is taken by pan and wanted by tilt; move"]),
        ("step", "step", []),
        ("step", "", ["vector PCINT0_vect is taken by pan and wanted by tilt; move"]),
    ],
)
def test_claims_conflict_unless_they_share(
    spec_faults: Faults, one: str, other: str, conflicts: list[str]
) -> None:
    """
    Two claims of one resource stand beside each other only if both say that they share it.
    """
    resource = "vector PCINT0_vect"
    first = Claim(resource, "pan", spec_faults, "move", sharing=one)
    second = Claim(resource, "tilt", spec_faults, "move", sharing=other)

    report_conflicts([first, second])

    assert [fault.reason for fault in spec_faults.found] == conflicts

"""
Stacked Motor Shields: their wires, what the lower one loses, and what is refused.

Source: systems/1-motor-driver.md: a second shield's D12 and D13 are cut and wired to D9 and D8,
and the brake jumpers of both shields are cut.
"""

from collections.abc import Callable
from pathlib import Path

import pytest
from pydantic import ValidationError

from stepgen.errors import StepgenError
from stepgen.plan.coils import CoilDrive
from stepgen.plan.kernels import Ring
from stepgen.plan.planner import make_plan
from stepgen.spec import Spec, load_spec

Drives = Callable[..., list[CoilDrive]]
Refused = Callable[..., list[str]]

OWN = "{kind: motor-shield, stacked: true, enables: [D6, D7]}"
OWN_HALF = "{kind: motor-shield, stacked: true, enables: [D6, D7], sequence: half}"
SHARING = "{kind: motor-shield, stacked: true}"


@pytest.fixture
def drives(tmp_path: Path) -> Drives:
    """
    Return a function that plans motors with the given drives and returns what became of them.
    """

    def plan(*drives: str, board: str = "mega") -> list[CoilDrive]:
        path = tmp_path / "spec.yaml"
        motors = "".join(f"  m{index}: {{drive: {drive}}}\n" for index, drive in enumerate(drives))
        path.write_text(f"library: Mine\nboard: {board}\nmotors:\n{motors}", encoding="utf-8")
        planned = [motor.drive for motor in make_plan(load_spec(path)).motors]
        return [drive for drive in planned if isinstance(drive, CoilDrive)]

    return plan


@pytest.fixture
def refused(drives: Drives) -> Refused:
    """
    Return a function that plans motors with drives that cannot be, and gives the reasons.
    """

    def plan(*specs: str, board: str = "mega") -> list[str]:
        with pytest.raises(StepgenError) as error:
            drives(*specs, board=board)
        return [fault.reason for fault in error.value.faults]

    return plan


def _wires(drive: CoilDrive) -> dict[str, str]:
    return {wire.signal: wire.pin.label for wire in drive.every_wire}


def _shield(**more: object) -> Spec:
    drive = {"kind": "motor-shield", **more}
    return Spec.model_validate({"library": "M", "board": "uno", "motors": {"m": {"drive": drive}}})


def test_a_stacked_shield_steps_on_d9_and_d8(drives: Drives) -> None:
    """
    Its DIR wires are D9 and D8, its enables those that are given, and it has no brakes.
    """
    (drive,) = drives(OWN, board="uno")

    assert _wires(drive) == {"DIR A": "D9", "DIR B": "D8", "PWM A": "D6", "PWM B": "D7"}
    assert [wire.signal for wire in drive.enables] == ["PWM A", "PWM B"]
    assert drive.title == "Arduino Motor Shield (L298), stacked"


def test_a_stacked_shield_alone_may_keep_the_enables(drives: Drives) -> None:
    """
    Without a lower shield of ours, nobody else wants D3 and D11.
    """
    (drive,) = drives(SHARING, board="uno")

    assert _wires(drive) == {"DIR A": "D9", "DIR B": "D8", "PWM A": "D3", "PWM B": "D11"}
    assert not drive.shared_enables


def test_the_lower_shield_loses_its_brakes(drives: Drives) -> None:
    """
    Below a stacked shield D9 and D8 are no brakes; they are without one.
    """
    lower, upper = drives("motor-shield", OWN)
    (alone,) = drives("motor-shield")

    assert _wires(lower) == {"DIR A": "D12", "DIR B": "D13", "PWM A": "D3", "PWM B": "D11"}
    assert (lower.quiet, upper.quiet) == ((), ())
    assert [wire.pin.label for wire in alone.quiet] == ["D9", "D8"]


def test_both_shields_make_half_steps_with_enables_of_their_own(drives: Drives) -> None:
    """
    Half steps switch the enables, which is fine when each shield has its own.
    """
    lower, upper = drives("{kind: motor-shield, sequence: half}", OWN_HALF)

    assert (len(lower.phases), len(upper.phases)) == (8, 8)
    assert not lower.shared_enables
    assert not upper.shared_enables


def test_two_shields_have_their_example() -> None:
    """
    In specs/mega_two_shields.yaml the upper shield is on one port, so a step is one write.
    """
    path = Path(__file__).resolve().parents[2] / "specs" / "mega_two_shields.yaml"
    lower, upper = make_plan(load_spec(path)).motors

    assert {wire.pin.bit.port for wire in upper.drive.wires} == {"H"}
    assert isinstance(upper.kernel, Ring)
    assert len(upper.kernel.writes) == 1
    assert lower.timing.timer.number != upper.timing.timer.number


@pytest.mark.parametrize("order", [("motor-shield", SHARING), (SHARING, "motor-shield")])
def test_shields_in_full_steps_share_their_enables(drives: Drives, order: tuple[str, str]) -> None:
    """
    Whichever of the shields the spec names first: D3 and D11 are both motors', the rest is not.
    """
    first, second = drives(*order)

    assert first.shared_enables
    assert second.shared_enables
    assert set(first.every_wire) & set(second.every_wire) == set(first.enables)
    assert first.enables == second.enables == first.released
    assert [wire.pin.label for wire in first.enables] == ["D3", "D11"]


@pytest.mark.parametrize("sequence", ["half", "wave"])
@pytest.mark.parametrize("place", [0, 1])
def test_steps_that_switch_coils_cannot_share_enables(
    refused: Refused, sequence: str, place: int
) -> None:
    """
    On either shield: the enables of one motor would switch the coils of the other.
    """
    shields = ["{kind: motor-shield", "{kind: motor-shield, stacked: true"]
    shields[place] += f", sequence: {sequence}"

    (reason,) = refused(*(f"{shield}}}" for shield in shields))

    assert reason == (
        f"{sequence} steps switch the coils by the enables, which two shields share here; take "
        "`sequence: full`, or give the stacked one enables of its own, `enables: [..]`"
    )


def test_two_shields_in_one_place_are_refused(refused: Refused) -> None:
    """
    Of two shields one must be stacked, and of two stacked ones only one can be.
    """
    below = refused("motor-shield", "motor-shield")
    above = refused(OWN, "{kind: motor-shield, stacked: true, enables: [D4, D5]}")

    assert len(below) == len(above) == 1
    assert below[0].startswith("pin D12 (PB6), pin D13 (PB7), pin D3 (PE5)")
    assert above[0].startswith("pin D9 (PH6) and pin D8 (PH5) are taken by motor m0 and wanted by")
    assert below[0].endswith("(a second shield goes on top with `stacked: true`)")


@pytest.mark.parametrize(
    ("enables", "reason"),
    [
        ("[D9, D6]", "D9 is DIR A of this shield already; take a free pin"),
        ("[D6, PH5]", "D8 is DIR B of this shield already; take a free pin"),
        ("[D6, PH3]", "D6 is PWM A of this shield already; take a free pin"),
        (
            "[D6, D77]",
            "PWM B: the Arduino Mega 2560 has no pin D77; `stepgen boards mega` lists them",
        ),
    ],
)
def test_enables_need_free_pins_of_the_board(refused: Refused, enables: str, reason: str) -> None:
    """
    An enable on a missing pin, or on one of the shield's own, is refused.
    """
    drive = f"{{kind: motor-shield, stacked: true, enables: {enables}}}"

    assert refused(drive) == [reason]


@pytest.mark.parametrize(
    ("fields", "reason"),
    [
        ({"enables": ["D5", "D6"]}, "enables are for the shield on top"),
        ({"stacked": True, "enables": ["D5", 5]}, "pin D5 is both enables"),
        ({"stacked": True, "enables": ["D5"]}, "are two pins, those of PWM A and PWM B"),
        ({"stacked": True, "enables": "D5"}, "are two pins, those of PWM A and PWM B"),
        ({"stacked": True, "enables": ["D5", "D6", "D7"]}, "are two pins, those of"),
        ({"stacked": True, "enables": ["D5", "Q"]}, "is no pin; write it as D12, A8 or PB4"),
    ],
)
def test_enables_are_two_pins_of_a_stacked_shield(fields: dict[str, object], reason: str) -> None:
    """
    What the spec itself can tell is refused before any board is asked.
    """
    with pytest.raises(ValidationError, match=reason):
        _shield(**fields)

"""
What a spec may say, in short and in long forms, and what it then means.
"""

from fractions import Fraction
from typing import Any

import pytest
from pydantic import ValidationError

from stepgen.spec import Spec


def _spec(motor: dict[str, Any] | str, **more: object) -> Spec:
    return Spec.model_validate(
        {"library": "Mine", "board": "uno", "motors": {"motor": motor}, **more}
    )


@pytest.mark.parametrize(
    ("short", "long"),
    [
        ({"drive": "motor-shield"}, {"drive": {"kind": "motor-shield"}}),
        (
            {"drive": "motor-shield", "timer": 3},
            {"drive": "motor-shield", "timing": {"kind": "fast-pwm", "timer": 3}},
        ),
        (
            {"drive": "motor-shield", "timing": {"timer": 3}},
            {"drive": "motor-shield", "timing": {"kind": "fast-pwm", "timer": 3}},
        ),
        (
            {"drive": "motor-shield", "timing": "fast-pwm", "timer": 3},
            {"drive": "motor-shield", "timing": {"kind": "fast-pwm", "timer": 3}},
        ),
        (
            {"drive": "four-wire", "pins": ["D4", "D5", "D6", "D7"], "sequence": "half"},
            {
                "drive": {
                    "kind": "four-wire",
                    "pins": ["D4", "D5", "D6", "D7"],
                    "sequence": "half",
                }
            },
        ),
        (
            {"drive": "motor-shield", "steps_per_turn": 200},
            {"drive": "motor-shield", "steps_per_turn": {"full_steps": 200, "gear": 1}},
        ),
        (
            {"drive": "motor-shield", "motion": "constant"},
            {"drive": "motor-shield", "motion": {"kind": "constant"}},
        ),
        (
            {"drive": "four-wire", "pins": [4, 5, 6, 7], "sequence": ["1000", "0100", "0010"]},
            {
                "drive": {
                    "kind": "four-wire",
                    "pins": ["D4", "D5", "D6", "D7"],
                    "sequence": {"patterns": ["1000", "0100", "0010"]},
                }
            },
        ),
    ],
)
def test_a_short_form_means_its_long_form(short: dict[str, Any], long: dict[str, Any]) -> None:
    """
    A short form gives the very spec that its long form gives.
    """
    assert _spec(short) == _spec(long)


def test_a_name_alone_is_a_library() -> None:
    """
    The library's metadata has defaults for all but its name.
    """
    library = _spec({"drive": "motor-shield"}).library

    assert (library.name, library.version, library.author) == ("Mine", "1.0.0", "unknown")


def test_defaults_are_safe() -> None:
    """
    Without a word a motor runs at constant speed, lets go at rest and shares its ports.
    """
    motor = _spec({"drive": "motor-shield"}).motors["motor"]

    assert (motor.motion.kind, motor.at_rest, motor.port) == ("constant", "release", "shared")
    assert motor.steps_per_turn is None


@pytest.mark.parametrize(
    ("written", "name"),
    [("D12", "D12"), ("d12", "D12"), (12, "D12"), ("12", "D12"), ("a8", "A8"), ("pb4", "PB4")],
)
def test_pins_are_given_as_people_know_them(written: str | int, name: str) -> None:
    """
    A pin is a label of the board, a number, or a port bit, in any case.
    """
    drive: Any = _spec({"drive": "four-wire", "pins": [written, 1, 2, 3]}).motors["motor"].drive

    assert drive.pins[0] == name


@pytest.mark.parametrize("written", ["", "D", "X1", "PB8", "PZ1", "D1000", "-1", -1, 1.5, True])
def test_what_is_no_pin_is_refused(written: object) -> None:
    """
    Text and numbers that no board has as a pin are refused.
    """
    with pytest.raises(ValidationError, match="is no pin; write it as D12, A8 or PB4"):
        _spec({"drive": "four-wire", "pins": [written, 1, 2, 3]})


@pytest.mark.parametrize(
    ("gear", "steps"),
    [
        ("25792/405", Fraction(32 * 25792, 405)),
        (63.68395, Fraction(32 * 6368395, 100_000)),
        (64, Fraction(2048)),
        ("63.68395", Fraction(32 * 6368395, 100_000)),
    ],
)
def test_a_gear_is_kept_exactly(gear: object, steps: Fraction) -> None:
    """
    A decimal gear is the number that was typed, and a fraction stays one.
    """
    turn = {"full_steps": 32, "gear": gear}
    motor = _spec({"drive": "motor-shield", "steps_per_turn": turn}).motors["motor"]

    assert motor.steps_per_turn is not None
    assert motor.steps_per_turn.exact == steps


@pytest.mark.parametrize("gear", [0, -1, "1/0", "x", True, 2_000_000, "1/2000000", float("nan")])
def test_a_gear_that_is_none_is_refused(gear: object) -> None:
    """
    A gear is a positive number of sensible size.
    """
    with pytest.raises(
        ValidationError, match=r"is no number; write|is out of range; write one above 0"
    ):
        _spec({"drive": "motor-shield", "steps_per_turn": {"full_steps": 32, "gear": gear}})


@pytest.mark.parametrize("name", ["motor", "pan", "x2", "leftWheel", "a" * 31])
def test_motor_names_begin_functions(name: str) -> None:
    """
    A lower-case letter and up to 30 letters or digits name a motor.
    """
    spec = Spec.model_validate(
        {"library": "Mine", "board": "uno", "motors": {name: {"drive": "motor-shield"}}}
    )

    assert list(spec.motors) == [name]


@pytest.mark.parametrize("name", ["", "Pan", "2x", "pan_1", "pan tilt", "pän", "a" * 32, "x\n"])
def test_other_names_are_no_motors(name: str) -> None:
    """
    What cannot begin a C++ function is no motor's name.
    """
    with pytest.raises(ValidationError, match="names no motor"):
        Spec.model_validate(
            {"library": "Mine", "board": "uno", "motors": {name: {"drive": "motor-shield"}}}
        )


@pytest.mark.parametrize(
    ("patterns", "reason"),
    [
        (["1000", "0100"], "has 2 patterns; write a table of 3 to 32"),
        (["1000", "0100"] * 17, "has 34 patterns; write a table of 3 to 32"),
        (["1000", "1000", "0100"], "two neighbouring patterns are equal"),
        (["1000", "0100", "1000"], "two neighbouring patterns are equal"),
        (["1000", "0100", "2000"], "is no pattern; write four characters"),
        (["1000", "0100", 10], "is no pattern; write four characters"),
    ],
)
def test_a_table_that_does_not_step_is_refused(patterns: list[object], reason: str) -> None:
    """
    A table has 3 to 32 patterns of four wires, and each step changes the wires.
    """
    with pytest.raises(ValidationError, match=reason):
        _spec({"drive": "four-wire", "pins": [1, 2, 3, 4], "sequence": patterns})


def test_the_shield_takes_no_table() -> None:
    """
    The shield's wires are enables and directions, which a table of coils does not fit.
    """
    with pytest.raises(ValidationError, match="'full', 'wave' or 'half'"):
        _spec({"drive": "motor-shield", "sequence": ["1000", "0100", "0010"]})


def test_a_spec_never_changes_after_loading() -> None:
    """
    Everything in a spec is frozen.
    """
    spec = _spec({"drive": "motor-shield"})

    with pytest.raises(ValidationError, match="frozen"):
        setattr(spec, "board", "mega")  # noqa: B010 - mypy knows that it is read-only

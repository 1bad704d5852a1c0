"""
Warnings: what a plan keeps from libraries that the spec does not name.
"""

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from stepgen.plan.planner import make_plan
from stepgen.plan.warnings import plan_warnings
from stepgen.spec import load_spec

Warned = Callable[[str], list[str]]


@pytest.fixture
def warned(tmp_path: Path) -> Warned:
    """
    Return a function that plans a spec from its text and gives the warnings.
    """

    def warn(text: str) -> list[str]:
        path = tmp_path / "spec.yaml"
        path.write_text(f"library: Mine\n{text}", encoding="utf-8")
        return [str(warning) for warning in plan_warnings(make_plan(load_spec(path)))]

    return warn


def _spec(board: str, pins: str, timer: int, uses: str = "") -> str:
    drive = f"{{kind: four-wire, pins: [{pins}]}}"
    return f"board: {board}\nuses: [{uses}]\nmotors:\n  pan: {{drive: {drive}, timer: {timer}}}\n"


def test_the_shield_on_the_uno_takes_a_lot(warned: Warned) -> None:
    """
    Timer 1 from Servo, D10's PWM, three SPI pins and the LED (Uno pinout, shield's pins).
    """
    found = warned("board: uno\nmotors:\n  pan: {drive: motor-shield}\n")

    timer, pwm, bus, led = found
    assert timer == (
        "motor pan: Servo needs timer 1 and will not work beside it; "
        "if the sketch uses it, take `timing: {kind: compare, timer: 2}` or a larger board, since "
        "no other 16-bit timer is left on this one"
    )
    assert pwm == (
        "motor pan: no analogWrite() on D10, PWM of timer 1: it would follow the motor's timer; "
        "take other pins for it"
    )
    assert bus == (
        "motor pan: SPI needs D11, D12 and D13 and will not work beside it; "
        "if the sketch uses it, give the motor other pins"
    )
    assert led == "motor pan: D13 is the board's LED; the sketch must leave LED_BUILTIN alone"


def test_an_axis_is_not_sent_to_timer_2(warned: Warned) -> None:
    """
    Ramps need a compare channel of 16 bits, of which the Uno has those of timer 1 alone.
    """
    found = warned(
        "board: uno\nmotors:\n  pan:\n    drive: motor-shield\n"
        "    timing: {kind: compare, timer: 1}\n"
        "    motion: {kind: trapezoid, cruise_speed: 500, acceleration: 900}\n"
    )

    assert found[0] == (
        "motor pan: Servo needs timer 1 and will not work beside it; if the sketch uses it, take a "
        "larger board than the Arduino Uno, since no timer that fits is left on it"
    )


def test_a_coil_on_rx_disturbs_more_than_serial(warned: Warned) -> None:
    """
    The boot loader talks over D0 and D1, too.
    """
    (line,) = (line for line in warned(_spec("uno", "D0, D1, D4, D5", 1)) if "Serial" in line)

    assert line == (
        "motor pan: Serial needs D0 and D1 and will not work beside it, and uploading may be "
        "disturbed; if the sketch uses it, give the motor other pins"
    )


@pytest.mark.parametrize(
    ("pins", "library"),
    [
        ("A2, A3, A4, A5", "Wire needs A4 and A5"),
        ("D8, D9, D10, D7", "SPI needs D10"),
    ],
)
def test_pins_of_buses_are_warned_of(warned: Warned, pins: str, library: str) -> None:
    """
    I2C is on A4 and A5 of the Uno, SPI's SS on D10 (pins_arduino.h).
    """
    assert any(library in line for line in warned(_spec("uno", pins, 1)))


@pytest.mark.parametrize(
    ("timer", "warning"),
    [
        (5, "Servo needs timer 5 and will not work beside it; if the sketch uses it, take timer"),
        (1, "Servo needs timer 1 if more than 12 are attached and will not work beside it; if"),
        (3, "Servo needs timer 3 if more than 24 are attached and will not work beside it; if"),
        (4, "Servo needs timer 4 if more than 36 are attached and will not work beside it; if"),
    ],
)
def test_servo_needs_the_timers_of_the_mega_in_turn(
    warned: Warned, timer: int, warning: str
) -> None:
    """
    5, 1, 3, 4, each for 12 servos (ServoTimers.h).
    """
    first = warned(_spec("mega", "A8, A9, A10, A11", timer))[0]

    assert first.startswith(f"motor pan: {warning}")


def test_the_free_timers_are_proposed(warned: Warned) -> None:
    """
    Those that no motor has, nor analogWrite (D11 is PWM of timer 1), nor the first servos.
    """
    first = warned(_spec("mega", "A8, A9, A10, A11", 5, "analogWrite D11"))[0]

    assert first.endswith("if the sketch uses it, take timer 3 or 4")


def test_a_named_servo_may_still_grow(warned: Warned) -> None:
    """
    `uses: [Servo]` stands for up to 12 servos; the 13th would take timer 1.
    """
    found = warned(_spec("mega", "A8, A9, A10, A11", 1, "Servo"))

    assert found[0] == (
        "motor pan: Servo takes timer 1, too, if more than 12 are attached; "
        "name their pins (`Servo D22 D23 ...`), or attach 12 at most"
    )
    assert not any("Servo" in w for w in warned(_spec("mega", "A8, A9, A10, A11", 1, "Servo D22")))


def test_pwm_pins_of_the_timer_are_warned_of(warned: Warned) -> None:
    """
    Timer 4 of the Mega is PWM on D6, D7 and D8, and OC4A is D6; a named analogWrite is checked.
    """
    text = _spec("mega", "A8, A9, A10, A11", 4)

    assert (
        "motor pan: no analogWrite() on D6, D7 or D8, PWM of timer 4: it rewrites OCR4A, and the "
        "motor would run away; take other pins for it"
    ) in warned(text)
    named = warned(_spec("mega", "A8, A9, A10, A11", 4, "analogWrite D11"))
    assert not any("analogWrite" in line for line in named)


def test_what_nobody_misses_is_not_mentioned(warned: Warned) -> None:
    """
    With Servo's few and analogWrite named, a motor on port K has nothing that others need.
    """
    assert warned(_spec("mega", "A8, A9, A10, A11", 4, "Servo D22, analogWrite D11")) == []


def test_every_motor_is_named(warned: Warned) -> None:
    """
    The warnings come in the order of the motors, each with its motor.
    """
    found = warned(
        "board: mega\nmotors:\n"
        "  tilt: {drive: motor-shield, timer: 3}\n"
        "  pan: {drive: {kind: four-wire, pins: [A8, A9, A10, A11]}, timer: 4}\n"
    )

    motors = [line.split(":")[0] for line in found]
    assert motors == sorted(motors, reverse=True)
    assert set(motors) == {"motor tilt", "motor pan"}


def test_usb_of_the_core_can_hold_a_motor_up(warned: Warned) -> None:
    """
    Of a chip with USB it is always said, and of Serial there if the spec uses it.
    """
    pins = "A0, A1, A2, A3"
    alone = [text for text in warned(_spec("leonardo", pins, 3)) if "nothing bounds" in text]
    beside = warned(_spec("leonardo", pins, 3, "Serial, Serial1"))
    held = [text.split(",")[0] for text in beside if "nothing bounds" in text]

    assert [text.split(",")[0] for text in alone] == ["motor pan: nothing bounds USB"]
    # A step waits for all of a frame of 1 ms and the interrupt around it: less than 1000 a second.
    (rate,) = re.findall(r"up to (\d+) steps/s are safe beside it", alone[0])
    assert 800 < int(rate) < 1000
    assert held == ["motor pan: nothing bounds USB", "motor pan: nothing bounds Serial"]
    assert not any("nothing bounds" in text for text in warned(_spec("uno", pins, 1, "Serial")))


def test_pins_of_switches_are_a_motors_own(warned: Warned) -> None:
    """
    A limit switch on D9 leaves D10's PWM to warn of; one on D13 is on the LED and on SPI's clock.
    """
    text = """\
board: uno
motors:
  slide:
    drive: {kind: step-dir, step: D2, dir: D5, driver: A4988}
    timing: {kind: compare, timer: 1}
    at_rest: hold
    motion: {kind: trapezoid, cruise_speed: 1000, acceleration: 5000}
    limits: {low: D9, high: D13}
"""
    found = warned(text)

    assert any("no analogWrite() on D10, PWM of timer 1" in line for line in found)
    assert any("SPI needs D13 and will not work beside it" in line for line in found)
    assert "motor slide: D13 is the board's LED; the sketch must leave LED_BUILTIN alone" in found

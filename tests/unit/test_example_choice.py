"""
Which examples a library has: those that suit its motors, its board and what the spec names.
"""

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from stepgen import api
from stepgen.devices import SKETCH_LIBRARIES

Generate = Callable[[str], dict[str, str]]

COILS = "{kind: four-wire, pins: [D4, D5, D6, D7]}"
ALWAYS = {"Smallest", "Turn"}


@pytest.fixture
def generate(tmp_path: Path) -> Generate:
    """
    Return a function: from a spec without its name to the files of the library.
    """

    def made(text: str) -> dict[str, str]:
        spec = tmp_path / "spec.yaml"
        spec.write_text(f"library: Mine\n{text}", encoding="utf-8")
        return api.render(spec)

    return made


def spec(motor: str, *, board: str = "uno", uses: str = "") -> str:
    """
    Return a spec of one motor.
    """
    return f"board: {board}\nuses: [{uses}]\nmotors:\n  motor: {{{motor}}}\n"


def names(files: dict[str, str]) -> set[str]:
    """
    Return the examples among *files*.
    """
    return {Path(path).stem for path in files if path.endswith(".ino")}


@pytest.mark.parametrize(
    ("motor", "more"),
    [
        ("drive: motor-shield", {"Console"}),
        (f"drive: {COILS}", {"Console", "WiringTest"}),
        (f"drive: {COILS}, sequence: ['1010', '0110', '0101', '1001']", {"Console"}),
        ("drive: motor-shield, motion: update-events", {"Console", "Ramp"}),
    ],
)
def test_a_motor_has_the_examples_that_suit_it(
    generate: Generate, motor: str, more: set[str]
) -> None:
    """
    WiringTest is for pins whose order the spec chooses, Ramp for speeds that change.
    """
    files = generate(spec(motor))

    assert names(files) == ALWAYS | more
    for name in names(files):
        assert f"\n| {name} | " in files["README.md"]


@pytest.mark.parametrize(
    ("motor", "uses", "owner"),
    [
        ("drive: {kind: four-wire, pins: [D1, D5, D6, D7]}", "", "motor motor has D1"),
        (f"drive: {COILS}", "SoftwareSerial D0 D8", "SoftwareSerial has D0"),
    ],
)
def test_without_the_pins_of_serial_nothing_can_be_typed(
    generate: Generate, motor: str, uses: str, owner: str
) -> None:
    """
    Neither Console nor WiringTest is there, and the README says who has the pin.
    """
    files = generate(spec(motor, uses=uses))

    assert not names(files) & {"Console", "WiringTest"}
    for name in ("Console", "WiringTest"):
        assert f"There is no {name}, which needs Serial: {owner}." in files["README.md"]


def test_the_console_says_that_serial_is_not_counted(generate: Generate) -> None:
    """
    Where `uses` does not name Serial, the highest rate does not stand beside its interrupts.
    """
    note = "The spec's `uses` does not name Serial"

    assert note in generate(spec("drive: motor-shield"))["examples/Console/Console.ino"]
    named = generate(spec("drive: motor-shield", uses="Serial"))
    assert note not in named["examples/Console/Console.ino"]


@pytest.mark.parametrize(
    ("uses", "there"),
    [("", False), ("millis", False), ("Serial", True), ("millis, tone", True)],
)
def test_together_is_there_if_uses_names_something_to_show(
    generate: Generate, uses: str, *, there: bool
) -> None:
    """
    Nothing can be shown of millis, which every sketch uses.
    """
    assert ("Together" in names(generate(spec(f"drive: {COILS}", uses=uses)))) == there


@pytest.mark.parametrize("name", sorted(set(SKETCH_LIBRARIES) - {"millis"}))
def test_each_library_that_uses_can_name_is_in_together(generate: Generate, name: str) -> None:
    """
    There is a partial for each, which does something with it.
    """
    motor = "drive: {kind: four-wire, pins: [A0, A1, A2, A3]}, timer: 4"
    sketch = generate(spec(motor, board="mega", uses=name))["examples/Together/Together.ino"]

    assert re.search(rf"\b{name}\b.*;|<{name}.h>", sketch)


@pytest.mark.parametrize(
    ("uses", "lines"),
    [
        ("SoftwareSerial D2 A0", ["software(2, A0);"]),
        ("SoftwareSerial D2, tone D12", ["software(2, 8);", "tone(12, "]),
        ("Servo D10 D9", ["servoD10.attach(10);", "servoD9.attach(9);"]),
        ("tone", ["tone(8, "]),
    ],
)
def test_others_get_the_pins_of_the_spec_or_free_ones(
    generate: Generate, uses: str, lines: list[str]
) -> None:
    """
    What `uses` does not say is chosen: the first free pin of port B, D8.
    """
    timing = "timing: compare" if "Servo" in uses else "timer: 1"
    files = generate(spec(f"drive: {COILS}, {timing}", uses=uses))

    for line in lines:
        assert line in files["examples/Together/Together.ino"]


def test_software_serial_is_left_out_where_a_byte_of_it_is_too_long(generate: Generate) -> None:
    """
    Beside timing compare no stretch of a byte is allowed, so the sketch has none and says so.
    """
    files = generate(spec(f"drive: {COILS}, timing: compare", uses="Serial, SoftwareSerial"))
    sketch = files["examples/Together/Together.ino"]

    assert "SoftwareSerial.h" not in sketch
    assert "SoftwareSerial is left out: for each byte it has interrupts off, too long" in sketch


def test_no_example_asks_for_more_than_the_library_accepts(generate: Generate) -> None:
    """
    With at most 90 steps/s in the spec, the sketches ask for 90, and the ramp goes from 22 to 90.
    """
    motor = "drive: motor-shield, motion: update-events, max_steps_per_second: 90"
    files = generate(spec(motor))

    for name in ("Smallest", "Turn", "Console"):
        assert "motorTimerCalcPerSecond(90)" in files[f"examples/{name}/{name}.ino"]
    assert "From 22 steps/s" in files["examples/Ramp/Ramp.ino"]
    assert "to 90 steps/s" in files["examples/Ramp/Ramp.ino"]


SLIDE = """\
board: uno
motors:
  slide:
    drive: {kind: step-dir, step: D3, dir: D5, driver: A4988}
    timing: {kind: compare, timer: 1}
    at_rest: hold
    motion: {kind: trapezoid, cruise_speed: 1000, acceleration: 5000}
    limits: {LIMITS}
"""
HOMING = (
    "homing: {towards: END, speed: 300, slow_speed: 50, back_off: 30, travel: 900, position: 40}"
)


@pytest.mark.parametrize(
    ("limits", "near", "far"),
    [
        (f"low: D9, {HOMING.replace('END', 'low')}", 40, 240),
        (f"high: D9, {HOMING.replace('END', 'high')}", 40, -160),
        (f"low: D9, range: [50, 700], {HOMING.replace('END', 'low')}", 50, 700),
    ],
)
def test_home_goes_to_and_fro_where_it_may(
    generate: Generate, limits: str, near: int, far: int
) -> None:
    """
    Between the ends of the range, or without one 200 steps away from the switch and back.
    """
    files = generate(SLIDE.replace("LIMITS", limits))
    sketch = files["examples/Home/Home.ino"]

    assert names(files) == ALWAYS | {"Console", "Home"}
    assert f"constexpr int32_t kSlideNear = {near};" in sketch
    assert f"constexpr int32_t kSlideFar = {far};" in sketch
    assert "\n| Home | " in files["README.md"]


def test_only_a_motor_that_homes_has_home(generate: Generate) -> None:
    """
    Switches alone find nothing; the console has words for their faults, but not for homing.
    """
    files = generate(SLIDE.replace("LIMITS", "low: D9"))
    console = files["examples/Console/Console.ino"]

    assert names(files) == ALWAYS | {"Console"}
    assert '"clear        ' in console
    assert '"home         ' not in console
    assert "MOTOR_FAULT_HOMING" not in console


def test_a_switch_on_a_pin_of_serial_leaves_nothing_to_type(generate: Generate) -> None:
    """
    Neither Console nor Home is there, and the README says that the motor has the pin.
    """
    files = generate(SLIDE.replace("LIMITS", f"low: D0, {HOMING.replace('END', 'low')}"))

    assert names(files) == ALWAYS
    for name in ("Console", "Home"):
        assert f"There is no {name}, which needs Serial: motor slide has D0." in files["README.md"]


def test_others_do_not_get_the_pin_of_a_switch(generate: Generate) -> None:
    """
    Without the switch tone would have D8, the first free pin of port B.
    """
    text = SLIDE.replace("uno\n", "uno\nuses: [tone]\n")
    pins = []
    for switch in ("D4", "D8"):
        files = generate(text.replace("LIMITS", f"low: {switch}"))
        pins += re.findall(r"tone\((\d+), ", files["examples/Together/Together.ino"])

    assert set(pins) == {"8", "9"}


@pytest.mark.parametrize(
    ("limits", "words"),
    [("low: D9", "for ever"), ("range: [0, 700]", "to the end of its range")],
)
def test_smallest_says_how_long_the_motor_turns(
    generate: Generate, limits: str, words: str
) -> None:
    """
    A motor with a range turns to its end and stands there.
    """
    files = generate(SLIDE.replace("LIMITS", limits))

    assert f"slide from the start, {words}." in files["examples/Smallest/Smallest.ino"]
    assert f"| slide from the start, {words}: where to begin |" in files["README.md"]


@pytest.mark.parametrize(
    ("limits", "line"),
    [
        ("low: D9", "- Pin D9 (low end): an input for the limit switch of slide.\n"),
        (
            "low: D9, high: D10",
            "- Pins D9 (low end) and D10 (high end): inputs for the limit switches of slide.\n",
        ),
    ],
)
def test_the_readme_names_the_pins_of_switches(generate: Generate, limits: str, line: str) -> None:
    """
    Among what the library takes, and in the table of the wiring.
    """
    readme = generate(SLIDE.replace("LIMITS", limits))["README.md"]

    assert line in readme
    assert "\n| low end | D9 | PB1 |\n" in readme

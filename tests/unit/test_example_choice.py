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

"""
More flash or RAM than the board has: no spec can demand it, and what does not fit is refused.

What a spec can ask for at most is bounded by the chip's timers and their compare channels, a motor
each, by tables of 256 bytes and by ramps of 65 000 steps: `stepgen check` has nothing to refuse.
The sizes are compared with the board's whenever something is compiled.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType

import pytest
from typer.testing import CliRunner

from stepgen.cli import app
from stepgen.devices import Board, Timer16, boards
from stepgen.verify import arduino_core
from stepgen.verify.recipes import board_properties
from stepgen.verify.toolchain import Target, default_compiler
from tests.compile.test_sizes import SPECS, everything_in_use

_PATTERNS = ("1000", "0100", "0010", "0001")
_MOST_PATTERNS = 32
# One board of each chip, limit and set of pins: the others of its kind have the very same sizes.
KINDS = {
    (
        board.mcu.name,
        board_properties(Target.from_fqbn(board.fqbn))["upload.maximum_size"],
        tuple(pin.bit for pin in board.pins),
    ): board
    for board in boards()
}
_CHANGING = "motion: {kind: update-events, debug: true}"
# A long table: of nearly the 255 rows that a byte counts.
_RAMP = "motion: {kind: trapezoid, cruise_speed: 450, acceleration: 2, queue: 16}"
_RAMP_OPTIONS = "steps_per_turn: 200"
_OPTIONS = "steps_per_turn: 200, steps_per_mm: 157.48, command_timeout_ms: 1000"


def largest(board: Board) -> list[str]:
    """
    Return specs with all that takes memory: a motor for each 16-bit timer, and for each channel.

    Beside compare channels on so many motors, update events are refused: the motors of each timer
    have them, those of each channel move at constant speed. With them goes timer 2.
    """
    wide = [timer for timer in board.mcu.timers if isinstance(timer, Timer16)]
    changing = [f"timer: {timer.number}, {_CHANGING}" for timer in wide]
    narrow = [f"timing: {{kind: compare, timer: {timer.number}}}" for timer in board.mcu.timers8]
    return [_spec(board, changing), _spec(board, channels(board) + narrow)]


def largest_with_ramps(board: Board) -> list[str]:
    """
    Return specs with an axis for each channel: with coils as far as there are pins, with drivers.
    """
    axes = [f"{channel}, {_RAMP}" for channel in channels(board)]
    return [_spec(board, axes), _with_drivers(board, axes)]


def channels(board: Board) -> list[str]:
    """
    Return the timing of a motor on each compare channel.
    """
    return [
        f"timing: {{kind: compare, timer: {timer.number}, channel: {channel}}}"
        for timer in board.mcu.timers
        if isinstance(timer, Timer16)
        for channel in timer.compare_channels
    ]


def _spec(board: Board, motors: Sequence[str]) -> str:
    """
    Return a spec of *motors*, as many as there are pins for, each with the longest table.
    """
    lines = [f"library: Largest\nboard: {board.name}\nwatchdog_ms: 250\nmotors:"]
    for number, more in enumerate(motors):
        pins = board.pins[number :: len(motors)][:4]
        if len(pins) < len(_PATTERNS):
            break
        ports = len({pin.bit.port for pin in pins})
        most = min(_MOST_PATTERNS, 256 // (4 * ports))
        patterns = _PATTERNS * (most // len(_PATTERNS))
        drive = (
            f"{{kind: four-wire, pins: [{', '.join(pin.label for pin in pins)}], "
            f"sequence: [{', '.join(repr(each) for each in patterns)}]}}"
        )
        options = _RAMP_OPTIONS if _RAMP in more else _OPTIONS
        lines.append(f"  motor{number}: {{drive: {drive}, {more}, {options}}}")
    return "\n".join(lines) + "\n"


def _with_drivers(board: Board, motors: Sequence[str]) -> str:
    """
    Return a spec of *motors*, each with a driver chip, for which there are pins enough.
    """
    lines = [f"library: Largest\nboard: {board.name}\nwatchdog_ms: 250\nmotors:"]
    for number, more in enumerate(motors):
        step, turn = (pin.label for pin in board.pins[2 * number + 2 :][:2])
        drive = f"{{kind: step-dir, step: {step}, dir: {turn}, driver: a4988}}"
        lines.append(f"  motor{number}: {{drive: {drive}, {more}, {_RAMP_OPTIONS}, at_rest: hold}}")
    return "\n".join(lines) + "\n"


def left(board: Board, texts: Sequence[str], folder: Path) -> float:
    """
    Return how much of flash or of RAM is left on *board*, whichever is less, by each of *texts*.

    All is counted: every function in use, and the Arduino core.
    """
    limits = board_properties(Target.from_fqbn(board.fqbn))
    least = 1.0
    for number, text in enumerate(texts):
        place = folder / str(number)
        place.mkdir()
        path = place / "largest.yaml"
        path.write_text(text, encoding="utf-8")
        made = everything_in_use(path, default_compiler(), place)
        flash = made.flash_bytes / int(limits["upload.maximum_size"])
        ram = made.ram_bytes / int(limits["upload.maximum_data_size"])
        least = min(least, 1 - flash, 1 - ram)
    return least


@pytest.mark.parametrize("board", KINDS.values(), ids=lambda board: str(board.name))
def test_the_largest_library_leaves_a_fifth_of_the_board(board: Board, tmp_path: Path) -> None:
    """
    With every function in use and the Arduino core more than a fifth of flash and of RAM is left.
    """
    assert left(board, largest(board), tmp_path) > 1 / 5


@pytest.mark.parametrize("board", KINDS.values(), ids=lambda board: str(board.name))
def test_an_axis_on_each_channel_fits_the_board(board: Board, tmp_path: Path) -> None:
    """
    Each with a long ramp and queue, and every function in use: a twentieth at least is left.
    """
    assert left(board, largest_with_ramps(board), tmp_path) > 1 / 20


@pytest.mark.parametrize("kind", ["upload.maximum_size", "upload.maximum_data_size"])
@pytest.mark.parametrize("command", ["verify", "simulate", "datasheet"])
def test_what_does_not_fit_is_refused_in_words(
    command: str, kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """
    On a board with 100 bytes: exit code 2, bytes needed and there, a way out; nothing is written.
    """

    def small(target: Target) -> Mapping[str, str]:
        return MappingProxyType({**board_properties(target), kind: "100"})

    monkeypatch.setattr(arduino_core, "board_properties", small)
    monkeypatch.setenv("STEPGEN_CACHE", str(tmp_path / "cache"))
    monkeypatch.chdir(tmp_path)
    more = ["--verify"] if command == "datasheet" else []

    result = CliRunner().invoke(app, [command, str(SPECS / "uno_motor_shield.yaml"), *more])

    words = " ".join(result.output.split())
    assert result.exit_code == 2, words
    what = "flash" if kind == "upload.maximum_size" else "RAM"
    assert f"bytes of {what} with its library, and arduino:avr:uno has 100; give" in words
    assert "Traceback" not in words
    assert [path.name for path in tmp_path.iterdir()] == ["cache"]

"""
More flash or RAM than the board has: few specs can demand it, and what does is refused.

What a spec can ask for at most is bounded by the chip's timers and their compare channels, a motor
each, and by tables of 256 bytes: without ramps `stepgen check` has nothing to refuse. The sizes are
compared with the board's whenever something is compiled.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType

import pytest
from typer.testing import CliRunner

from stepgen.cli import app
from stepgen.devices import Board, Timer16, boards
from stepgen.errors import StepgenError
from stepgen.verify import arduino_core
from stepgen.verify.recipes import board_properties
from stepgen.verify.toolchain import Target, default_compiler
from tests.compile.test_sizes import SPECS, everything_in_use

_PATTERNS = ("1000", "0100", "0010", "0001")
_MOST_PATTERNS = 32
_ROOM = 5  # of the board's memory the largest library leaves more than a fifth
_CHANGING = "motion: {kind: update-events, debug: true}"
_OPTIONS = "steps_per_turn: 200, steps_per_mm: 157.48, command_timeout_ms: 1000"


def largest(board: Board) -> list[str]:
    """
    Return specs with all that takes memory: a motor for each 16-bit timer, and for each channel.

    Beside compare channels on so many motors, update events are refused: the motors of each timer
    have them, those of each channel move at constant speed. With them goes timer 2.
    """
    wide = [timer for timer in board.mcu.timers if isinstance(timer, Timer16)]
    changing = [f"timer: {timer.number}, {_CHANGING}" for timer in wide]
    channels = [
        f"timing: {{kind: compare, timer: {timer.number}, channel: {channel}}}"
        for timer in wide
        for channel in timer.compare_channels
    ]
    narrow = [f"timing: {{kind: compare, timer: {timer.number}}}" for timer in board.mcu.timers8]
    return [_spec(board, changing), _spec(board, channels + narrow)]


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
        lines.append(f"  motor{number}: {{drive: {drive}, {more}, {_OPTIONS}}}")
    return "\n".join(lines) + "\n"


@pytest.mark.parametrize("board", boards(), ids=lambda board: board.name)
def test_the_largest_library_leaves_a_fifth_of_the_board(board: Board, tmp_path: Path) -> None:
    """
    With every function in use and the Arduino core more than a fifth of flash and of RAM is left.
    """
    for number, text in enumerate(largest(board)):
        folder = tmp_path / str(number)
        folder.mkdir()
        path = folder / "largest.yaml"
        path.write_text(text, encoding="utf-8")

        made = everything_in_use(path, default_compiler(), folder)

        limits = board_properties(Target.from_fqbn(board.fqbn))
        for taken, limit in (
            (made.flash_bytes, int(limits["upload.maximum_size"])),
            (made.ram_bytes, int(limits["upload.maximum_data_size"])),
        ):
            assert taken * _ROOM < limit * (_ROOM - 1)


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


def test_axes_that_do_not_fit_are_refused_in_words(tmp_path: Path) -> None:
    """
    Six axes with every function in use are more than a Leonardo has flash; the message says so.
    """
    lines = ["library: Largest\nboard: leonardo\nmotors:"]
    channels = ((timer, channel) for timer in (1, 3) for channel in "ABC")
    for number, (timer, channel) in enumerate(channels):
        lines.append(
            f"  axis{number}: {{drive: {{kind: step-dir, step: D{2 * number + 2}, "
            f"dir: D{2 * number + 3}, driver: a4988}}, timing: {{kind: compare, timer: {timer}, "
            f"channel: {channel}}}, motion: {{kind: trapezoid, cruise_speed: 300, "
            "acceleration: 100, queue: 16}, at_rest: hold}"
        )
    path = tmp_path / "largest.yaml"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")

    with pytest.raises(StepgenError, match=r"bytes of flash with its library, and .* has 28672"):
        everything_in_use(path, default_compiler(), tmp_path)

"""
More flash or RAM than the board has: no spec can demand it today, and what would is refused.

What a spec can ask for at most is bounded by the timers of the chip, a motor each, and by tables
of 256 bytes: `stepgen check` has nothing to refuse. The sizes are still compared with the board's
whenever something is compiled.
"""

from collections.abc import Mapping
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

# On a Mega each motor has four ports, with as many patterns as then fit; on the others there are
# three ports.
_LONGEST = {
    4: '["1000", "0100", "0010", "0001"' + ', "1000", "0100", "0010", "0001"' * 3 + "]",
    3: '["1000", "0100", "0010", "0001"' + ', "1000", "0100", "0010", "0001"' * 4 + "]",
}
_MEGA_PINS = ("D22, D37, D49, A8", "D23, D36, D48, A9", "D24, D35, D47, A10", "D25, D34, D46, A11")
_SMALL_PINS = ("D2, D8, A0, A1", "D3, D9, A2, A3")
_ROOM = 2  # of the board's memory all motors together take less than half
_OPTIONS = "steps_per_turn: 200, steps_per_mm: 157.48, command_timeout_ms: 1000"


_CHANGING = "motion: {kind: update-events, debug: true}"
_TIMER_2 = "timing: {kind: compare, timer: 2}"


def largest(board: Board) -> list[str]:
    """
    Return specs with a motor on each timer and with all that takes memory.

    Beside timer 2 update events are refused: one spec has them, another two motors.
    """
    wide = sum(isinstance(timer, Timer16) for timer in board.mcu.timers)
    if wide == len(_MEGA_PINS):
        return [_spec(board, 4, dict.fromkeys(_MEGA_PINS, _CHANGING))]
    first, second = _SMALL_PINS
    if wide == len(_SMALL_PINS):
        return [_spec(board, 3, {first: _CHANGING, second: _CHANGING})]
    return [
        _spec(board, 3, {first: _CHANGING}),
        _spec(board, 3, {first: "motion: constant", second: _TIMER_2}),
    ]


def _spec(board: Board, ports: int, motors: Mapping[str, str]) -> str:
    lines = [f"library: Largest\nboard: {board.name}\nmotors:"]
    for number, (wires, more) in enumerate(motors.items()):
        drive = f"{{kind: four-wire, pins: [{wires}], sequence: {_LONGEST[ports]}}}"
        lines.append(f"  motor{number}: {{drive: {drive}, {more}, {_OPTIONS}}}")
    return "\n".join(lines) + "\n"


@pytest.mark.parametrize("board", boards(), ids=lambda board: board.name)
def test_the_largest_library_leaves_half_of_the_board(board: Board, tmp_path: Path) -> None:
    """
    With every function in use and the Arduino core it takes less than half of flash and of RAM.
    """
    for number, text in enumerate(largest(board)):
        folder = tmp_path / str(number)
        folder.mkdir()
        path = folder / "largest.yaml"
        path.write_text(text, encoding="utf-8")

        made = everything_in_use(path, default_compiler(), folder)

        limits = board_properties(Target.from_fqbn(board.fqbn))
        assert made.flash_bytes * _ROOM < int(limits["upload.maximum_size"])
        assert made.ram_bytes * _ROOM < int(limits["upload.maximum_data_size"])


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

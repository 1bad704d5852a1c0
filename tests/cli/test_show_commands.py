"""
``stepgen boards`` and ``stepgen plan``, the help texts, and the rest of the command line.
"""

import json
import os
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from stepgen import __version__
from stepgen.devices import boards

SPECS = Path(__file__).parents[2] / "specs"
Stepgen = Callable[..., Any]

GEARED = """
library: Gear
board: uno
motors:
  pan:
    drive: {kind: four-wire, pins: [2, 3, 4, 5]}
    steps_per_turn: {full_steps: 32, gear: 1/3}
"""


def test_boards_lists_every_board(stepgen: Stepgen) -> None:
    """
    Every board has a row that begins with its name.
    """
    run = stepgen("boards")

    assert run.code == 0
    assert all(
        re.search(rf"^{board.name} .*{board.mcu.title}", run.out, re.MULTILINE)
        for board in boards()
    )


@pytest.mark.parametrize("name", [board.name for board in boards()])
def test_a_board_fits_a_pipe(stepgen: Stepgen, name: str) -> None:
    """
    Pins, timers and libraries are all there, uncut, within 80 columns and without colours.
    """
    run = stepgen("boards", name)

    board = next(board for board in boards() if board.name == name)
    assert run.code == 0
    assert max(map(len, run.out.splitlines())) <= 80
    assert "…" not in run.out
    assert "\x1b" not in run.out
    for pin in board.pins:
        assert re.search(
            rf"^{pin.label} +{pin.bit.name} +{', '.join((*pin.also, *pin.uses))}",
            run.out,
            re.MULTILINE,
        )
    for label in board.analog_inputs:
        assert re.search(rf"^{label} +- +analog input only", run.out, re.MULTILINE)
    assert all(timer.ovf.name in run.out for timer in board.mcu.timers)


def test_the_uno_is_described(stepgen: Stepgen) -> None:
    """
    Timer 1 of the Uno: D9 and D10, its vectors, and the Servo library that takes it. Timer 2: tone.

    Source: ATmega328P datasheet, table of vectors; Arduino Uno pinout; Servo library.
    """
    out = stepgen("boards", "uno").out

    assert re.search(r"^1 +16 +A D9 \(PB1\) +D8 \(PB0\) +TIMER1_OVF_vect +Servo", out, re.MULTILINE)
    assert re.search(r"^2 +8 +A D11 \(PB3\) +TIMER2_OVF_vect +tone", out, re.MULTILINE)
    assert re.search(r"^B +0x23 +0x24 +0x25 +D8, D9, D10, D11, D12, D13", out, re.MULTILINE)


def test_an_unknown_board_is_a_message(stepgen: Stepgen) -> None:
    """
    An unknown board is exit code 2, and the known ones are named.
    """
    run = stepgen("boards", "due")

    assert (run.code, run.out) == (2, "")
    assert re.match("error: due: is no board that stepgen knows; choose one of .*uno", run.err)


def test_tables_work_without_unicode(tmp_path: Path) -> None:
    """
    Where the output's encoding is ASCII, so are the tables.
    """
    command = [sys.executable, "-m", "stepgen", "boards", "uno"]
    environment = {**os.environ, "PYTHONIOENCODING": "ascii"}
    done = subprocess.run(
        command, cwd=tmp_path, env=environment, capture_output=True, check=True, timeout=60
    )

    assert done.stdout.isascii()
    assert done.stderr == b""


def test_a_closed_pipe_is_no_traceback(tmp_path: Path) -> None:
    """
    `stepgen boards mega | head -1` ends quietly, and so does a full disk behind stdout.
    """
    command = f"{sys.executable} -m stepgen boards mega"
    closed = subprocess.run(
        ["bash", "-c", f"{command} | head -1"],
        cwd=tmp_path,
        capture_output=True,
        check=True,
        timeout=60,
    )
    full = subprocess.run(
        ["bash", "-c", f"{command} > /dev/full"],
        cwd=tmp_path,
        capture_output=True,
        check=False,
        timeout=60,
    )

    assert closed.stderr == b""
    assert full.returncode == 2
    assert full.stderr == b"error: the system refuses: No space left on device\n"


def test_a_plan_shows_the_numbers(stepgen: Stepgen, pan: Path) -> None:
    """
    The wires, the timer and the range of periods can be read off.
    """
    run = stepgen("plan", pan.name)

    assert run.code == 0
    assert max(map(len, run.out.splitlines())) <= 80
    assert "DIR A: D12 (PB4)" in run.out
    assert "TIMER1_OVF_vect" in run.out
    # 65535 ticks * 1024 at 16 MHz: 67107840 / 16 us.
    assert "67107840 cycles = 4194240 us" in run.out
    assert "homing" not in run.out


def test_a_plan_shows_the_limits(stepgen: Stepgen) -> None:
    """
    Switches, range and homing as the spec has them, at 80 steps in a millimetre.
    """
    run = stepgen("plan", str(SPECS / "uno_homing.yaml"))
    rows = dict(
        re.split(r" {2,}", line, maxsplit=1) for line in run.out.splitlines() if "  " in line
    )

    assert rows["low end"].strip() == "D9 (PB1), LOW when pressed, pulled up by the chip"
    assert rows["high end"].strip() == "D10 (PB2), HIGH when pressed, pulled up by the chip"
    assert rows["range"].strip() == "0 to 14400 steps: 0 to 180 mm"
    assert rows["homing"].startswith("to the low switch at 2400 steps/s, for 17600 steps at most;")
    assert rows["home"].strip() == "the switch is position -80; rest at 0"


def test_a_plan_as_json_is_stable(stepgen: Stepgen, tmp_path: Path) -> None:
    """
    The JSON has the plan's own names as keys, exact fractions, and is the same on every run.
    """
    (tmp_path / "a.yaml").write_text(GEARED)

    run = stepgen("plan", "a.yaml", "--json")

    dumped = json.loads(run.out)
    motor = dumped["motors"][0]
    assert run.out == stepgen("plan", "a.yaml", "--json").out
    assert dumped["library"]["name"] == "Gear"
    assert dumped["board"]["mcu"] == "atmega328p"
    assert motor["steps_per_turn"]["denominator"] == 3
    assert [wire["pin"]["bit"] for wire in motor["drive"]["wires"]] == ["PD2", "PD3", "PD4", "PD5"]
    assert motor["kernel"]["kind"] == "ring"
    assert motor["timing"]["timer"]["tcnt"] == {"name": "TCNT1", "address": 0x84}


@pytest.mark.parametrize("command", ["boards", "check", "plan", "generate"])
def test_help_has_an_example(stepgen: Stepgen, command: str) -> None:
    """
    Every command explains itself with an example.
    """
    run = stepgen(command, "--help")

    assert run.code == 0
    assert f"Example: stepgen {command} " in run.out


@pytest.mark.parametrize("arguments", [(), ("nothing",), ("--nothing",), ("plan",), ("check",)])
def test_wrong_use_is_exit_code_2(stepgen: Stepgen, arguments: tuple[str, ...]) -> None:
    """
    No command, an unknown one and a missing argument are wrong use.
    """
    assert stepgen(*arguments).code == 2


def test_the_version_is_told(stepgen: Stepgen) -> None:
    """
    --version prints the version of the package.
    """
    run = stepgen("--version")

    assert (run.code, run.out) == (0, f"stepgen {__version__}\n")


@pytest.mark.parametrize("command", ["check", "generate"])
def test_what_is_slow_to_import_waits_until_it_is_needed(pan: Path, command: str) -> None:
    """
    One spec is checked or generated without rich, without verification and what that needs.

    Rich alone takes as long to import as a library to generate. `make benchmark` measures the time.
    """
    slow = ("rich", "numpy", "cffi", "elftools", "z3", "stepgen.verify", "stepgen.reference")
    code = (
        "import sys; from stepgen.cli import app\n"
        "try: app()\nexcept SystemExit: pass\n"
        f"print('slow:', *sorted(name for name in {slow} if name in sys.modules))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, command, pan.name],
        cwd=pan.parent,
        capture_output=True,
        check=True,
        text=True,
        timeout=60,
    )

    assert done.stdout.endswith("slow:\n")


@pytest.mark.parametrize(
    ("typed", "completed"),
    [
        ("stepgen da", "datasheet"),
        ("stepgen ma", "matrix"),
        ("stepgen generate --fo", "--force"),
        ("stepgen simulate --pl", "--plot"),
    ],
)
def test_the_shell_completes_commands_and_options(typed: str, completed: str) -> None:
    """
    After `stepgen --install-completion` a shell asks stepgen how a word goes on.
    """
    done = subprocess.run(
        [Path(sys.executable).parent / "stepgen"],
        env=os.environ
        | {
            "_STEPGEN_COMPLETE": "complete_bash",
            "COMP_WORDS": typed,
            "COMP_CWORD": str(typed.count(" ")),
        },
        capture_output=True,
        check=False,
        encoding="utf-8",
        timeout=60,
    )

    assert done.stdout.split() == [completed]

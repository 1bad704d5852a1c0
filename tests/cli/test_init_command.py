"""
``stepgen init``: a first spec from options, from defaults, and from answers.
"""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from stepgen import api
from stepgen.draft import Draft, drive_kinds, possible_timers, questions

Stepgen = Callable[..., Any]


def test_without_options_it_writes_the_first_motor(stepgen: Stepgen, tmp_path: Path) -> None:
    """
    Outside a terminal every question has its default, and the spec is fine.
    """
    run = stepgen("init")

    assert run.code == 0
    plan = api.plan(tmp_path / "motor.yaml")
    assert (plan.board.name, plan.library.name) == ("uno", "MyMotor")
    assert plan.motors[0].timing.timer.number == 1


def test_options_say_what_the_spec_holds(stepgen: Stepgen, tmp_path: Path) -> None:
    """
    Each option reaches the spec; Servo has timer 1, so the motor gets timer 2 by itself.
    """
    run = stepgen(
        *("init", "fan.yaml", "--library", "Fan", "--motor", "fan", "--uses", "Servo D9, Serial"),
        *("--pins", "D4 D5 D6 D7", "--sequence", "half", "--steps-per-turn", "32"),
        *("--at-rest", "hold"),
    )

    assert run.code == 0, run.err
    plan = api.plan(tmp_path / "fan.yaml")
    (motor,) = plan.motors
    assert plan.uses == ("Servo D9", "Serial")
    assert (motor.name, motor.drive.kind) == ("fan", "four-wire")
    assert motor.steps_per_turn == 64  # half steps
    assert (motor.timing.kind, motor.timing.timer.number) == ("compare", 2)
    assert not motor.releases_at_rest


def test_a_motor_with_ramps_gets_a_channel_and_speeds_to_change(
    stepgen: Stepgen, tmp_path: Path
) -> None:
    """
    Where no timer is asked for it is one that the motion can run on, though others are first.
    """
    run = stepgen("init", "slide.yaml", "--motion", "trapezoid")

    assert run.code == 0, run.err
    (motor,) = api.plan(tmp_path / "slide.yaml").motors
    assert (motor.motion.kind, motor.timing.kind, motor.timing.channel) == (
        *("trapezoid", "compare", "A"),
    )
    assert motor.wish_steps_per_second == 1000


def test_every_line_has_a_comment_and_stays_short(stepgen: Stepgen, tmp_path: Path) -> None:
    """
    A newcomer reads in the file what each line is for.
    """
    stepgen("init", "a.yaml")

    lines = (tmp_path / "a.yaml").read_text(encoding="utf-8").splitlines()
    assert all("# " in line for line in lines if line != "motors:")
    assert max(map(len, lines)) <= 110


def test_what_is_not_possible_is_refused_and_not_written(stepgen: Stepgen, tmp_path: Path) -> None:
    """
    The reason is that of `stepgen check`, with the line of the spec that was not written.
    """
    run = stepgen("init", "a.yaml", "--timer", "3")

    assert run.code == 2
    assert "a.yaml:9:" in run.err
    assert "the Arduino Uno has no 16-bit timer 3" in run.err
    assert not (tmp_path / "a.yaml").exists()


def test_a_file_that_is_there_stays(stepgen: Stepgen, pan: Path) -> None:
    """
    Only --force overwrites it.
    """
    before = pan.read_text(encoding="utf-8")

    assert stepgen("init", pan).code == 2
    assert pan.read_text(encoding="utf-8") == before
    assert stepgen("init", pan, "--force").code == 0
    assert pan.read_text(encoding="utf-8") != before


def test_it_asks_and_offers_what_is_possible(tmp_path: Path) -> None:
    """
    Beside Servo a Mega has no timer 5 and no vector for CTC; Enter takes what is in brackets.
    """
    answers = ["Fan", "mega", "Servo", "fan", "four-wire", "A8, A9, A10, A11", "", "", "", ""]
    done = subprocess.run(
        [sys.executable, "-m", "stepgen", "init", "--ask", "fan.yaml"],
        cwd=tmp_path,
        input="\n".join(answers) + "\n",
        capture_output=True,
        encoding="utf-8",
        check=False,
        timeout=60,
    )

    assert done.returncode == 0, done.stderr
    shown = done.stderr.replace("\n", "")
    assert "[fast-pwm:1/fast-pwm:3/fast-pwm:4/compare:2]" in shown
    plan = api.plan(tmp_path / "fan.yaml")
    assert [wire.pin.label for wire in plan.motors[0].drive.wires] == ["A8", "A9", "A10", "A11"]


def test_an_unanswered_question_writes_nothing(tmp_path: Path) -> None:
    """
    The end of the input is no answer.
    """
    done = subprocess.run(
        [sys.executable, "-m", "stepgen", "init", "--ask"],
        cwd=tmp_path,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        encoding="utf-8",
        check=False,
        timeout=60,
    )

    assert done.returncode == 2
    assert "error: Name of the library: no answer came" in done.stderr
    assert list(tmp_path.iterdir()) == []


ANSWERS = {
    "four-wire": ["4 5 6 7"],
    "motor-shield": [],
    "step-dir": ["a4988", "cnc-shield X", "", "", "", "16"],
}


@pytest.mark.parametrize("drive", drive_kinds())
def test_a_spec_with_each_drive_can_be_asked_for(drive: str, tmp_path: Path) -> None:
    """
    The questions of a drive say what they are for, and are enough for a spec that is fine.
    """
    assert all(question.text and question.text != "None" for question in questions(drive))
    answers = ["Fan", "uno", "", "fan", drive, *ANSWERS[drive], "", "", "", ""]
    done = subprocess.run(
        [sys.executable, "-m", "stepgen", "init", "--ask", "fan.yaml"],
        cwd=tmp_path,
        input="\n".join(answers) + "\n",
        capture_output=True,
        encoding="utf-8",
        check=False,
        timeout=300,
    )

    assert done.returncode == 0, done.stderr
    assert api.plan(tmp_path / "fan.yaml").motors[0].drive.kind == drive


def test_fields_of_a_drive_are_options_too(stepgen: Stepgen, tmp_path: Path) -> None:
    """
    What has no option of its own is given by its name in the spec.
    """
    run = stepgen(
        *("init", "a.yaml", "--drive", "step-dir", "--field", "driver=drv8825"),
        *("--field", "step=D2", "--field", "dir=D5", "--field", "microsteps=32"),
        *("--at-rest", "hold"),
    )

    assert run.code == 0, run.err
    assert api.plan(tmp_path / "a.yaml").motors[0].steps_per_turn == 6400
    assert stepgen("init", "b.yaml", "--field", "driver").code == 2


def test_only_valid_timers_are_offered() -> None:
    """
    Each offered timer makes a spec that is fine: an Uno has 1 and 2, with tone() only 1.
    """
    every = (("fast-pwm", 1), ("ctc", 1), ("compare", 1), ("compare", 2))
    assert possible_timers(Draft()) == every
    assert possible_timers(Draft(uses=("tone D8",), drive="four-wire")) == ()
    four = Draft(uses=("tone D8",), drive="four-wire", drive_fields=(("pins", [4, 5, 6, 7]),))
    assert possible_timers(four) == (("fast-pwm", 1), ("ctc", 1), ("compare", 1))

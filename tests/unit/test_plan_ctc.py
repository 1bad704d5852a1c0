"""
Timing ctc: which timer and vector it takes, and how it stands beside fast PWM.
"""

from pathlib import Path

import pytest

from stepgen import api
from stepgen.errors import StepgenError

SPEC = """
library: Mine
board: {board}
motors:
  a: {{drive: motor-shield, timing: {timing}}}
"""
BOTH = """
library: Mine
board: mega
motors:
  a: {drive: motor-shield, timing: {kind: ctc, timer: 3}}
  b: {drive: {kind: four-wire, pins: [D22, D23, D24, D25]}, timing: {kind: fast-pwm, timer: 4}}
"""


def _spec(folder: Path, text: str) -> Path:
    path = folder / "spec.yaml"
    path.write_text(text, encoding="utf-8")
    return path


def test_its_steps_come_from_compare_match_a(tmp_path: Path) -> None:
    """
    In CTC mode the counter starts again at OCRnA, which raises that flag and not the overflow's.
    """
    path = _spec(tmp_path, SPEC.format(board="uno", timing="ctc"))
    (motor,) = api.plan(path).motors

    assert motor.timing.vector == "TIMER1_COMPA_vect"
    assert "TCCR1B = _BV(WGM12) | next.select" in api.render(path)["src/Mine.cpp"]


def test_its_range_is_that_of_fast_pwm(tmp_path: Path) -> None:
    """
    The same prescalers and ticks, so that a sketch can change over.
    """
    plans = [
        api.plan(_spec(tmp_path, SPEC.format(board="uno", timing=timing)))
        for timing in ("ctc", "fast-pwm")
    ]

    ranges = [(plan.minimum_period_cycles, plan.largest_period_cycles) for plan in plans]
    assert ranges[0] == ranges[1]


def test_a_timer_of_8_bits_is_refused(tmp_path: Path) -> None:
    """
    Timer 2 has too few bits, and the message says what there is.
    """
    path = _spec(tmp_path, SPEC.format(board="uno", timing="{kind: ctc, timer: 2}"))

    with pytest.raises(StepgenError, match="ctc runs on timer 1"):
        api.plan(path)


def test_both_timings_in_one_library_share_what_is_the_same(tmp_path: Path) -> None:
    """
    Settings and the struct of a motion are there once.
    """
    source = api.render(_spec(tmp_path, BOTH))["src/Mine.cpp"]

    assert source.count("SHARED Setting chooseSetting(") == 1
    assert source.count("struct ConstantMotion {") == 1
    assert "WGM32" in source
    assert "WGM43" in source

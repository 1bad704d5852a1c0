"""
STEP, DIR and ENABLE at the pins: a driver that wakes up slowly, DIR between two steps, the judges.
"""

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest

from stepgen import api
from stepgen.devices import DRIVERS, PulseTimes
from stepgen.reference.pulses import PulseFacts
from stepgen.verify import pulses
from stepgen.verify.bench import Call, CallKind, Loop
from stepgen.verify.firmware import build_firmware
from stepgen.verify.runner import Outcome, run_scenario
from stepgen.verify.scenarios import BACK, DRIVE, Action, Scenario, Wait
from stepgen.verify.toolchain import default_compiler

SPEC = """
library: Mine
board: {board}
motors:
  motor:
    drive: {{kind: step-dir, driver: {driver}, {pins}}}
    timing: {timing}
    motion: {motion}
"""
NEAR = "step: D2, dir: D5, enable: D8"  # an Uno's ports D and B: SBI and CBI reach them
FAR = "step: D46, dir: D48, enable: {pin: D62, active: high}"  # a Mega's ports L and K: they do not
SECOND = 16_000_000
DM542T_ENABLE_CYCLES = SECOND // 5  # 200 ms
A4988 = PulseFacts(16, 32, 16, 4, 4, 4, enabled_level=False)


def _run(folder: Path, actions: list[Action], **spec: str) -> Outcome:
    path = folder / "spec.yaml"
    path.write_text(SPEC.format(**spec), encoding="utf-8")
    plan = api.plan(path)
    firmware = build_firmware(plan, path.read_text(encoding="utf-8"), default_compiler())
    scenario = Scenario("pulses", Loop.BUSY, tuple(actions))
    return run_scenario(api.load(path), plan, firmware.bench, scenario)


def _changes(outcome: Outcome, port: str, bit: int) -> list[tuple[int, int]]:
    """
    Return each change of a pin after the first call, with its new level.
    """
    first = outcome.answers[0].begin_cycle
    levels = [(0, 0)]
    levels += [
        (state.cycle, state.value >> bit & 1) for state in outcome.trace.ports if state.port == port
    ]
    return [
        after for before, after in pairwise(levels) if before[1] != after[1] and after[0] > first
    ]


@pytest.mark.parametrize(
    ("timing", "motion"),
    [
        ("fast-pwm", "constant"),
        ("fast-pwm", "update-events"),
        ("ctc", "constant"),
        ("ctc", "update-events"),
        ("compare", "constant"),
    ],
)
def test_a_driver_that_wakes_up_slowly_gets_its_time(
    tmp_path: Path, timing: str, motion: str
) -> None:
    """
    The first step comes 200 ms after ENABLE and soon after that, the second an interval later.
    """
    actions: list[Action] = [
        Call(CallKind.SET_SPEED, control=DRIVE, top=20_000, limit=3),
        Wait(DM542T_ENABLE_CYCLES + 100_000),
        Call(CallKind.SET_SPEED, control=BACK, top=40_000, limit=2),
        Wait(1_000_000),
        Call(CallKind.SET_SPEED, control=DRIVE, top=20_000),  # while it wakes up
        Wait(DM542T_ENABLE_CYCLES + 100_000),
        Call(CallKind.READ),
    ]
    outcome = _run(
        tmp_path, actions, board="uno", driver="dm542t", pins=NEAR, timing=timing, motion=motion
    )

    assert outcome.findings == ()
    (enabled, _), *_ = _changes(outcome, "B", 0)
    rises = [cycle for cycle, level in _changes(outcome, "D", 2) if level]
    assert DM542T_ENABLE_CYCLES <= rises[0] - enabled <= DM542T_ENABLE_CYCLES + 4_000
    assert abs(rises[1] - rises[0] - 20_000) <= 100


@pytest.mark.parametrize(
    ("board", "pins", "bits"),
    [("uno", NEAR, ("D", 2, 5)), ("mega", FAR, ("L", 3, 1))],
)
@pytest.mark.parametrize("driver", ["a4988", "tmc2209", "tb6600"])
def test_dir_keeps_its_distance_though_a_step_is_due(
    tmp_path: Path, driver: str, board: str, pins: str, bits: tuple[str, int, int]
) -> None:
    """
    The motor is turned round at each cycle around a step: before it, while it waits, after it.
    """
    actions: list[Action] = []
    for offset in range(0, 420, 3):
        actions += [
            Call(CallKind.SET_SPEED, control=DRIVE, top=2_048),
            Wait(3 * 2_048 - 300 + offset),
            Call(CallKind.SET_SPEED, control=BACK, top=2_048),
            Wait(2_048),
        ]
    outcome = _run(
        tmp_path, actions, board=board, driver=driver, pins=pins, timing="ctc", motion="constant"
    )

    assert outcome.findings == ()
    port, step, direction = bits
    rises = [cycle for cycle, level in _changes(outcome, port, step) if level]
    turns = [cycle for cycle, _ in _changes(outcome, port, direction)]
    nearest = min(abs(rise - turn) for turn in turns for rise in rises)
    assert len(turns) == 2 * 140 - 1
    assert nearest < 150  # the sweep did come near


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"step_high_ns": 300}, "cycles long, not 16 to"),
        ({"enable_ns": 0}, "no step interrupt"),
        ({"dir_hold_ns": 0, "dir_setup_ns": 0}, "DIR changes"),
    ],
)
def test_a_plan_with_wrong_times_is_caught(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, wrong: dict[str, int], words: str
) -> None:
    """
    The judge reads the driver's times by itself: what the planner makes too short it sees.
    """
    slow = PulseTimes(1_000, 1_000, 20_000, 20_000, 1_000_000)
    for module, times in (
        ("plan.drives.step_dir", replace(slow, **wrong)),
        ("reference.pulses", slow),
    ):
        chip = replace(DRIVERS["a4988"], times=times)
        monkeypatch.setattr(f"stepgen.{module}.DRIVERS", {"a4988": chip})
    actions: list[Action] = []
    for offset in range(0, 300, 10):
        actions += [
            Call(CallKind.SET_SPEED, control=DRIVE, top=2_048),
            Wait(20_000 + 3 * 2_048 - 150 + offset),
            Call(CallKind.SET_SPEED, control=BACK, top=2_048),
            Wait(2_048),
        ]
    outcome = _run(
        tmp_path,
        actions,
        board="uno",
        driver="a4988",
        pins=NEAR,
        timing="fast-pwm",
        motion="constant",
    )

    assert any(words in finding for finding in outcome.findings), outcome.findings


def test_the_judge_measures_widths() -> None:
    """
    An A4988's pulse has 16 cycles at least, the pause before the next as many.
    """
    good = [(100, True), (116, False), (132, True), (150, False)]
    short = [(100, True), (115, False), (131, True), (150, False)]
    close = [(100, True), (116, False), (131, True), (150, False)]
    long = [(100, True), (133, False)]

    assert list(pulses.wrong_widths(A4988, good)) == []
    assert len(list(pulses.wrong_widths(A4988, short))) == 1
    assert len(list(pulses.wrong_widths(A4988, close))) == 1
    assert len(list(pulses.wrong_widths(A4988, long))) == 1


@pytest.mark.parametrize(
    ("turn", "faults"), [(96, 0), (97, 1), (100, 1), (103, 1), (104, 0), (50, 0)]
)
def test_the_judge_measures_dir(turn: int, faults: int) -> None:
    """
    Four cycles before STEP rises at 100, and four after it.
    """
    assert len(list(pulses.wrong_directions(A4988, [(turn, True)], [100]))) == faults


def test_the_judge_wants_the_driver_enabled() -> None:
    """
    ENABLE is LOW for at least 4 cycles when STEP rises.
    """
    enable = [(10, True), (96, False), (150, True)]

    assert list(pulses.wrong_enables(A4988, enable, [100, 140])) == []
    assert len(list(pulses.wrong_enables(A4988, enable, [99, 151]))) == 2

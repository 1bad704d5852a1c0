"""
Timing compare on 16-bit timers: who gets which channel, and what its interrupt takes.
"""

from collections.abc import Callable
from dataclasses import replace

import pytest

from stepgen.plan.limits import Chip
from stepgen.plan.model import Plan
from stepgen.plan.timings import wide_compare
from stepgen.plan.waits import MainLine, Source, longest_wait

Planner = Callable[[str], Plan]
ULN = "{{kind: four-wire, pins: [{}]}}"
PINS = ("D4, D5, D6, D7", "A0, A1, A2, A3", "D8, D9, D10, D11", "D2, D3, A4, A5")
MEGA_PINS = tuple(f"{', '.join(f'D{n}' for n in range(k, k + 4))}" for k in range(2, 50, 4))
STEP_DIR = "{kind: step-dir, step: D2, dir: D5, enable: D8, driver: a4988, microsteps: 16}"


def _spec(board: str, pins: tuple[str, ...], timings: tuple[str, ...]) -> str:
    names = "abcdefghijkl"
    rows = [
        f"  {name}: {{drive: {ULN.format(four)}, timing: {timing}}}"
        for name, four, timing in zip(names, pins, timings, strict=False)
    ]
    return f"board: {board}\nmotors:\n" + "\n".join(rows) + "\n"


def _channels(plan: Plan) -> list[tuple[int, str]]:
    return [(motor.timing.timer.number, motor.timing.channel) for motor in plan.motors]


def test_without_a_timer_it_takes_timer_2_and_then_channels_of_the_next(planned: Planner) -> None:
    """
    Three motors on a Uno that ask for nothing more: its 8-bit timer, and both channels of timer 1.
    """
    plan = planned(_spec("uno", PINS, ("compare",) * 3))

    assert _channels(plan) == [(2, ""), (1, "A"), (1, "B")]


def test_what_names_a_channel_chooses_first(planned: Planner) -> None:
    """
    The one that only names the timer gets what is left of it.
    """
    wanted = ("{kind: compare, timer: 1}", "{kind: compare, timer: 1, channel: A}")

    assert _channels(planned(_spec("uno", PINS, wanted))) == [(1, "B"), (1, "A")]


def test_a_mega_has_channels_for_twelve_motors(planned: Planner) -> None:
    """
    Its timers 1, 3, 4 and 5 have three channels each.
    """
    timings = tuple(f"{{kind: compare, timer: {timer}}}" for timer in (1, 3, 4, 5) for _ in "ABC")
    plan = planned(_spec("mega", MEGA_PINS, timings))

    assert _channels(plan) == [(timer, name) for timer in (1, 3, 4, 5) for name in "ABC"]
    assert plan.motors[4].timing.vector == "TIMER3_COMPB_vect"


def test_its_interrupt_takes_sixty_cycles(planned: Planner) -> None:
    """
    By the instruction set manual, on an ATmega328P with STEP on port D.

    Response 4 and JMP 3; PUSH, IN, OUT 4; IN, DEC, OUT, BREQ 4; SBI 2. Then PUSH 2, the sum 14,
    OCR1AH, reload and OCR1AL 6; TCNT1 and the difference 8, POP 2, BRPL 1; IN, OUT, POP 4, CBI 2
    and RETI 4.
    """
    text = f"board: uno\nmotors:\n  m: {{drive: {STEP_DIR}, timing: {{kind: compare, timer: 1}}}}\n"
    path = planned(text).motors[0].hot_path

    assert path.usual_cycles == 7 + 4 + 4 + 2 + (2 + 14 + 6) + (8 + 2 + 1) + 4 + 2 + 4 == 60
    assert path.edge_cycles == 7 + 4 + 4 + 2


def test_an_interval_is_exact_to_the_clock() -> None:
    """
    Whatever the period: no prescaler, and nothing cut off.
    """
    assert wide_compare.choose_setting(1_000_003).period_cycles == 1_000_003


def test_steps_can_be_minutes_apart(planned: Planner) -> None:
    """
    As many seconds as the spec says, with a step interrupt as long as without.
    """
    text = f"board: uno\nmotors:\n  m: {{drive: {STEP_DIR}, timing: {{kind: compare, timer: 1"
    usual, slow = planned(text + "}}\n"), planned(text + ", longest_period_s: 300}}\n")

    assert usual.largest_period_cycles == 65_535 * 1024
    assert slow.largest_period_cycles == 300 * 16_000_000
    assert slow.motors[0].hot_path.usual_cycles == usual.motors[0].hot_path.usual_cycles


def test_a_short_longest_period_takes_nothing_away(planned: Planner) -> None:
    """
    5 s at 8 MHz are less than the 8.39 s that there are anyhow.
    """
    text = (
        f"board: pro-mini-8mhz\nmotors:\n  m: {{drive: {STEP_DIR}, "
        "timing: {kind: compare, timer: 1, longest_period_s: 5}}\n"
    )

    assert planned(text).largest_period_cycles == 65_535 * 1024


def test_its_interrupt_comes_with_each_step_or_lap() -> None:
    """
    From 32 768 clocks on, laps of 16 384 make an interval.
    """
    assert wide_compare.cadence(32_767).spacing_cycles == 32_767
    assert wide_compare.cadence(32_768).spacing_cycles == 16_384


def test_rare_ways_count_as_often_as_they_can_come() -> None:
    """
    Ten runs of 100 cycles, three of which take 50 more: a run's end, a move's and the coils'.
    """
    source = Source("step", 11, 100, 200, rare_cycles=50)

    assert source.total_cycles(10) == 10 * 100 + 3 * 50
    assert source.total_cycles(2) == 2 * 100 + 2 * 50
    assert source.total_cycles(64) == 64 * 100 + 5 * 50  # and after each 32 a call can come


def test_a_backlog_must_be_caught_up() -> None:
    """
    A motor that only just keeps up waits ever longer after one stretch with interrupts off.
    """
    own = Source("step", 11, 100, 101)
    main = MainLine(300, 4)

    assert longest_wait(own, wide_compare.LONGEST_WAIT_CYCLES, (), main) is None
    assert longest_wait(replace(own, spacing_cycles=300), 32_000, (), main) is not None


@pytest.mark.parametrize("board", ["uno", "mega"])
def test_beside_each_other_motors_are_slower(planned: Planner, board: str) -> None:
    """
    Each waits for the others: the proven rate falls with their number.
    """
    one = planned(_spec(board, PINS, ("{kind: compare, timer: 1}",)))
    two = planned(_spec(board, PINS, ("{kind: compare, timer: 1}",) * 2))

    assert one.minimum_period_cycles < two.minimum_period_cycles
    alone = Chip(two.board, two.motors[:1], (), two.masked_bound_cycles)
    assert alone.wait(two.motors[0], two.minimum_period_cycles) is not None

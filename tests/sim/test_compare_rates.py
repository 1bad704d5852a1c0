"""
How fast compare channels are at constant speed: rates at which no step is late, and what they cost.

The library is made to accept any rate for that: what it accepts by itself leaves room for calls.
"""

import pytest

from benchmarks.compare_rates import bench_plan, measure

# Board, motors on one of its timers, their period alone and beside millis, and the latest edge: an
# interrupt of millis (100 cycles) and of each other motor, the way to the edge, an instruction.
CRUISES = (
    ("uno", 1, 100, 160, 120),
    ("uno", 2, 200, 213, 200),
    ("mega", 3, 320, 369, 260),
)


@pytest.mark.parametrize(("board", "motors", "alone", "beside", "latest"), CRUISES)
def test_no_step_is_late_in_cruise(
    board: str, motors: int, alone: int, beside: int, latest: int
) -> None:
    """
    160 000, 160 000 and 150 000 steps/s in all without, 100 000, 150 000, 130 000 beside millis.
    """
    plan = bench_plan(board, motors, 1)
    by_itself = measure(plan, alone, millis=0)
    with_millis = measure(plan, beside, millis=1)

    assert (by_itself.late_steps, with_millis.late_steps) == (0, 0)
    assert (by_itself.error_cycles, with_millis.error_cycles) == (0, 0)
    assert with_millis.latest_cycles <= latest


@pytest.mark.parametrize(("board", "cycles"), [("uno", 60), ("mega", 62)])
def test_a_step_takes_about_sixty_cycles_from_the_sketch(board: str, cycles: int) -> None:
    """
    The usual way and, each 255 steps, the beginning of another run.
    """
    seen = measure(bench_plan(board, 1, 1), 1_000, millis=0)

    # The linker can make a shorter RJMP of the JMP in the vector table.
    assert cycles - 1 <= seen.stolen_cycles < cycles + 0.5

"""
What moves with ramps take from the sketch: exact cycles of the simulated chip.
"""

import pytest

from benchmarks.axis_ramps import bench_plan, measure
from benchmarks.axis_ramps import build_program as build
from stepgen.verify.toolchain import Target, default_compiler, empty_sketch


@pytest.mark.parametrize(
    ("board", "axes", "cruise", "ramp"),
    [("uno", 1, 68, 93), ("uno", 2, 69, 94), ("mega", 3, 70, 96)],
)
def test_a_step_takes_so_many_cycles(board: str, axes: int, cruise: int, ramp: int) -> None:
    """
    In cruise a usual step and, each 128 steps, a level; in a ramp of 2480 steps its rows, too.
    """
    plan = bench_plan(board, axes, 1)
    seen = measure(plan, build(plan).elf)

    assert 60 < seen.cruise_cycles <= cruise
    assert seen.cruise_cycles < seen.ramp_cycles <= ramp
    assert seen.late_steps == 0


def test_all_that_an_axis_can_have_fits_a_small_chip() -> None:
    """
    With a queue of 8, an S-curve, two switches, a range and homing, all of them used.
    """
    plan = bench_plan("uno", 1, 1, everything=True)
    made = build(plan)
    empty = empty_sketch(Target.from_fqbn(plan.board.fqbn), default_compiler())

    assert made.flash_bytes - empty.flash_bytes <= 3_720
    assert made.ram_bytes - empty.ram_bytes <= 90


def test_a_further_axis_takes_little_memory() -> None:
    """
    What is the same for each axis exists once: with move, stop and position over an empty sketch.
    """
    sizes = []
    for axes in (1, 2):
        plan = bench_plan("uno", axes, 1)
        made = build(plan)
        empty = empty_sketch(Target.from_fqbn(plan.board.fqbn), default_compiler())
        sizes.append((made.flash_bytes - empty.flash_bytes, made.ram_bytes - empty.ram_bytes))
    (flash, ram), (flash_of_two, ram_of_two) = sizes

    assert flash <= 2650
    assert ram <= 45
    assert flash_of_two - flash <= 900
    assert ram_of_two - ram <= 45

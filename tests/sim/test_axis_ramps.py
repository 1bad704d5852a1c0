"""
What moves with ramps take from the sketch: exact cycles of the simulated chip.
"""

import pytest

from benchmarks.axis_ramps import bench_plan, measure
from benchmarks.axis_ramps import build_program as build


@pytest.mark.parametrize(
    ("board", "axes", "cruise", "ramp"),
    [("uno", 1, 68, 95), ("uno", 2, 69, 97), ("mega", 3, 71, 99)],
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

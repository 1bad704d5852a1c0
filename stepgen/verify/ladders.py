"""
The planner's ladder as the reference model takes it.
"""

from stepgen.plan.isr import Motion
from stepgen.reference.ladder import Ladder, Rung


def ladder_of(motion: Motion) -> Ladder | None:
    """
    Return the ladder of an axis, level by level the one that *motion* plans; else None.
    """
    planned = motion.ladder
    if planned is None:
        return None
    rungs = (Rung(row.levels, row.steps, row.slope_256) for row in planned.rows)
    return Ladder(planned.first_interval_256, tuple(rungs))

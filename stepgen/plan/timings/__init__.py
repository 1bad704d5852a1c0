"""
What the planner knows of each timing: one module per kind, named like it.
"""

from importlib import import_module

from stepgen.devices import Board
from stepgen.plan.faults import Faults
from stepgen.plan.model import TimerPlan
from stepgen.spec.base import KindModel


def plan_timing(
    spec: KindModel, board: Board, free: tuple[int, ...], faults: Faults
) -> TimerPlan | None:
    """
    Return the timer that *spec* asks for, or the first of the *free* ones if it names none.

    Returns None after reporting why it cannot be.
    """
    module = import_module(f"{__name__}.{spec.kind.replace('-', '_')}")
    plan: TimerPlan | None = module.plan(spec, board, free, faults)
    return plan

"""
What the planner knows of each drive: one module per kind, named like it.
"""

from collections.abc import Sequence
from importlib import import_module

from stepgen.devices import Board
from stepgen.plan.faults import Faults
from stepgen.plan.kernels import Drive
from stepgen.spec.base import KindModel


def plan_drive(
    spec: KindModel, beside: Sequence[KindModel], board: Board, faults: Faults
) -> Drive | None:
    """
    Return the drive that *spec* asks for on *board*, or None after reporting why it cannot be.

    *beside* are the drives of the other motors: a stacked shield changes the one below it,
    and drivers may share their enable.
    """
    module = import_module(f"{__name__}.{spec.kind.replace('-', '_')}")
    drive: Drive | None = module.plan(spec, beside, board, faults)
    return drive

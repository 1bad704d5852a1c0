"""
What the planner knows of each timing: one module per kind, named like it.
"""

from importlib import import_module
from typing import Any

from stepgen.devices import Board, Mcu
from stepgen.plan.faults import Faults
from stepgen.plan.instructions import Gate, Storage
from stepgen.plan.isr import Motion
from stepgen.plan.model import Cadence, Left, Setting, TimerPlan
from stepgen.spec.base import KindModel


def plan_timing(spec: KindModel, board: Board, left: Left, faults: Faults) -> TimerPlan | None:
    """
    Return the timer that *spec* asks for, or the first of those *left* if it names none.

    Returns None after reporting why it cannot be.
    """
    plan: TimerPlan | None = _module(spec.kind).plan(spec, board, left, faults)
    return plan


def way_out(timing: TimerPlan, board: Board, free: tuple[int, ...]) -> str:
    """
    Return what a motor can take in place of the timer of *timing*; *free* are those left.
    """
    words: str = _module(timing.module).way_out(board, free)
    return words


def plan_gate(timing: TimerPlan, motion: Motion, storage: Storage, mcu: Mcu) -> Gate:
    """
    Return what *timing* puts into the interrupt beside the step, for *motion*.
    """
    gate: Gate = _module(timing.module).gate(timing, motion, storage, mcu)
    return gate


def plan_cadence(timing: TimerPlan, period_cycles: int) -> Cadence:
    """
    Return how often the interrupt of *timing* comes with *period_cycles* between two steps.
    """
    cadence: Cadence = _module(timing.module).cadence(period_cycles)
    return cadence


def plan_setting(timing: TimerPlan, period_cycles: int) -> Setting:
    """
    Return what *timing* makes of *period_cycles* between two steps: its prescaler and its ticks.
    """
    setting: Setting = _module(timing.module).choose_setting(period_cycles)
    return setting


def _module(kind: str) -> Any:  # noqa: ANN401 - a module; each offers the functions above
    return import_module(f"{__name__}.{kind.replace('-', '_')}")

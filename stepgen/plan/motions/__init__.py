"""
What the planner knows of each motion: one module per kind, named like it.
"""

from importlib import import_module

from stepgen.plan.isr import Motion
from stepgen.spec.base import KindModel


def plan_motion(spec: KindModel, *, timed: bool) -> Motion:
    """
    Return what the motion of *spec* asks of the step interrupt, *timed* with a command time-out.
    """
    module = import_module(f"{__name__}.{spec.kind.replace('-', '_')}")
    motion: Motion = module.plan(spec, timed=timed)
    return motion

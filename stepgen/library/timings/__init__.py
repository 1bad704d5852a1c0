"""
What the templates print of each timing: one module per kind, named like its partial.
"""

from importlib import import_module
from typing import Protocol

from stepgen.plan.model import MotorPlan


class TimerView(Protocol):
    """
    What every timing has; the rest is between its view and its partial.
    """

    @property
    def number(self) -> int:
        """
        Return the number of the timer.
        """

    @property
    def struct_prefix(self) -> str:
        """
        Return what the structs of its motions begin with, so that those of two timings differ.
        """

    @property
    def shared_by(self) -> str:
        """
        Return the partial whose shared part and fields it has: its own, or that of a like timing.
        """

    @property
    def elapsed_type(self) -> str:
        """
        Return the type that holds the ticks until it is set anew; "" where it never is.
        """


def timer_view(motor: MotorPlan) -> TimerView:
    """
    Return what the partial of the timing of *motor* prints.
    """
    module = import_module(f"{__name__}.{motor.timing.module}")
    view: TimerView = module.view(motor)
    return view

"""
What the planner knows of each motion: one module per kind, named like it.
"""

from importlib import import_module

from stepgen.plan.faults import Faults
from stepgen.plan.isr import Motion
from stepgen.plan.scale import Scale
from stepgen.spec import Motor


def plan_motion(motor: Motor, scale: Scale, f_cpu_hz: int, faults: Faults) -> Motion | None:
    """
    Return what the motion of *motor* asks of the step interrupt.

    Returns None after reporting why it cannot be; *faults* are those of the motor, *scale* the
    steps in each unit that its spec allows.
    """
    module = import_module(f"{__name__}.{motor.motion.kind.replace('-', '_')}")
    motion: Motion | None = module.plan(motor.motion, motor, scale, f_cpu_hz, faults)
    return motion

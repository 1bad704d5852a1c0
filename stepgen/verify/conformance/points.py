"""
All points, in the order in which tables show them.
"""

from stepgen.verify.conformance import (
    cpu_points,
    register_points,
    timer_points,
    usb_points,
    watchdog_points,
)
from stepgen.verify.conformance.point import Point

_MODULES = (timer_points, register_points, cpu_points, usb_points, watchdog_points)


def points() -> tuple[Point, ...]:
    """
    Return every point of the suite.
    """
    return tuple(
        value for module in _MODULES for value in vars(module).values() if isinstance(value, Point)
    )

"""
The limits of an axis in words, for tables: switches, range and homing.
"""

from collections.abc import Iterator
from fractions import Fraction

from stepgen.plan.curves import FRACTION
from stepgen.plan.end_stops import EndSwitch, HomingPlan, Pace
from stepgen.plan.model import MotorPlan

Row = tuple[str, str]


def limit_facts(motor: MotorPlan, f_cpu_hz: int) -> Iterator[Row]:
    """
    Yield what *motor* keeps to, and its value; nothing without limits.
    """
    stops = motor.end_stops
    if stops is None:
        return
    for switch in stops.switches:
        yield switch.signal, _switch(switch)
    yield "range", _range(stops.range, motor.steps_per_mm) if stops.range else "every position"
    if stops.homing:
        yield "homing", _homing(stops.homing, f_cpu_hz)
        yield "home", _home(stops.homing)


def limit_row(motor: MotorPlan, f_cpu_hz: int) -> Iterator[Row]:
    """
    Yield the same in short facts, for tables with a row for each motor; without the switches' pins.
    """
    stops = motor.end_stops
    if stops is None:
        return
    for switch in stops.switches:
        yield switch.signal, "pulled up by the chip" if switch.pull_up else "no pull-up"
    yield "range", _range(stops.range, motor.steps_per_mm) if stops.range else "every position"
    homing = stops.homing
    if homing:
        fast, slow = (_speed(pace, f_cpu_hz) for pace in (homing.fast, homing.slow))
        yield "homing to the", f"{homing.towards} switch"
        yield "at steps/s", fast
        yield "for steps at most", f"{homing.travel}"
        yield "back by steps", f"{homing.back_off}"
        yield "again at steps/s", slow
        yield "the switch is position", f"{homing.position}"
        yield "rest at", f"{homing.park}"


def range_steps(ends: tuple[int, int]) -> str:
    """
    Return a range in steps.
    """
    lowest, highest = ends
    return f"{lowest} to {highest} steps"


def _range(ends: tuple[int, int], steps_per_mm: Fraction | None) -> str:
    if not steps_per_mm:
        return range_steps(ends)
    low, high = (float(end / steps_per_mm) for end in ends)
    return f"{range_steps(ends)}: {low:.6g} to {high:.6g} mm"


def _switch(switch: EndSwitch) -> str:
    pulled = "pulled up by the chip" if switch.pull_up else "no pull-up"
    return f"{switch.pin.label} ({switch.pin.bit.name}), {switch.level} when pressed, {pulled}"


def _homing(homing: HomingPlan, f_cpu_hz: int) -> str:
    fast, slow = (_speed(pace, f_cpu_hz) for pace in (homing.fast, homing.slow))
    return (
        f"to the {homing.towards} switch at {fast} steps/s, for {homing.travel} steps at most; "
        f"back by {homing.back_off}, and to it at {slow} steps/s"
    )


def _home(homing: HomingPlan) -> str:
    return f"the switch is position {homing.position}; rest at {homing.park}"


def _speed(pace: Pace, f_cpu_hz: int) -> str:
    return f"{f_cpu_hz * FRACTION / pace.interval_256:.6g}"

"""
Trapezoid: ramps from a table, a decision at the end of each row, and no look at the clock.
"""

from fractions import Fraction

from stepgen.plan.faults import Faults
from stepgen.plan.isr import Motion
from stepgen.plan.ladder import (
    FRACTION,
    LONGEST_INTERVAL_CYCLES,
    MOST_STEPS,
    Ladder,
    plan_ladder,
)
from stepgen.spec import Motor
from stepgen.spec.motions.trapezoid import Trapezoid

_FORMS = {"wide_compare": "ladder-compare"}
_HANDLER_CYCLES = 660
_QUEUE_CYCLES = 56
_MASKED_CYCLES = 840


def plan(spec: Trapezoid, motor: Motor, f_cpu_hz: int, faults: Faults) -> Motion | None:
    """
    Return what the motion asks of the step interrupt.
    """
    _report_others(motor, faults)
    ladder = _ladder(spec, f_cpu_hz, faults.at("motion"))
    if ladder is None:
        return None
    return Motion(
        kind=spec.kind,
        watches_clock=False,
        handler_cycles=_HANDLER_CYCLES + (_QUEUE_CYCLES if spec.queue else 0),
        to_clock_cycles=0,
        thinking_cycles=0,
        limit_cycles=0,
        masked_cycles=_MASKED_CYCLES,
        forms=_FORMS,
        ladder=ladder,
        queue=spec.queue,
        wish_field=("motion", "cruise_speed"),
        cruise_interval_256=int(f_cpu_hz * FRACTION / spec.cruise_speed),
    )


def _report_others(motor: Motor, faults: Faults) -> None:
    """
    Report the fields of *motor* that belong to motions with another set of functions.
    """
    for field, way_out in (
        ("command_timeout_ms", "take `motion: constant`, or remove it"),
        ("steps_per_mm", "write speeds and ways in steps, or take `motion: constant`"),
        ("max_steps_per_second", "cruise_speed is the highest rate already; remove it"),
    ):
        if getattr(motor, field) is not None:
            faults.at(field).report(f"is nothing that a motor with motion trapezoid has; {way_out}")


def _ladder(spec: Trapezoid, f_cpu_hz: int, faults: Faults) -> Ladder | None:
    """
    Return the ramp of *spec*; None after reporting that it is too long or begins too slowly.
    """
    start = spec.start_speed or Fraction(0)
    ladder = plan_ladder(f_cpu_hz, spec.cruise_speed, spec.acceleration, start)
    if ladder is None:
        squares = (spec.cruise_speed**2 - start**2) / 2
        faults.at("acceleration").report(
            f"makes a ramp of {int(squares / spec.acceleration)} steps, and a table can have "
            f"{MOST_STEPS}; take {float(squares / MOST_STEPS):.6g} or more, or a lower cruise_speed"
        )
        return None
    if ladder.first_interval_256 > LONGEST_INTERVAL_CYCLES * FRACTION:
        seconds = LONGEST_INTERVAL_CYCLES / f_cpu_hz
        faults.at("acceleration").report(
            f"makes the first step last longer than {seconds:.3g} s, the longest interval; take "
            f"more, or a start_speed of {1 / seconds:.3g} or more"
        )
        return None
    return ladder

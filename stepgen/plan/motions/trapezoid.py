"""
Trapezoid: ramps from a table, a decision at the end of each row, and no look at the clock.
"""

from fractions import Fraction

from stepgen.plan.curves import FRACTION, Speeds
from stepgen.plan.faults import Faults
from stepgen.plan.isr import Motion
from stepgen.plan.ladder import (
    LONGEST_INTERVAL_CYCLES,
    MOST_ROWS,
    MOST_STEPS,
    Ladder,
    plan_ladder,
)
from stepgen.plan.scale import Scale
from stepgen.spec import Motor
from stepgen.spec.motions.trapezoid import Trapezoid
from stepgen.spec.quantities import Quantity

_FORMS = {"wide_compare": "ladder-compare"}
_HANDLER_CYCLES = 668
_QUEUE_CYCLES = 56
_MASKED_CYCLES = 840
_MOST_SPS = 1_000_000


def plan(
    spec: Trapezoid, motor: Motor, scale: Scale, f_cpu_hz: int, faults: Faults
) -> Motion | None:
    """
    Return what the motion asks of the step interrupt.
    """
    _report_others(motor, faults)
    speeds = _speeds(spec, scale, faults.at("motion"))
    ladder = speeds and _ladder(speeds, f_cpu_hz, faults.at("motion"))
    if not (speeds and ladder):
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
        cruise_interval_256=int(f_cpu_hz * FRACTION / speeds.cruise_sps),
    )


def _report_others(motor: Motor, faults: Faults) -> None:
    """
    Report the fields of *motor* that belong to motions with another set of functions.
    """
    for field, way_out in (
        ("command_timeout_ms", "take `motion: constant`, or remove it"),
        ("max_steps_per_second", "cruise_speed is the highest rate already; remove it"),
    ):
        if getattr(motor, field) is not None:
            faults.at(field).report(f"is nothing that a motor with motion trapezoid has; {way_out}")


def _speeds(spec: Trapezoid, scale: Scale, faults: Faults) -> Speeds | None:
    """
    Return the speeds of *spec* in steps; None after reporting a unit that *scale* has not.
    """

    def in_steps(field: str, quantity: Quantity) -> Fraction | None:
        return scale.steps(quantity, faults.at(field))

    start = in_steps("start_speed", spec.start_speed or Quantity(Fraction(0)))
    cruise = in_steps("cruise_speed", spec.cruise_speed)
    acceleration = in_steps("acceleration", spec.acceleration)
    jerk = in_steps("jerk", spec.jerk) if spec.jerk else None
    if start is None or cruise is None or acceleration is None or (spec.jerk and jerk is None):
        return None
    if cruise > _MOST_SPS:
        faults.at("cruise_speed").report(
            f"{float(cruise):g} steps/s is out of range; take {_MOST_SPS} or less"
        )
        return None
    if start >= cruise:
        faults.at("start_speed").report(
            f"is not below cruise_speed, {spec.cruise_speed}/s; make it lower, or leave it out to "
            "begin from 0"
        )
        return None
    return Speeds(start, cruise, acceleration, jerk)


def _ladder(speeds: Speeds, f_cpu_hz: int, faults: Faults) -> Ladder | None:
    """
    Return the ramp of *speeds*; None after reporting that it is too long or begins too slowly.
    """
    ladder = plan_ladder(f_cpu_hz, speeds)
    if ladder is None:
        squares = (speeds.cruise_sps**2 - speeds.start_sps**2) / 2
        more = "more, a higher jerk"
        if speeds.jerk is None:
            more = f"{float(squares / MOST_STEPS):.6g} steps/s^2 or more"
        faults.at("acceleration").report(
            f"makes a ramp of {int(speeds.steps)} steps, and a table can have {MOST_STEPS}; take "
            f"{more}, or a lower cruise_speed"
        )
        return None
    if len(ladder.rows) > MOST_ROWS:
        faults.at("acceleration").report(
            f"makes a table of {len(ladder.rows)} rows, and {MOST_ROWS} are the most; take more, "
            "or a higher start_speed"
        )
        return None
    if ladder.first_interval_256 > LONGEST_INTERVAL_CYCLES * FRACTION:
        seconds = LONGEST_INTERVAL_CYCLES / f_cpu_hz
        faults.at("acceleration").report(
            f"makes the first step last longer than {seconds:.3g} s, the longest interval; take "
            f"more, or a start_speed of {1 / seconds:.3g} steps/s or more"
        )
        return None
    return ladder

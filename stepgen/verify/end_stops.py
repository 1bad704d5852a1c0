"""
The limits of an axis as the reference model takes them: from the spec, not from the plan.
"""

from fractions import Fraction

from stepgen.plan.model import MotorPlan
from stepgen.reference.end_stops import EndStopFacts, HomingFacts
from stepgen.reference.timer import FRACTIONS
from stepgen.spec import Motor
from stepgen.spec.limits import Homing
from stepgen.spec.quantities import Quantity
from stepgen.verify.units import steps_in


def end_stop_facts(motor: Motor, planned: MotorPlan, f_cpu_hz: int) -> EndStopFacts | None:
    """
    Return what the limits of *motor* are in steps; None if it has none.
    """
    spec = motor.limits
    if spec is None:
        return None

    def steps(quantity: Quantity) -> Fraction:
        return quantity.number * steps_in(quantity.unit, planned)

    return EndStopFacts(
        switches=frozenset(end for end in ("low", "high") if getattr(spec, end)),
        range=(round(steps(spec.range[0])), round(steps(spec.range[1]))) if spec.range else None,
        homing=_homing(spec.homing, planned, f_cpu_hz, spec.range) if spec.homing else None,
    )


def planned_limits(planned: MotorPlan) -> EndStopFacts | None:
    """
    Return the limits that *planned* was given, for scenarios that are to meet them.
    """
    stops = planned.end_stops
    if stops is None:
        return None
    one, homing = stops.homing, None
    if one:
        ways = (one.back_off, one.travel, one.position, one.park)
        homing = HomingFacts(one.towards, one.fast.interval_256, one.slow.interval_256, *ways)
    return EndStopFacts(frozenset(one.end for one in stops.switches), stops.range, homing)


def _homing(
    spec: Homing, planned: MotorPlan, f_cpu_hz: int, limits: tuple[Quantity, Quantity] | None
) -> HomingFacts:
    def steps(quantity: Quantity) -> Fraction:
        return quantity.number * steps_in(quantity.unit, planned)

    def interval_256(speed: Quantity) -> int:
        return int(f_cpu_hz * FRACTIONS / steps(speed))

    position = round(steps(spec.position))
    ends = [round(steps(end)) for end in limits or ()]
    return HomingFacts(
        towards=spec.towards,
        fast_256=interval_256(spec.speed),
        slow_256=interval_256(spec.slow_speed),
        back_off=round(steps(spec.back_off)),
        travel=round(steps(spec.travel)),
        position=position,
        # The nearest place to the switch that a move may have.
        park=sorted((*ends, position))[1] if ends else position,
    )

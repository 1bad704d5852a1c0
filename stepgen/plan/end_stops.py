"""
The limits of an axis: its switches, the range of its positions, and the way it finds home.
"""

from dataclasses import dataclass, replace

from stepgen.devices import Board, Pin, Register
from stepgen.plan.curves import FRACTION
from stepgen.plan.faults import Faults
from stepgen.plan.isr import Motion
from stepgen.plan.ladder import LONGEST_INTERVAL_CYCLES, Ladder
from stepgen.plan.pins import missing_pin
from stepgen.plan.scale import Scale
from stepgen.spec.limits import End, Homing, Limits, Switch
from stepgen.spec.quantities import Quantity

_FARTHEST_STEPS = (1 << 30) - 1
"""The farthest position of a range and the longest way of homing: no sum of them wraps."""

# What a call does more, with interrupts off, and the handler at the end of a way.
_MASKED_CYCLES = 40
_HOMING_MASKED_CYCLES = 60
_HOMING_CYCLES = 190


@dataclass(frozen=True)
class EndSwitch:
    """
    The switch at one end.

    Args:
        end: Which end.
        pin: Its pin.
        register: The register that shows the pin.
        active_high: Whether the pin is HIGH at the end.
        pull_up: Whether the chip pulls it up.
    """

    end: End
    pin: Pin
    register: Register
    active_high: bool
    pull_up: bool

    @property
    def signal(self) -> str:
        """
        Return what its wire is called in tables.
        """
        return f"{self.end} end"

    @property
    def level(self) -> str:
        """
        Return what the pin shows at the end of the way.
        """
        return "HIGH" if self.active_high else "LOW"


@dataclass(frozen=True)
class Pace:
    """
    A speed of homing: its interval in 1/256 clocks, and how high on the ramp that is, in steps.
    """

    interval_256: int
    height: int


@dataclass(frozen=True)
class HomingPlan:
    """
    How an axis finds home; all ways in steps.

    Args:
        towards: The end at which its switch is.
        fast: The speed of the way there.
        slow: The speed of the second way there.
        back_off: How far it goes back in between.
        travel: How far it looks for the switch.
        position: What the place of the switch is called.
        park: Where it comes to rest in the end: there, or where its range begins.
    """

    towards: End
    fast: Pace
    slow: Pace
    back_off: int
    travel: int
    position: int
    park: int


@dataclass(frozen=True)
class EndStops:
    """
    What an axis keeps to.

    Args:
        switches: Its switches, that of the low end first.
        range: Its lowest and highest position, if it has such.
        homing: How it finds home, if it does.
    """

    switches: tuple[EndSwitch, ...]
    range: tuple[int, int] | None
    homing: HomingPlan | None

    def to_and_fro(self, steps: int) -> tuple[int, int]:
        """
        Return two places of the range, *steps* apart if it is as long: 0 is one, if it has that.
        """
        lowest, highest = self.range or (0, steps)
        here = min(max(0, lowest), highest)
        if here + steps <= highest:
            return here, here + steps
        return max(highest - steps, lowest), highest

    def limited(self, motion: Motion) -> Motion:
        """
        Return *motion*, whose calls and handler have these limits to look at.
        """
        masked = _MASKED_CYCLES + (_HOMING_MASKED_CYCLES if self.homing else 0)
        return replace(
            motion,
            handler_cycles=motion.handler_cycles + (_HOMING_CYCLES if self.homing else 0),
            masked_cycles=motion.masked_cycles + masked,
        )


def plan_end_stops(
    spec: Limits, motion: Motion, scale: Scale, board: Board, faults: Faults
) -> EndStops | None:
    """
    Return the limits that *spec* asks for, in steps; None after reporting why it cannot be.
    """
    if motion.ladder is None:
        faults.report(
            "are kept by moves with ramps; take `motion: {kind: trapezoid, ...}`, or remove them"
        )
        return None
    ends: tuple[tuple[End, Switch | None], ...] = (("low", spec.low), ("high", spec.high))
    switches = [_switch(end, one, board, faults.at(end)) for end, one in ends if one]
    limits = _range(spec.range, scale, faults.at("range")) if spec.range else None
    if None in switches or (spec.range and limits is None):
        return None
    homing = None
    if spec.homing:
        plan = _Homing(spec.homing, scale, board.f_cpu_hz, faults.at("homing"))
        homing = plan.made(motion.cruise_interval_256, motion.ladder, limits)
        if homing is None:
            return None
    return EndStops(tuple(one for one in switches if one), limits, homing)


def _switch(end: End, spec: Switch, board: Board, faults: Faults) -> EndSwitch | None:
    pin = board.find_pin(spec.pin)
    if pin is None:
        faults.at("pin").report(missing_pin(spec.pin, board))
        return None
    register = board.mcu.port(pin.bit.port).pin
    return EndSwitch(end, pin, register, spec.active == "high", spec.pull_up)


def _range(spec: tuple[Quantity, Quantity], scale: Scale, faults: Faults) -> tuple[int, int] | None:
    lowest, highest = (_place(one, scale, faults.at(index)) for index, one in enumerate(spec))
    if lowest is None or highest is None:
        return None
    if lowest >= highest:
        faults.report("has its lowest position not below its highest; write the lower one first")
        return None
    return lowest, highest


def _place(quantity: Quantity, scale: Scale, faults: Faults) -> int | None:
    """
    Return *quantity* in whole steps; None after reporting that nothing says how many, or too many.
    """
    steps = scale.steps(quantity, faults)
    if steps is None:
        return None
    if abs(steps) > _FARTHEST_STEPS:
        faults.report(f"is {float(steps):g} steps; take {_FARTHEST_STEPS} or less")
        return None
    return round(steps)


class _Homing:
    """
    Makes the plan of homing, and reports what of it cannot be.
    """

    def __init__(self, spec: Homing, scale: Scale, f_cpu_hz: int, faults: Faults) -> None:
        self._spec = spec
        self._scale = scale
        self._f_cpu_hz = f_cpu_hz
        self._faults = faults

    def made(
        self, cruise_256: int, ladder: Ladder, limits: tuple[int, int] | None
    ) -> HomingPlan | None:
        """
        Return the plan on *ladder*, at most as fast as *cruise_256*, to rest within *limits*.
        """
        spec, faults = self._spec, self._faults
        fast = self._pace(spec.speed, "speed", ladder)
        slow = self._pace(spec.slow_speed, "slow_speed", ladder)
        back_off = self._way(spec.back_off, "back_off")
        travel = self._way(spec.travel, "travel")
        position = _place(spec.position, self._scale, faults.at("position"))
        park = position is not None and self._park(position, limits)
        if not (fast and slow and back_off and travel) or position is None or park is None:
            return None
        if fast.interval_256 < cruise_256:
            faults.at("speed").report("is above the motion's cruise_speed; take that or less")
            return None
        if slow.interval_256 < fast.interval_256:
            faults.at("slow_speed").report("is above homing's speed; make it lower")
            return None
        if back_off >= travel:
            faults.at("back_off").report("is as far as homing travels; make it shorter")
            return None
        return HomingPlan(spec.towards, fast, slow, back_off, travel, position, park)

    def _pace(self, speed: Quantity, field: str, ladder: Ladder) -> Pace | None:
        """
        Return *speed* as an interval; None after reporting that there is no such.
        """
        faults = self._faults.at(field)
        sps = self._scale.steps(speed, faults)
        if sps is None:
            return None
        interval_256 = int(self._f_cpu_hz * FRACTION / sps)
        if interval_256 > LONGEST_INTERVAL_CYCLES * FRACTION:
            lowest = self._f_cpu_hz / LONGEST_INTERVAL_CYCLES
            faults.report(f"is {float(sps):g} steps/s; take {lowest:.3g} or more")
            return None
        return Pace(interval_256, ladder.goal(interval_256))

    def _way(self, way: Quantity, field: str) -> int | None:
        steps = _place(way, self._scale, self._faults.at(field))
        if steps == 0:
            self._faults.at(field).report("is less than a step; make it longer")
            return None
        return steps

    def _park(self, position: int, limits: tuple[int, int] | None) -> int | None:
        """
        Return where to rest if the switch is at *position*: there, or where the range begins.

        None after reporting that the switch is at the wrong end of the range.
        """
        if limits is None:
            return position
        lowest, highest = limits
        if self._spec.towards == "low" and position < highest:
            return max(position, lowest)
        if self._spec.towards == "high" and position > lowest:
            return min(position, highest)
        end = "highest" if self._spec.towards == "low" else "lowest"
        self._faults.at("position").report(
            f"lies beyond the {end} position of the range, at whose other end the switch is; give "
            "the switch a position there"
        )
        return None

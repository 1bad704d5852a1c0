"""
What each function of an axis must do, beyond keeping the invariant.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import z3

from stepgen.verify.proof.axis_state import (
    CLIMB,
    DESCEND,
    ENDLESS,
    REVERSE,
    RUNNING,
    TOUCHED,
    TURNING,
    AxisState,
)
from stepgen.verify.proof.claims import metric_position
from stepgen.verify.proof.numbers import BITS, wide

TOO_FAST, RUNS, QUEUE_FULL, RANGE, HOMING, FAULT = -1, -5, -6, -7, -8, -9
LIMIT, NOT_FOUND, EMERGENCY = 1, 2, 3
APPROACHING, PARKING = 3, 4
_FAR = 1 << 30

Said = Iterator[tuple[str, Any]]


@dataclass(frozen=True)
class AxisWay:
    """
    One way through a function of an axis: what was before, what is after, and what it returns.

    Args:
        spec: The shortest interval of the spec, and how high the motor climbs for it.
        height: What ``heightFor`` returns for the interval that a call names.
        per_mm: The steps in a millimetre, if there are units of length.
    """

    before: AxisState
    after: AxisState
    arguments: list[Any]
    result: Any
    spec: tuple[int, int]
    height: Any
    per_mm: Fraction | None


def _stays(way: AxisWay) -> Said:
    yield "a call makes no step", way.after.position == way.before.position


def _same(way: AxisWay) -> Any:  # noqa: ANN401 - z3 has no types
    own = (f"{way.before.motor}Motion", f"{way.before.motor}Queue", f"{way.before.motor}Queued")
    places = [place for place in way.before.values if place[0] in own]
    same = [way.after.values[place] == way.before.values[place] for place in places]
    return z3.And(*same, way.after.count == way.before.count)


def _goes_to(way: AxisWay, destination: Any) -> Said:  # noqa: ANN401
    """
    Yield what holds once the motor is to go to *destination*, or without an end beyond it.
    """
    before, after = way.before, way.after
    yield from _stays(way)
    there = destination == before.position
    same = z3.And(z3.Not(before.is_in(RUNNING)), there)
    yield (
        "at rest in that place nothing happens",
        z3.Implies(same, after.of("mode") == before.of("mode")),
    )
    yield "else it runs", z3.Or(same, after.is_in(RUNNING))
    yield "it goes there in the end", after.of("destination") == destination
    turns = after.is_in(TURNING)
    yield "or comes to rest first", z3.Or(turns, after.of("end") == destination)
    yield "a motor at rest turns at once", z3.Implies(turns, before.is_in(RUNNING))
    ahead = destination - before.position
    back = z3.If(before.is_in(REVERSE), ahead > 0, ahead < 0)
    behind = z3.And(before.is_in(RUNNING), z3.Or(back, ahead == 0))
    yield "it turns where the place lies behind", z3.Implies(behind, turns)
    yield "nothing waits", after.queued == 0


def _beyond(way: AxisWay, position: Any) -> Any:  # noqa: ANN401
    """
    Tell whether *position* lies outside of the range, if there is one.
    """
    if not (way.before.stops and way.before.stops.range):
        return z3.BoolVal(val=False)
    lowest, highest = way.before.stops.range
    return z3.Or(position < lowest, position > highest)


def _refusal(way: AxisWay, destination: Any) -> Any:  # noqa: ANN401
    """
    Return the code with which a move to *destination* is refused, or 0.
    """
    homing, fault = way.before.limit("Homing"), way.before.limit("Fault")
    code = z3.If(_beyond(way, destination), _code(RANGE), _code(0))
    if fault is not None:
        code = z3.If(fault != 0, _code(FAULT), code)
    return code if homing is None else z3.If(homing != 0, _code(HOMING), code)


def _moves(way: AxisWay, destination: Any, *claims: tuple[str, Any]) -> Said:  # noqa: ANN401
    """
    Yield what must hold after a move to *destination*, and *claims*, unless it is refused.
    """
    refusal = _refusal(way, destination)
    refused = refusal != 0
    yield "what cannot be is refused", way.result == refusal
    yield "then nothing changes", z3.Implies(refused, _same(way))
    for says, claim in (*_goes_to(way, destination), *claims):
        yield says, z3.Or(refused, claim)


def move_to(way: AxisWay) -> Said:
    """
    Yield what must hold after ``...MoveTo``.
    """
    yield from _moves(way, way.arguments[0], ("it ends", z3.Not(way.after.is_in(ENDLESS))))


def move(way: AxisWay) -> Said:
    """
    Yield what must hold after ``...Move``.
    """
    there = way.before.position + way.arguments[0]
    yield from _moves(way, there, ("it ends", z3.Not(way.after.is_in(ENDLESS))))


def run_forward(way: AxisWay) -> Said:
    """
    Yield what must hold after ``...RunForward``.
    """
    yield from _runs(way, _FAR)


def run_backward(way: AxisWay) -> Said:
    """
    Yield what must hold after ``...RunBackward``.
    """
    yield from _runs(way, -_FAR)


def _runs(way: AxisWay, ahead: int) -> Said:
    after = way.after
    if way.before.stops and way.before.stops.range:
        end = z3.BitVecVal(way.before.stops.range[ahead > 0], 32)
        yield from _moves(way, end, ("it ends", z3.Not(after.is_in(ENDLESS))))
        return
    there = after.is_in(REVERSE) == (ahead < 0)
    yield from _moves(
        way,
        way.before.position + ahead,
        ("it runs without an end", z3.And(after.is_in(RUNNING), after.is_in(ENDLESS))),
        ("that way, or it turns", there != after.is_in(TURNING)),
    )


def home(way: AxisWay) -> Said:
    """
    Yield what must hold after ``...Home``.
    """
    before, after = way.before, way.after
    plan = way.before.stops.homing if way.before.stops else None
    if plan is None:
        raise ValueError(before.motor)
    code = z3.If(before.is_in(RUNNING), _code(RUNS), _code(0))
    code = z3.If(before.limit("Fault") != 0, _code(FAULT), code)
    refused = code != 0
    yield "it refuses with a fault, and while it runs", way.result == code
    yield "then nothing changes", z3.Implies(refused, _same(way))
    travel = plan.travel if plan.towards == "high" else -plan.travel
    for says, claim in (
        *_goes_to(way, before.position + travel),
        ("it looks for the switch", after.limit("Homing") == 1),
        ("no place is home", after.limit("Homed") == 0),
        ("the sketch's speed is kept", after.limit("Cruise") == before.of("cruise")),
        ("and its height", after.limit("Goal") == before.of("goal")),
        ("it runs at homing's speed", after.of("cruise") == plan.fast.interval_256),
        ("as high as that", after.of("goal") == plan.fast.height),
    ):
        yield says, z3.Or(refused, claim)


def stop(way: AxisWay) -> Said:
    """
    Yield what must hold after ``...Stop``.
    """
    yield from _stays(way)
    before, after = way.before, way.after
    yield "it runs on if it ran", after.is_in(RUNNING) == before.is_in(RUNNING)
    yield "it ends where it comes to rest", z3.Not(after.is_in(ENDLESS | TURNING))
    level = before.ramp.height(before.of("row"), before.level)
    flat = z3.Not(before.is_in(DESCEND))
    rest = wide(level) + z3.If(flat, _one(BITS), wide(before.count))
    yield "as soon as it can", z3.Implies(after.is_in(RUNNING), after.left == rest)
    yield "there it is to be", after.target == after.of("end")


def halt(way: AxisWay) -> Said:
    """
    Yield what must hold after ``...Halt``.
    """
    yield from _stays(way)
    yield "it rests", z3.Not(way.after.is_in(RUNNING))
    yield "where it is to be", way.after.target == way.before.position


def emergency_stop(way: AxisWay) -> Said:
    """
    Yield what must hold after ``...EmergencyStop``.
    """
    yield from _ceases(way, EMERGENCY)


def _ceases(way: AxisWay, fault: int) -> Said:
    after = way.after
    yield from halt(way)
    yield "moves are refused from now on", after.limit("Fault") == fault
    if after.limit("Homing") is not None:
        yield "homing is over", after.limit("Homing") == 0
        yield "and its place forgotten", after.limit("Homed") == 0


def limit(way: AxisWay) -> Said:
    """
    Yield what must hold where the step interrupt goes on in place of a step into a switch.
    """
    before, homing = way.before, way.before.limit("Homing")
    if homing is None:
        yield from _ceases(way, LIMIT)
        return
    looks, after = homing & 1 != 0, way.after
    for says, claim in _ceases(way, LIMIT):
        yield says, z3.Or(looks, claim)
    for says, claim in stop(way):
        yield f"looking for it, {says}", z3.Implies(looks, claim)
    yield "no step is made", after.position == before.position
    seen = z3.And(after.limit("Contact") == before.position, after.is_in(TOUCHED))
    yield "the place is kept", z3.Implies(looks, seen)
    yield "homing goes on", z3.Implies(looks, after.limit("Homing") == homing)


def clear_fault(way: AxisWay) -> Said:
    """
    Yield what must hold after ``...ClearFault``.
    """
    yield "there is no fault", way.after.limit("Fault") == 0
    yield "nothing else changes", _same(way)


def read_fault(way: AxisWay) -> Said:
    """
    Yield what must hold of the result of ``...ReadFault``.
    """
    yield "the fault", way.result == way.before.limit("Fault")
    yield "nothing changes", _same(way)


def is_homed(way: AxisWay) -> Said:
    """
    Yield what must hold of the result of ``...IsHomed``.
    """
    yield "whether it is at home", (way.result != 0) == (way.before.limit("Homed") != 0)
    yield "nothing changes", _same(way)


def set_speed(way: AxisWay) -> Said:
    """
    Yield what must hold after ``...SetSpeed``.
    """
    before, after = way.before, way.after
    homing = before.limit("Homing")
    code = _code(0) if homing is None else z3.If(homing != 0, _code(HOMING), _code(0))
    code = z3.If(z3.ULT(way.arguments[0], way.spec[0]), _code(TOO_FAST), code)
    refused = code != 0
    yield from _stays(way)
    yield "it refuses what is too fast, and while it looks for home", way.result == code
    yield "then nothing changes", z3.Implies(refused, _same(way))
    taken = z3.And(after.of("cruise") == way.arguments[0], after.of("goal") == way.height)
    yield "else the interval holds, and how high it climbs for it", z3.Or(refused, taken)
    yield "what is left stays, or is far away", _is_left(way, before.left)
    runs = z3.And(before.is_in(RUNNING), z3.Not(refused))
    number = before.ramp.height(before.of("row"), before.level)
    climbs = z3.And(before.is_in(CLIMB), z3.ULT(number, way.height))
    yield "it climbs on below that height", z3.Implies(runs, after.is_in(CLIMB) == climbs)
    same = z3.Or(climbs, before.is_in(DESCEND))
    count = z3.If(same, before.count, _one(8))
    yield (
        "it goes on with its level, or ends it with the next step",
        z3.Implies(runs, z3.And(after.count == count, after.of("levels") == 0)),
    )


def _is_left(way: AxisWay, left: Any) -> Any:  # noqa: ANN401
    """
    Tell whether so many steps are *left*; without an end it may have been put off, as far as kFar.
    """
    before, after = way.before, way.after
    same = z3.And(after.left == left, after.of("end") == before.of("end"))
    ahead = z3.If(before.is_in(REVERSE), -_FAR, z3.BitVecVal(_FAR, 32))
    far = z3.And(after.left == left + _FAR, after.of("end") == before.of("end") + ahead)
    return z3.Or(same, z3.And(before.is_endless, far))


def queue_move_to(way: AxisWay) -> Said:
    """
    Yield what must hold after ``...QueueMoveTo``.
    """
    before, after = way.before, way.after
    destination = way.arguments[0]
    running, endless = before.is_in(RUNNING), before.is_in(ENDLESS)
    again = z3.And(running, destination == before.target)
    full = z3.And(running, before.queued == before.places)
    code = z3.If(full, _code(QUEUE_FULL), _code(0))
    code = z3.If(endless, _code(RUNS), z3.If(again, _code(0), code))
    refusal = _refusal(way, destination)
    code = z3.If(refusal != 0, refusal, code)
    yield from _stays(way)
    yield "it refuses behind a run without an end, and what has no place", way.result == code
    yield "then nothing changes", z3.Implies(z3.Or(code != 0, again), _same(way))
    yield "else it goes there in the end", z3.Implies(code == 0, after.target == destination)


def init(way: AxisWay) -> Said:
    """
    Yield what must hold after ``...Init``.
    """
    after = way.after
    yield "the position is 0", after.position == 0
    yield "it rests", z3.Not(after.is_in(RUNNING))
    yield "it cruises as the spec says", after.of("cruise") == way.spec[0]
    yield "as high as that", after.of("goal") == way.spec[1]
    yield "no step was missed", after.of("missed") == 0
    yield "forward", z3.Not(after.is_in(REVERSE))


def current_position(way: AxisWay) -> Said:
    """
    Yield what must hold of the result of ``...CurrentPosition``.
    """
    yield "the position", way.result == way.before.position
    yield "nothing changes", _same(way)


def position(way: AxisWay) -> Said:
    """
    Yield what must hold of the result of ``...Position``, a part of other functions.
    """
    yield "the position", way.result == way.before.position
    yield "nothing changes", _same(way)


def target_position(way: AxisWay) -> Said:
    """
    Yield what must hold of the result of ``...TargetPosition``.
    """
    yield "the target", way.result == way.before.target
    yield "nothing changes", _same(way)


def distance_to_go(way: AxisWay) -> Said:
    """
    Yield what must hold of the result of ``...DistanceToGo``.
    """
    yield "the distance", way.result == way.before.target - way.before.position
    yield "nothing changes", _same(way)


def read_nanometres(way: AxisWay) -> Said:
    """
    Yield what must hold of the result of ``...ReadNanometres``, as far as 32 bits go.
    """
    if way.per_mm is None:
        raise ValueError(way.before.motor)
    yield metric_position(way.result, way.per_mm)
    yield "nothing changes", _same(way)


def is_running(way: AxisWay) -> Said:
    """
    Yield what must hold of the result of ``...IsRunning``.
    """
    yield "whether it runs", (way.result != 0) == way.before.is_in(RUNNING)
    yield "nothing changes", _same(way)


def read_missed(way: AxisWay) -> Said:
    """
    Yield what must hold of the result of ``...ReadMissed``.
    """
    yield "the steps that came too late", way.result == way.before.of("missed")
    yield "nothing changes", _same(way)


def set_current_position(way: AxisWay) -> Said:
    """
    Yield what must hold after ``...SetCurrentPosition``.
    """
    yield from _only_at_rest(way, z3.If(_beyond(way, way.arguments[0]), _code(RANGE), _code(0)))
    named = z3.And(way.after.position == way.arguments[0], way.after.target == way.arguments[0])
    yield "the place has that number", z3.Or(way.result != 0, named)


def outputs(way: AxisWay) -> Said:
    """
    Yield what must hold after ``...EnableOutputs`` and ``...DisableOutputs``.
    """
    yield from _stays(way)
    yield from _only_at_rest(way, _code(0))


def _only_at_rest(way: AxisWay, code: Any) -> Said:  # noqa: ANN401
    code = z3.If(way.before.is_in(RUNNING), _code(RUNS), code)
    yield "it refuses while it runs", way.result == code
    yield "then nothing changes", z3.Implies(way.result != 0, _same(way))


def passed(way: AxisWay) -> Said:
    """
    Yield what must hold of ``...Passed``, a part of the step interrupt's rare ways.
    """
    yield "nothing changes", _same(way)


def boundary(way: AxisWay) -> Said:
    """
    Yield what must hold after the rare ways of a step interrupt.
    """
    before, after = way.before, way.after
    steps = z3.And(before.is_in(RUNNING), before.of("lapsLeft") == 0)
    ahead = z3.If(before.is_in(REVERSE), z3.BitVecVal(-1, 32), z3.BitVecVal(1, 32))
    made = z3.If(steps, ahead, 0)
    over = z3.And(steps, before.left == 1)
    homing, homes = before.limit("Homing"), z3.BoolVal(val=False)
    if homing is not None:
        yield from _homes_on(way, over)
        homes, renumbered = after.limit("Homing") != 0, z3.And(over, _finds(way))
        made += z3.If(renumbered, _number(way) - before.limit("Contact"), 0)
    yield "the position changes by the step that is made", after.position == before.position + made
    onward = z3.Or(before.of("end") != before.of("destination"), before.queued != 0, homes)
    yield (
        "it rests after the last step",
        z3.Implies(
            before.is_in(RUNNING), after.is_in(RUNNING) == z3.Not(z3.And(over, z3.Not(onward)))
        ),
    )
    same = z3.Or(before.is_endless, after.left == before.left - z3.If(steps, _one(BITS), 0))
    yield "a step less is left of the way", z3.Or(z3.Not(before.is_in(RUNNING)), over, same)
    turned = z3.And(over, before.is_in(TURNING))
    yield (
        "after a turn it goes on to the destination",
        z3.Implies(
            z3.And(turned, after.is_in(RUNNING), z3.Not(after.is_in(ENDLESS)), before.queued == 0),
            after.of("end") == before.of("destination"),
        ),
    )
    stays = after.target == before.target
    yield "the target stays", z3.Or(before.is_in(ENDLESS), homes, stays)


def _finds(way: AxisWay) -> Any:  # noqa: ANN401
    """
    Tell whether homing has seen its switch for the second time.
    """
    before = way.before
    return z3.And(before.limit("Homing") == APPROACHING, before.is_in(TOUCHED))


def _number(way: AxisWay) -> int:
    """
    Return what homing calls the place of the switch.
    """
    stops = way.before.stops
    if not (stops and stops.homing):
        raise ValueError(way.before.motor)
    return stops.homing.position


def _homes_on(way: AxisWay, over: Any) -> Said:  # noqa: ANN401
    """
    Yield what holds of homing where a way may be *over*.
    """
    before, after = way.before, way.after
    homing, then = before.limit("Homing"), after.limit("Homing")
    looks, parks = homing & 1 != 0, homing == PARKING
    ends = z3.And(over, homing != 0)
    yield "homing goes on with its ways alone", z3.Or(ends, then == homing)
    yield "to the next one, or it is over", z3.Implies(ends, z3.Or(then == homing + 1, then == 0))
    seen = z3.Or(z3.Not(looks), before.is_in(TOUCHED))
    yield "not without the switch", z3.Implies(z3.And(ends, z3.Not(seen)), then == 0)
    lost = z3.And(ends, then == 0, z3.Not(parks))
    fault = z3.If(lost, _code(NOT_FOUND), before.limit("Fault"))
    yield "it tells that there was none", after.limit("Fault") == fault
    homed = z3.If(z3.And(ends, parks), _one(1), before.limit("Homed"))
    yield "at its end it is at home", after.limit("Homed") == homed
    own = z3.And(
        after.of("goal") == before.limit("Goal"), after.of("cruise") == before.limit("Cruise")
    )
    yield "then the sketch's speed counts", z3.Implies(z3.And(ends, then == 0), own)


def _code(number: int) -> Any:  # noqa: ANN401
    return z3.BitVecVal(number, 8)


def _one(bits: int) -> Any:  # noqa: ANN401
    return z3.BitVecVal(1, bits)


AXIS_CLAIMS: dict[str, Callable[[AxisWay], Said]] = {
    "Init": init,
    "MoveTo": move_to,
    "Move": move,
    "QueueMoveTo": queue_move_to,
    "RunForward": run_forward,
    "RunBackward": run_backward,
    "Stop": stop,
    "Halt": halt,
    "SetSpeed": set_speed,
    "ReadMissed": read_missed,
    "CurrentPosition": current_position,
    "TargetPosition": target_position,
    "DistanceToGo": distance_to_go,
    "Position": position,
    "ReadNanometres": read_nanometres,
    "IsRunning": is_running,
    "SetCurrentPosition": set_current_position,
    "EnableOutputs": outputs,
    "DisableOutputs": outputs,
    "Passed": passed,
    "EmergencyStop": emergency_stop,
    "ClearFault": clear_fault,
    "ReadFault": read_fault,
    "IsHomed": is_homed,
    "Home": home,
    "limit": limit,
    "boundary": boundary,
}
"""The claims by function, without the axis's name."""

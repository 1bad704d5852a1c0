"""
What each function must do, beyond keeping the invariant: what the reference model computes.
"""

from collections.abc import Callable, Iterator
from fractions import Fraction
from typing import Any

import z3

from stepgen.reference.contract import TimingKind
from stepgen.reference.facts import MotorFacts
from stepgen.reference.motion import Motion
from stepgen.reference.sequences import Pattern
from stepgen.reference.stimuli import SetSpeed
from stepgen.reference.updates import Updates
from stepgen.reference.verdict import stops, verdict
from stepgen.verify.proof.library import (
    PRESCALERS,
    Library,
    interval_ticks,
    right_choice,
    span_ticks,
)
from stepgen.verify.proof.memory import CLOCK
from stepgen.verify.proof.numbers import Number, term, wide
from stepgen.verify.proof.paths import Paths
from stepgen.verify.proof.state import (
    CLOCKED,
    ENDLESS,
    IRQ_TIMING,
    LIMITED,
    REVERSE,
    RUNNING,
    THINK,
    UPDATE_STEPS,
)
from stepgen.verify.proof.way import (
    NO_STEP,
    Way,
    low_millis,
    millis_left,
    position,
    same_but_status,
)

_REACHED = 0x10
_FAR = 0x7FFF
POSITION_READ = z3.BitVec("the position that is read", 32)
"""Stands for the result of ``...ReadPosition``, which is proven by itself."""
_EXACT = 32  # bits beyond 32 with which no product of metric units overflows


def choice(library: Library, paths: Paths, period: Any, parts: Any) -> Iterator[tuple[str, Any]]:  # noqa: ANN401
    """
    Yield what must hold of the *parts* that are chosen for *period*.
    """
    timing = _timing(parts)
    facts = MotorFacts((), Pattern((), ()), library.min_top, "hold", timing=timing)
    number: Any = Number(wide(period), paths)
    model = facts.setting(number)
    ticks = term(model.period_ticks)
    if timing == "fast-pwm":
        (select,) = (bits for bits, by in PRESCALERS.items() if by == model.prescaler)
        yield "the prescaler is the model's", parts[("select",)] == select
        yield "TOP is the model's", wide(parts[("top",)]) == ticks - 1
    elif timing == "compare":
        yield "the laps make up the model's ticks", interval_ticks(parts) == ticks
    else:
        yield "the laps make up the model's clocks", span_ticks(parts) == ticks
    yield "the choice is as all others take it", right_choice(parts, period)


def _timing(parts: Any) -> TimingKind:  # noqa: ANN401
    if ("select",) in parts:
        return "fast-pwm"
    return "compare" if ("first",) in parts else "wide-compare"


def set_speed(way: Way) -> Iterator[tuple[str, Any]]:
    """
    Yield what must hold after ``...SetSpeed``.
    """
    call = SetSpeed(0, *map(way.number, way.arguments))
    code = verdict(call, way.facts)
    yield "the call returns what the model does", way.result == int(code)
    yield "a call makes no step", way.after.position == way.before.position
    if code < 0:
        yield "a refused call changes nothing but the status", same_but_status(way)
    elif stops(call):
        yield "a stop stops", z3.Not(way.after.is_in(RUNNING))
    else:
        millis: Any = way.number(way.before.values[CLOCK])
        yield from _started(way, Motion.of(call, 0, millis, way.facts))


def _started(way: Way, motion: Motion) -> Iterator[tuple[str, Any]]:
    after = way.after
    yield "the motor runs", after.is_in(RUNNING)
    yield "backward is backward", after.is_in(REVERSE) == (motion.direction < 0)
    yield "no limit in steps is none", after.is_in(ENDLESS) == (motion.steps_left is None)
    yield "the next interval is that of the speed", way.next_is_chosen
    if after.is_timed:
        yield from _hears(way)
        yield "the last motion is forgotten", z3.Not(after.left_alone)
    if motion.steps_left is not None:
        steps = term(motion.steps_left)
        yield "what is left is the limit", after.left == steps
        goes = z3.Extract(31, 0, steps * motion.direction)
        yield "the target is the limit away", after.of("target") == way.before.position + goes
    if after.has("eventAt"):
        yield from _started_events(way, motion)
    elif motion.millis_limit is not None:
        yield "the time limit is the limit", after.to_millis_end == term(motion.millis_limit)
        yield "it is looked at", after.is_in(THINK)


def _started_events(way: Way, motion: Motion) -> Iterator[tuple[str, Any]]:
    after = way.after
    limited = motion.millis_limit is not None
    yield "a time limit is one", after.is_in(LIMITED) == z3.BoolVal(limited)
    if limited:
        yield "the time limit is the limit", wide(after.of("limit")) == term(motion.millis_limit)
        yield "it counts from now", after.of("start") == way.before.values[CLOCK]
    yield "the interrupt looks at the clock at once", after.of("wake") == low_millis(after)
    updates = motion.updates
    yield (
        "update events are left as the model says",
        wide(after.of("updates")) == term(motion.updates_left),
    )
    if updates is not None:
        yield (
            "they change what they should",
            wide(after.of("modification")) == term(updates.modification),
        )
        yield "the first is one interval away", after.to_event == term(updates.due_at)


def update(way: Way) -> Iterator[tuple[str, Any]]:
    """
    Yield what must hold after one update event.
    """
    before, after = way.before, way.after
    names = ("control", "modification", "interval", "updates")
    control, modification, interval, left = (way.number(before.of(name)) for name in names)
    model = Updates(control, modification, interval, left, 0, way.library.min_top)  # due at 0
    virtual, stopped = model.apply(way.number(before.of("top")))
    yield "the virtual TOP is the model's", wide(after.of("top")) == term(virtual)
    yield (
        "the modification is the model's",
        wide(after.of("modification")) == term(model.modification),
    )
    yield "the events that are left are the model's", wide(after.of("updates")) == term(model.left)
    yield from position(way, NO_STEP)
    yield "the next interval is that of the new speed", way.next_is_chosen
    if not stopped:
        later = before.of("eventAt") + z3.Extract(31, 0, term(model.due_at))
        yield "the next event comes one interval after this one", after.of("eventAt") == later
    if after.has("next", "select"):
        waits = after.of("next", "select") != 0
        yield "what the next step sets is not put off", z3.Implies(waits, after.count == 1)


def boundary(way: Way) -> Iterator[tuple[str, Any]]:
    """
    Yield what must hold after the rare ways of a step interrupt.
    """
    before, after = way.before, way.after
    itself = way.machine.calls.count(f"{before.motor}Step")
    by_assembly = z3.And(
        before.entered_count == 0, z3.Not(before.is_in(THINK)), z3.Not(before.is_lapping)
    )
    yield from position(way, itself + z3.If(by_assembly, NO_STEP + 1, NO_STEP))
    silent = z3.BoolVal(val=False)
    if before.is_timed:
        silent = z3.And(before.is_in(RUNNING), before.patience <= 0)
        ended = z3.And(z3.Not(after.is_in(RUNNING)), after.left_alone)
        yield "a command time-out ends the motion", z3.Implies(silent, ended)
        same = after.left_alone == before.left_alone
        yield "nothing else looks like one", z3.Implies(z3.Not(silent), same)
    if before.has("eventAt"):
        yield from _wakes(way, silent)
        return
    moves = z3.And(before.is_in(RUNNING), z3.Not(before.is_lapping))
    running, limited = z3.And(moves, z3.Not(silent)), before.is_in(THINK)
    ended = z3.Not(after.is_in(RUNNING))
    until = before.to_millis_end
    yield (
        "a time limit ends when it has passed",
        z3.Implies(z3.And(running, limited), ended == (until <= 0)),
    )
    yield (
        "what is left of it stays",
        z3.Implies(z3.And(running, limited, z3.Not(ended)), after.to_millis_end == until),
    )
    laps = z3.And(before.is_in(RUNNING), before.is_lapping, limited)
    kept = z3.If(until > 0, after.to_millis_end == until, after.to_millis_end <= 0)
    yield "what is left of it stays in an interval, too, or it stays over", z3.Implies(laps, kept)


def _wakes(way: Way, silent: Any) -> Iterator[tuple[str, Any]]:  # noqa: ANN401
    before, after = way.before, way.after
    steps = z3.Not(before.is_lapping)  # else nothing is looked at yet
    looks = z3.And(after.is_in(RUNNING), after.is_in(CLOCKED), steps)
    ahead = wide(after.of("wake") - low_millis(after))
    yield (
        "the interrupt wakes up within the range of its comparison",
        z3.Implies(looks, ahead <= _FAR),
    )
    if before.is_timed:
        yield (
            "it wakes up before the command time-out ends",
            z3.Implies(looks, ahead <= before.patience),
        )
    yield (
        "it wakes up before a time limit ends",
        z3.Implies(
            z3.And(looks, after.is_in(LIMITED)),
            z3.Or(ahead == 0, ahead <= millis_left(before)),
        ),
    )
    control = before.of("control")
    timed = z3.And(control & IRQ_TIMING != 0, control & UPDATE_STEPS == 0)
    pending = z3.And(looks, timed, before.of("updates") != 0, before.to_event >= 0)
    yield "it wakes up before an update event", z3.Implies(pending, ahead <= before.to_event)
    yield (
        "a time limit ends when it has passed",
        z3.Implies(
            z3.And(
                before.is_in(RUNNING),
                before.is_in(LIMITED),
                before.entered_count != 0,
                z3.Not(silent),
                steps,
            ),
            after.is_in(RUNNING) == (millis_left(before) > 0),
        ),
    )


def millis_left_function(way: Way) -> Iterator[tuple[str, Any]]:
    """
    Yield what must hold of the result of ``...MillisLeft``.
    """
    left, far = millis_left(way.before), z3.BitVecVal(_FAR, wide(way.result).size())
    bounded = z3.If(left < 0, 0, z3.If(left > far, far, left))
    wanted = z3.If(way.before.is_in(LIMITED), bounded, far)
    yield "the milliseconds that are left, at most 32767", wide(way.result) == wanted


def until_event(way: Way) -> Iterator[tuple[str, Any]]:
    """
    Yield what must hold of the result of ``...UntilEvent``.
    """
    until = way.before.to_event
    yield "what is left until the event", wide(way.result) == z3.If(until < 0, 0, until)


def init(way: Way) -> Iterator[tuple[str, Any]]:
    """
    Yield what must hold after ``...Init``.
    """
    yield "the position is 0", way.after.position == 0
    yield "the motor stands", z3.Not(way.after.is_in(RUNNING))


def read_position(way: Way) -> Iterator[tuple[str, Any]]:
    """
    Yield what must hold of the result of ``...ReadPosition``.
    """
    yield "the position", way.result == way.before.position
    yield from position(way, NO_STEP)


def read_status(way: Way) -> Iterator[tuple[str, Any]]:
    """
    Yield what must hold of the result of ``...ReadStatus``.
    """
    before = way.before
    if before.has("eventAt"):
        over = z3.And(before.is_in(LIMITED), millis_left(before) <= 0)
    else:
        over = z3.And(before.is_in(RUNNING), before.is_in(THINK), before.to_millis_end <= 0)
    reached = before.of("status") & _REACHED != 0
    yield (
        "REACHED at the end of a time limit",
        z3.Implies(before.is_in(RUNNING), (way.result & _REACHED != 0) == z3.Or(reached, over)),
    )
    yield from position(way, NO_STEP)


def is_way(micrometres: Any, per_mm: Fraction, *, signed: bool) -> Any:  # noqa: ANN401
    """
    Tell whether the steps of so many *micrometres* fit 32 bits; *signed*: either way.
    """
    most = (1 << 31 if signed else 1 << 32) - 1
    longest = min(most, int(most * 1000 / per_mm))
    if not signed:
        return z3.ULE(micrometres, longest)
    return z3.And(micrometres <= longest, micrometres >= -longest)


def steps_of(micrometres: Any, steps: Any, per_mm: Fraction, *, signed: bool) -> Any:  # noqa: ANN401
    """
    Tell whether *steps* are those of *micrometres*, rounded; *signed*: either way.
    """
    per_um = per_mm / 1000
    extend = z3.SignExt if signed else z3.ZeroExt
    way, made = (extend(_EXACT, value) for value in (micrometres, steps))
    off = 2 * (made * per_um.denominator - way * per_um.numerator)
    return z3.And(off <= per_um.denominator, off >= -per_um.denominator)


def read_nanometres(way: Way) -> Iterator[tuple[str, Any]]:
    """
    Yield what must hold of the result of ``...ReadNanometres``, as far as 32 bits go.
    """
    yield metric_position(way.result, way.library.steps_per_mm[way.before.motor])
    yield from position(way, NO_STEP)


def metric_position(result: Any, per_mm: Fraction) -> tuple[str, Any]:  # noqa: ANN401
    """
    Return what must hold of *result*, the position `POSITION_READ` in nanometres.
    """
    nanometres = 1_000_000 / per_mm
    at, read = (z3.SignExt(_EXACT, value) for value in (POSITION_READ, result))
    exact = at * nanometres.numerator
    off = exact - read * nanometres.denominator
    end = nanometres.denominator << 31
    cut_off = z3.If(at < 0, -off, off)
    right = z3.And(cut_off >= 0, cut_off < nanometres.denominator)
    inside = z3.And(exact < end, exact >= -end)
    return "the position in nanometres, cut off", z3.Implies(inside, right)


def read_missed(way: Way) -> Iterator[tuple[str, Any]]:
    """
    Yield what must hold of the result of ``...ReadMissed``.
    """
    yield "the steps that came too late", way.result == way.before.of("missed")
    yield from position(way, NO_STEP)


def _hears(way: Way) -> Iterator[tuple[str, Any]]:
    timeout = way.library.timeouts[way.before.motor]
    yield "the command time-out begins anew", way.after.patience == timeout


def keep_alive(way: Way) -> Iterator[tuple[str, Any]]:
    """
    Yield what must hold after ``...KeepAlive``.
    """
    yield "nothing of the motion changes", same_but_status(way)
    yield from _hears(way)
    yield from position(way, NO_STEP)


def keeps_position(way: Way) -> Iterator[tuple[str, Any]]:
    """
    Yield what must hold of a call that makes no step.
    """
    yield from position(way, NO_STEP)


CLAIMS: dict[str, Callable[[Way], Iterator[tuple[str, Any]]]] = {
    "ShieldInit": init,
    "Init": init,
    "SetSpeed": set_speed,
    "TimerUpdateCheck": keeps_position,
    "ReadStatus": read_status,
    "ReadPosition": read_position,
    "ReadNanometres": read_nanometres,
    "ReadMissed": read_missed,
    "KeepAlive": keep_alive,
    "TimedOut": keeps_position,
    "Hold": keeps_position,
    "Release": keeps_position,
    "Update": update,
    "MillisLeft": millis_left_function,
    "UntilEvent": until_event,
    "boundary": boundary,
}
"""The claims by function, without the motor's name."""

"""
What happened to a motor in a scenario, in the order in which the model is told of it.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import IntEnum

from stepgen.devices import Board
from stepgen.reference.stimuli import (
    CallBack,
    Callbacks,
    ChannelSet,
    ClockOn,
    Hold,
    Init,
    KeepAlive,
    MillisTick,
    Release,
    SetSpeed,
    Stimulus,
    UpdateCheck,
)
from stepgen.verify.bench import Answer, CallKind
from stepgen.verify.subject import Subject
from stepgen.verify.trace import Trace


class Order(IntEnum):
    """
    What comes first in one cycle: a call sees the new millis, a clock is set by the call.
    """

    MILLIS = 0
    CALL = 1
    CLOCK = 2


@dataclass(frozen=True)
class Told:
    """
    The model is told of *stimulus*; *answer* is the call that it was, if it was one.
    """

    stimulus: Stimulus
    answer: Answer | None = None


@dataclass(frozen=True)
class StatusRead:
    """
    A call reads the status: in its first section with interrupts off.
    """

    answer: Answer


@dataclass(frozen=True)
class MissedRead:
    """
    The same call reads how many steps came too late: in its third section.
    """

    answer: Answer


@dataclass(frozen=True)
class PositionRead:
    """
    The same call reads the position: in its second section. Steps may come in between.
    """

    answer: Answer


@dataclass(frozen=True)
class TimeoutRead:
    """
    The same call reads whether the motor timed out: after the other sections, before its end.
    """

    answer: Answer


Happening = Told | StatusRead | PositionRead | MissedRead | TimeoutRead
Row = tuple[int, Order, Happening]


def happenings(
    subject: Subject, index: int, trace: Trace, answers: Sequence[Answer], board: Board
) -> Iterator[Row]:
    """
    Yield everything that happened to motor number *index*, each with its cycle, in no order.
    """
    for answer in answers:
        if answer.call.motor == index:
            yield from _rows_of_call(answer, trace)
            if subject.facts.tells_missed:
                yield from _rows_of_missed(answer, trace)
    starts = trace.clock_starts(subject.timer)
    if subject.channel is None:
        for start in starts:
            clock_on = ClockOn(start.cycle, start.prescaler, start.tcnt)
            yield start.cycle, Order.CLOCK, Told(clock_on)
    else:
        for one in trace.channel_sets(subject.channel, starts):
            if not one.in_interrupt:
                yield one.cycle, Order.CLOCK, Told(ChannelSet(one.cycle, one.ahead_cycles))
    vector = board.mcu.vector("TIMER0_OVF_vect").number
    for cycle, millis in trace.millis_ticks(vector, board.f_cpu_hz):
        yield cycle, Order.MILLIS, Told(MillisTick(cycle, millis))


def _rows_of_call(answer: Answer, trace: Trace) -> Iterator[Row]:
    """
    Yield what the call of *answer* does, at the cycles where it switches the interrupts off.
    """
    first = trace.commit(answer.begin_cycle, answer.end_cycle)
    if first is None:
        return
    cycle = first[0]
    second = trace.commit(answer.begin_cycle, answer.end_cycle, 1) or first
    stimulus = _stimulus(answer, cycle)
    if stimulus is not None:
        yield cycle, Order.CALL, Told(stimulus, answer)
        if answer.call.kind is CallKind.UPDATE_CHECK:
            yield second[0], Order.CALL, Told(CallBack(second[0]))
        return
    if answer.call.kind is not CallKind.READ:
        return
    yield cycle, Order.CALL, StatusRead(answer)
    yield second[0], Order.CALL, PositionRead(answer)
    yield answer.end_cycle, Order.CALL, TimeoutRead(answer)


def _rows_of_missed(answer: Answer, trace: Trace) -> Iterator[Row]:
    """
    Yield the reading of the missed steps, where the call of *answer* does so.
    """
    third = trace.commit(answer.begin_cycle, answer.end_cycle, 2)
    if answer.call.kind is CallKind.READ and third:
        yield third[0], Order.CALL, MissedRead(answer)


def _stimulus(answer: Answer, cycle: int) -> Stimulus | None:
    """
    Return what the model is told of the call of *answer*; nothing of one that only reads.
    """
    call = answer.call
    update = (call.modification, call.interval, call.count)
    stimuli: dict[CallKind, Stimulus] = {
        CallKind.SET_SPEED: SetSpeed(cycle, call.control, call.top, call.limit, *update),
        CallKind.HOLD: Hold(cycle),
        CallKind.RELEASE: Release(cycle),
        CallKind.INIT: Init(cycle),
        CallKind.UPDATE_CHECK: UpdateCheck(cycle),
        CallKind.KEEP_ALIVE: KeepAlive(cycle),
        CallKind.CALLBACKS: Callbacks(cycle, bool(call.control & 1), bool(call.control & 2)),
    }
    return stimuli.get(call.kind)

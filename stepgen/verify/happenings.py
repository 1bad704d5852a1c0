"""
What happened to a motor in a scenario, in the order in which the model is told of it.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import IntEnum

from stepgen.devices import Board
from stepgen.reference.facts import MotorFacts
from stepgen.reference.stimuli import (
    UINT32_STATES,
    AxisStimulus,
    CallBack,
    Callbacks,
    ChannelSet,
    ClearFault,
    ClockOn,
    EmergencyStop,
    Halt,
    Hold,
    Home,
    Init,
    KeepAlive,
    MillisTick,
    Move,
    MoveTo,
    QueueMoveTo,
    Release,
    RunOn,
    SetPace,
    SetPosition,
    SetSpeed,
    Stimulus,
    Stop,
    Switches,
    UpdateCheck,
)
from stepgen.verify.bench import SWITCH_BITS, Answer, CallKind
from stepgen.verify.subject import Subject
from stepgen.verify.trace import Trace


class Order(IntEnum):
    """
    What comes first in one cycle: a call sees the new millis, a clock is set by the call.

    What is pressed from outside comes before all, since an interrupt that begins there sees it.
    """

    PRESS = 0
    MILLIS = 1
    CALL = 2
    CLOCK = 3


@dataclass(frozen=True)
class Told:
    """
    The model is told of *stimulus*; *answer* is the call that it was, if it was one.
    """

    stimulus: Stimulus | AxisStimulus
    answer: Answer | None = None


@dataclass(frozen=True)
class StatusRead:
    """
    A call reads the status. Steps may come before it reads the next thing.
    """

    answer: Answer


@dataclass(frozen=True)
class PositionRead:
    """
    The same call reads the position.
    """

    answer: Answer


@dataclass(frozen=True)
class MissedRead:
    """
    The same call reads how many steps came too late.
    """

    answer: Answer


@dataclass(frozen=True)
class TimeoutRead:
    """
    The same call reads whether the motor timed out.
    """

    answer: Answer


@dataclass(frozen=True)
class TargetRead:
    """
    The same call reads where an axis goes.
    """

    answer: Answer


@dataclass(frozen=True)
class DistanceRead:
    """
    The same call reads how far it is to there.
    """

    answer: Answer


@dataclass(frozen=True)
class RunningRead:
    """
    The same call reads whether the axis is under way.
    """

    answer: Answer


@dataclass(frozen=True)
class FaultRead:
    """
    The same call reads why an axis moves no more.
    """

    answer: Answer


@dataclass(frozen=True)
class HomedRead:
    """
    The same call reads whether the axis has found home.
    """

    answer: Answer


@dataclass(frozen=True)
class PressedRead:
    """
    The same call reads which switches are pressed.
    """

    answer: Answer


Read = (
    StatusRead
    | PositionRead
    | MissedRead
    | TimeoutRead
    | TargetRead
    | DistanceRead
    | RunningRead
    | FaultRead
    | HomedRead
    | PressedRead
)
Happening = Told | Read
Row = tuple[int, Order, Happening]


def happenings(
    subject: Subject, index: int, trace: Trace, answers: Sequence[Answer], board: Board
) -> Iterator[Row]:
    """
    Yield everything that happened to motor number *index*, each with its cycle, in no order.
    """
    for answer in answers:
        if answer.call.motor == index:
            yield from _rows_of_call(answer, trace, subject.facts)
    if subject.channel is None:
        for start in trace.clock_starts(subject.timer):
            clock_on = ClockOn(start.cycle, start.prescaler, start.tcnt)
            yield start.cycle, Order.CLOCK, Told(clock_on)
    else:
        for one in trace.channel_sets(subject.channel, subject.timer):
            if not one.in_interrupt:
                yield one.cycle, Order.CLOCK, Told(ChannelSet(one.cycle, one.ahead_cycles))
    vector = board.mcu.vector("TIMER0_OVF_vect").number
    for cycle, millis in trace.millis_ticks(vector, board.f_cpu_hz):
        yield cycle, Order.MILLIS, Told(MillisTick(cycle, millis))


def masked_sections(kind: CallKind, facts: MotorFacts) -> int:
    """
    Return how many times a call of *kind* has interrupts off, one after the other.
    """
    if kind is CallKind.READ:
        return len(masked_reads(facts))
    # An event, then what is called back; one callback, then the other.
    return 2 if kind in (CallKind.UPDATE_CHECK, CallKind.CALLBACKS) else 1


def masked_reads(facts: MotorFacts) -> tuple[type[Read], ...]:
    """
    Return what a call reads, in its order, each with interrupts off for a moment.
    """
    missed = (MissedRead,) if facts.tells_missed else ()
    if facts.ladder is not None:
        stops = facts.end_stops
        fault = (FaultRead,) if stops else ()
        homed = (HomedRead,) if stops and stops.homing else ()
        return (PositionRead, TargetRead, DistanceRead, RunningRead, *missed, *fault, *homed)
    timed = (TimeoutRead,) if facts.command_timeout_millis is not None else ()
    return (StatusRead, PositionRead, *missed, *timed)


def _rows_of_call(answer: Answer, trace: Trace, facts: MotorFacts) -> Iterator[Row]:
    """
    Yield what the call of *answer* does, at the cycles where it switches the interrupts off.
    """
    kind, begin, end = answer.call.kind, answer.begin_cycle, answer.end_cycle
    if kind is CallKind.PRESS:
        there = facts.end_stops.switches if facts.end_stops else frozenset()
        bits = answer.call.control
        pressed = frozenset(end for end in there if bits & SWITCH_BITS[end])
        yield begin, Order.PRESS, Told(Switches(begin, pressed))
        return
    found = (trace.commit(begin, end, which) for which in range(masked_sections(kind, facts)))
    cycles = [section[0] for section in found if section]
    if kind is CallKind.SET_PACE and not cycles and answer.result:
        cycles = [end]  # it was refused for what it asks, and needed nothing else to know
    if kind is CallKind.READ:
        rows = zip(cycles, masked_reads(facts), strict=False)
        yield from ((cycle, Order.CALL, read(answer)) for cycle, read in rows)
        if facts.end_stops and facts.end_stops.switches:
            yield end, Order.CALL, PressedRead(answer)  # they stay as they are meanwhile
    elif cycles and (stimulus := _stimulus(answer, cycles[0])):
        yield cycles[0], Order.CALL, Told(stimulus, answer)
        if kind is CallKind.UPDATE_CHECK:
            yield cycles[-1], Order.CALL, Told(CallBack(cycles[-1]))


def _stimulus(answer: Answer, cycle: int) -> Stimulus | AxisStimulus | None:
    """
    Return what the model is told of the call of *answer*; nothing of one that is of no motor.
    """
    call = answer.call
    update = (call.modification, call.interval, call.count)
    stimuli: dict[CallKind, Stimulus | AxisStimulus] = {
        CallKind.SET_SPEED: SetSpeed(cycle, call.control, call.top, call.limit, *update),
        CallKind.HOLD: Hold(cycle),
        CallKind.RELEASE: Release(cycle),
        CallKind.INIT: Init(cycle),
        CallKind.UPDATE_CHECK: UpdateCheck(cycle),
        CallKind.KEEP_ALIVE: KeepAlive(cycle),
        CallKind.CALLBACKS: Callbacks(cycle, bool(call.control & 1), bool(call.control & 2)),
        CallKind.MOVE_TO: MoveTo(cycle, call.steps),
        CallKind.MOVE: Move(cycle, call.steps),
        CallKind.RUN_FORWARD: RunOn(cycle, 1),
        CallKind.RUN_BACKWARD: RunOn(cycle, -1),
        CallKind.STOP: Stop(cycle),
        CallKind.HALT: Halt(cycle),
        CallKind.SET_PACE: SetPace(cycle, call.top % UINT32_STATES),
        CallKind.QUEUE_MOVE_TO: QueueMoveTo(cycle, call.steps),
        CallKind.SET_POSITION: SetPosition(cycle, call.steps),
        CallKind.HOME: Home(cycle),
        CallKind.EMERGENCY_STOP: EmergencyStop(cycle),
        CallKind.CLEAR_FAULT: ClearFault(cycle),
    }
    return stimuli.get(call.kind)

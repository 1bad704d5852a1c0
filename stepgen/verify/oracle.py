"""
The oracle: the reference model, fed with what happened on the chip.
"""

from bisect import bisect_left
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from enum import IntEnum

from stepgen.plan.model import Plan
from stepgen.reference.axis import Turn
from stepgen.reference.integer import MotorModel
from stepgen.reference.sharing import Need
from stepgen.reference.stimuli import (
    Callbacks,
    ClockOn,
    Edge,
    Hold,
    Init,
    MillisTick,
    Release,
    SetSpeed,
    Stimulus,
    UpdateCheck,
)
from stepgen.verify.bench import Answer, CallKind
from stepgen.verify.subject import Subject
from stepgen.verify.trace import Run, Trace

_MOST_FINDINGS = 5
WAKE_CYCLES = 4  # more, when the interrupt wakes the chip from idle sleep (datasheet)


@dataclass
class Comparison:
    """
    How one motor did in one scenario.

    Args:
        motor: Its name.
        findings: What differs from the model, in words; empty if nothing does.
        steps: How many steps were compared.
        jitter_cycles: The latest edge, counted from its deadline.
        longest_isr_cycles: The longest run of its step interrupt.
        isr_cycles: All runs together.
        needs: When the motor needs current, as the model says; turns: when it turns round.
    """

    motor: str
    findings: list[str] = field(default_factory=list)
    steps: int = 0
    jitter_cycles: int = 0
    longest_isr_cycles: int = 0
    isr_cycles: int = 0
    needs: tuple[Need, ...] = ()
    turns: tuple[Turn, ...] = ()

    def report(self, finding: str) -> None:
        """
        Note that something differs; after a few, more of them would tell nothing new.
        """
        if len(self.findings) < _MOST_FINDINGS:
            self.findings.append(finding)


@dataclass(frozen=True)
class Scene:
    """
    A scenario's trace, its calls, and what they were compiled from.
    """

    trace: Trace
    answers: Sequence[Answer]
    plan: Plan
    until_cycle: int
    tolerance_cycles: int = 0


class _Order(IntEnum):
    """
    What comes first in one cycle: a call sees the new millis, a clock is set by the call.
    """

    MILLIS = 0
    CALL = 1
    CLOCK = 2


@dataclass(frozen=True)
class _Told:
    """
    The model is told of *stimulus*; *answer* is the call that it was, if it was one.
    """

    stimulus: Stimulus
    answer: Answer | None = None


@dataclass(frozen=True)
class _StatusRead:
    """
    A call reads the status: in its first section with interrupts off.
    """

    answer: Answer


@dataclass(frozen=True)
class _PositionRead:
    """
    The same call reads the position: in its second section. Steps may come in between.
    """

    answer: Answer


_Happening = _Told | _StatusRead | _PositionRead
_Row = tuple[int, _Order, _Happening]


class Oracle:
    """
    The model of motor number *index*, told and asked in the order of cycles.
    """

    def __init__(self, subject: Subject, index: int, scene: Scene, runs: Sequence[Run]) -> None:
        self._subject = subject
        self._index = index
        self._scene = scene
        self._raised = [run.raised for run in runs]
        self._runs = runs
        self._model = MotorModel(subject.facts, self._service_cycle)
        self._edges: list[Edge] = []
        self._millis = 0

    def predict(self, result: Comparison) -> list[Edge]:
        """
        Return all edges of the model; report each code, status or position that differs.
        """
        for cycle, _, happening in sorted(self._rows(), key=lambda row: row[:2]):
            if cycle > self._scene.until_cycle:
                break
            match happening:
                case _Told(stimulus, answer):
                    self._tell(stimulus, answer, result)
                case _StatusRead(answer):
                    self._compare_status(cycle, answer, result)
                case _PositionRead(answer):
                    self._compare_position(cycle, answer, result)
        self._advance(self._scene.until_cycle)
        return self._edges

    @property
    def needs(self) -> tuple[Need, ...]:
        """
        Return when the motor needs current, as far as the model has come.
        """
        return self._model.needs

    @property
    def turns(self) -> tuple[Turn, ...]:
        """
        Return when DIR changes, as far as the model has come.
        """
        return self._model.turns

    def _service_cycle(self, deadline: int) -> int:
        tolerance = self._scene.tolerance_cycles
        place = bisect_left(self._raised, deadline - tolerance)
        if place < len(self._runs) and self._raised[place] <= deadline + tolerance:
            return self._runs[place].entered
        # Nobody served it. A call that masks the interrupts before it could be served comes first.
        return self._scene.trace.served_from(deadline)

    def _advance(self, cycle: int) -> None:
        self._edges.extend(self._model.advance(cycle))

    def _tell(self, stimulus: Stimulus, answer: Answer | None, result: Comparison) -> None:
        if isinstance(stimulus, MillisTick):
            self._millis = stimulus.millis
        code = self._model.apply(stimulus)
        if answer is not None and code != answer.result:
            result.report(f"{answer.call} returned {answer.result}, the model says {int(code)}")

    def _compare_status(self, cycle: int, answer: Answer, result: Comparison) -> None:
        status = int(self._model.status_at(cycle, self._millis))
        if status != answer.status:
            result.report(
                f"status {answer.status:#04x} at cycle {cycle}, the model says {status:#04x}"
            )

    def _compare_position(self, cycle: int, answer: Answer, result: Comparison) -> None:
        self._advance(cycle)
        position = self._model.position
        if answer.position != position:
            result.report(f"position {answer.position} at cycle {cycle}, the model says {position}")

    def _rows(self) -> Iterator[_Row]:
        """
        Yield everything that happened to the motor, each with its cycle, in no order.
        """
        trace, subject = self._scene.trace, self._subject
        for answer in self._scene.answers:
            if answer.call.motor == self._index:
                yield from _rows_of_call(answer, trace)
        for start in trace.clock_starts(subject.timer):
            clock_on = ClockOn(start.cycle, start.prescaler, start.tcnt)
            yield start.cycle, _Order.CLOCK, _Told(clock_on)
        board = self._scene.plan.board
        vector = board.mcu.vector("TIMER0_OVF_vect").number
        for cycle, millis in trace.millis_ticks(vector, board.f_cpu_hz):
            yield cycle, _Order.MILLIS, _Told(MillisTick(cycle, millis))


def _rows_of_call(answer: Answer, trace: Trace) -> Iterator[_Row]:
    """
    Yield what the call of *answer* does, at the cycles where it switches the interrupts off.
    """
    first = trace.commit(answer.begin_cycle, answer.end_cycle)
    if first is None:
        return
    cycle = first[0]
    stimulus = _stimulus(answer, cycle)
    if stimulus is not None:
        yield cycle, _Order.CALL, _Told(stimulus, answer)
        return
    second = trace.commit(answer.begin_cycle, answer.end_cycle, 1) or first
    yield cycle, _Order.CALL, _StatusRead(answer)
    yield second[0], _Order.CALL, _PositionRead(answer)


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
        CallKind.CALLBACKS: Callbacks(cycle, bool(call.control & 1), bool(call.control & 2)),
    }
    return stimuli.get(call.kind)

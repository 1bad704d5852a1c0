"""
The oracle: the reference model, fed with what happened on the chip.
"""

import re
from bisect import bisect_left
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from stepgen.plan.model import Plan
from stepgen.reference.axis import Turn
from stepgen.reference.integer import MotorModel
from stepgen.reference.sharing import Need
from stepgen.reference.stimuli import AxisStimulus, Edge, MillisTick, Stimulus
from stepgen.reference.timer import COMPARE_PRESCALER, TimerSetting
from stepgen.reference.trapezoid import Start, TrapezoidModel
from stepgen.verify.bench import SWITCH_BITS, Answer
from stepgen.verify.happenings import (
    DistanceRead,
    FaultRead,
    HomedRead,
    MissedRead,
    PositionRead,
    PressedRead,
    Read,
    RunningRead,
    StatusRead,
    TargetRead,
    TimeoutRead,
    Told,
    happenings,
)
from stepgen.verify.subject import Subject
from stepgen.verify.trace import Run, Trace

_MOST_OF_A_KIND = 3
_AT_ONCE_CYCLES = 32  # an interrupt asked for at once comes within so many, or waits already
_NUMBER = re.compile(r"\d+")
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
        intervals: The interval after each step, by the step's deadline, as the model says.
    """

    motor: str
    findings: list[str] = field(default_factory=list)
    steps: int = 0
    jitter_cycles: int = 0
    longest_isr_cycles: int = 0
    isr_cycles: int = 0
    needs: tuple[Need, ...] = ()
    intervals: Mapping[int, TimerSetting] = field(default_factory=dict)
    turns: tuple[Turn, ...] = ()

    def report(self, finding: str) -> None:
        """
        Note that something differs; after a few of a kind, more of them would tell nothing new.

        Findings are of a kind if they differ in numbers only.
        """
        kind = _NUMBER.sub("", finding)
        alike = sum(_NUMBER.sub("", other) == kind for other in self.findings)
        if alike < _MOST_OF_A_KIND:
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
        self._sets = _first_sets(subject, scene.trace, runs)
        self._model = self._made_model()
        # Each model understands what happens to its kind of motor.
        self._apply: Callable[[Any], int] = self._model.apply
        self._edges: list[Edge] = []
        self._millis = 0
        self._own: set[int] = set()
        self._later: dict[int, int] = {}
        self._again: dict[int, Run] = {}

    def _made_model(self) -> MotorModel | TrapezoidModel:
        facts = self._subject.facts
        if not self._subject.is_axis:
            return MotorModel(facts, self._service_cycle, set_cycle=self._set_cycle)
        return TrapezoidModel(
            facts,
            self._service_cycle,
            set_cycle=self._set_cycle,
            again_cycle=self._again_cycle,
        )

    def predict(self, result: Comparison) -> list[Edge]:
        """
        Return all edges of the model; report each code, status or position that differs.
        """
        scene = self._scene
        rows = happenings(self._subject, self._index, scene.trace, scene.answers, scene.plan.board)
        for cycle, _, happening in sorted(rows, key=lambda row: row[:2]):
            if cycle > self._scene.until_cycle:
                break
            match happening:
                case Told(stimulus, answer):
                    self._tell(stimulus, answer, result)
                case _:
                    self._compare_read(cycle, happening, result)
        self._advance(self._scene.until_cycle)
        return self._edges

    @property
    def intervals(self) -> Mapping[int, TimerSetting]:
        """
        Return the interval after each step, by the step's deadline, as far as the model has come.
        """
        return self._model.intervals

    @property
    def starts(self) -> tuple[Start, ...]:
        """
        Return the calls that began a leg of an axis from rest, as far as the model has come.
        """
        return self._model.starts if isinstance(self._model, TrapezoidModel) else ()

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

    def served(self, runs: Sequence[Run]) -> list[Run]:
        """
        Return *runs*, those that served a later deadline in place of their own as if raised at it.

        Those that only met a switch are left out: the step of their deadline is that of the next.
        """
        later = self._later
        runs = [run for run in runs if run.raised not in self._again]
        return [
            run._replace(
                raised=later[run.raised],
                serves_later=True,
                put_off=later[run.raised] in self._again,
            )
            if run.raised in later
            else run
            for run in runs
        ]

    def _service_cycle(self, deadline: int) -> int:
        tolerance = self._scene.tolerance_cycles
        place = bisect_left(self._raised, deadline - tolerance)
        if self._is_own(place, deadline + tolerance):
            self._own.add(self._raised[place])
            return self._runs[place].entered
        asked = self._asked_for(place, deadline)
        if asked is not None:
            self._later[asked.raised] = deadline
            return asked.entered
        if place and self._serves_later(self._runs[place - 1], deadline):
            before = self._runs[place - 1]
            self._later[before.raised] = deadline
            return max(deadline, before.entered)
        # Nobody served it. A call that masks the interrupts before it could be served comes first.
        return self._scene.trace.served_from(deadline)

    def _again_cycle(self, deadline: int) -> int:
        """
        Return when the interrupt comes that the one of *deadline* asks for, since it met a switch.
        """
        if deadline in self._again:
            return self._again[deadline].entered
        met = self._service_cycle(deadline)
        place = next((n for n, run in enumerate(self._runs) if run.entered == met), None)
        if place is None or place + 1 >= len(self._runs):
            return self._scene.until_cycle + 1
        own, following = self._runs[place], self._runs[place + 1]
        if own.writes or following.raised > own.left + _AT_ONCE_CYCLES:
            return own.left + _AT_ONCE_CYCLES  # it did not ask for one
        self._again[own.raised] = following
        self._later[following.raised] = deadline
        return following.entered

    def _is_own(self, place: int, latest_cycle: int) -> bool:
        """
        Tell whether run number *place* was raised by then, and not for an earlier deadline.
        """
        if place >= len(self._runs) or self._raised[place] > latest_cycle:
            return False
        return self._subject.channel is None or self._raised[place] not in self._later

    def _asked_for(self, place: int, deadline: int) -> Run | None:
        """
        Return the run, number *place* or later, that came since the run before saw *deadline* gone.

        It came at once. Where several steps were passed, those before it have runs of their own.
        """
        for number in range(max(place, 1), len(self._runs)):
            run, before = self._runs[number], self._runs[number - 1]
            if self._later.get(run.raised, deadline) != deadline:
                continue
            set_cycle = self._sets.get(before.entered)
            is_passed = set_cycle is not None and deadline <= set_cycle
            at_once = run.raised <= before.left + _AT_ONCE_CYCLES
            return run if is_passed and at_once and run.raised not in self._own else None
        return None

    def _set_cycle(self, deadline: int) -> int | None:
        """
        Return when the interrupt that served *deadline* has set its channel for the next.
        """
        put_off = deadline in self._again
        serve = self._again_cycle if put_off else self._service_cycle
        return self._sets.get(serve(deadline))

    def _serves_later(self, run: Run, deadline: int) -> bool:
        """
        Tell whether *run*, raised for something that is no deadline, made the step of *deadline*.

        Only one that began so late that its own step would be missed does so; otherwise it would
        explain every step that comes a little early.
        """
        overrun = self._subject.facts.overrun_cycles
        if overrun is None or run.entered - run.raised < overrun - COMPARE_PRESCALER:
            return False
        return run.raised not in self._own and any(write.cycle > deadline for write in run.writes)

    def _advance(self, cycle: int) -> None:
        self._edges.extend(self._model.advance(cycle))

    def _tell(
        self, stimulus: Stimulus | AxisStimulus, answer: Answer | None, result: Comparison
    ) -> None:
        if isinstance(stimulus, MillisTick):
            self._millis = stimulus.millis
        code = self._apply(stimulus)
        if answer is not None and code != answer.result:
            result.report(f"{answer.call} returned {answer.result}, the model says {int(code)}")

    def _compare_read(self, cycle: int, read: Read, result: Comparison) -> None:
        """
        Compare what the sketch was told at *cycle* with what the model knows then.
        """
        self._advance(cycle)
        answer, model = read.answer, self._model
        match read, model:
            case StatusRead(), MotorModel():
                status = int(model.status_at(cycle, self._millis))
                text, seen, known = "status {:#04x}", answer.status, status
            case TimeoutRead(), MotorModel():
                text, seen, known = "timed out {}", answer.timed_out, int(model.timed_out)
            case PositionRead(), _:
                text, seen, known = "position {}", answer.position, model.position
            case MissedRead(), _:
                text, seen, known = "{} missed", answer.missed, model.overruns
            case _, TrapezoidModel():
                text, seen, known = _read_of_axis(read, model)
            case _:
                raise TypeError(f"no motor of this kind can be asked for {read}")
        if seen != known:
            told = text.format(seen)
            number = "{:#04x}" if isinstance(read, StatusRead) else "{}"
            result.report(f"{told} at cycle {cycle}, the model says {number.format(known)}")


def _read_of_axis(read: Read, model: TrapezoidModel) -> tuple[str, int, int]:
    """
    Return what was read of an axis, in words, what it was, and what *model* says.
    """
    answer = read.answer
    match read:
        case TargetRead():
            return "target {}", answer.target, model.target
        case DistanceRead():
            return "distance {}", answer.distance, model.distance
        case RunningRead():
            return "running {}", answer.running, int(model.running)
        case FaultRead():
            return "fault {}", answer.fault, int(model.fault)
        case HomedRead():
            return "homed {}", answer.homed, int(model.homed)
        case PressedRead():
            bits = sum(SWITCH_BITS[end] for end in model.pressed)
            return "switches {}", answer.pressed, bits
        case _:
            raise TypeError(f"no axis can be asked for {read}")


def _first_sets(subject: Subject, trace: Trace, runs: Sequence[Run]) -> dict[int, int]:
    """
    Return when each of *runs* first set the motor's channel, by when it was entered.
    """
    if subject.channel is None:
        return {}
    sets = [
        one.cycle for one in trace.channel_sets(subject.channel, subject.timer) if one.in_interrupt
    ]
    found = {}
    for run in runs:
        place = bisect_left(sets, run.entered)
        if place < len(sets) and sets[place] <= run.left:
            found[run.entered] = sets[place]
    return found

"""
Running trials of hazards one after the other on one simulated chip, and judging them.
"""

from bisect import bisect_left
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from stepgen.plan.model import Plan
from stepgen.spec import LoadedSpec
from stepgen.verify.bench import APPROACH_CYCLES, Answer, Bench, Call, CallKind, Loop
from stepgen.verify.events import Events, Kind
from stepgen.verify.runner import Outcome, judge
from stepgen.verify.scenarios import Action, Scenario, Wait
from stepgen.verify.simulators import SIMAVR, Simulator
from stepgen.verify.subject import Subject, subjects
from stepgen.verify.trace import Run
from stepgen.verify.trials import Trial, Way

_RECENT_EVENTS = 200
_TICK_CYCLES = 64 * 256  # timer 0 of the Arduino core
_NEAR_CYCLES = 100  # update events of the interrupt may move the step a little


@dataclass(frozen=True)
class Met:
    """
    A trial that was made.

    Args:
        trial: What was to be done.
        offset: The offset that was reached: what the interrupt of the step itself took is taken
            off, since the call may begin later only because that interrupt came first.
        cycles: How long the calls of the command took, from the first one's begin.
    """

    trial: Trial
    offset: int
    cycles: int


@dataclass(frozen=True)
class _Meeting:
    """
    A trial as it happened: its calls, and the cycle at which the step was due.
    """

    trial: Trial
    answers: Sequence[Answer]
    deadline_cycle: int

    def judged(self, runs: Sequence[Run], raised: Sequence[int]) -> Met:
        """
        Return what was reached, from the *runs* of the step interrupt and when each was *raised*.
        """
        begin = self.answers[0].begin_cycle
        offset = begin - self.deadline_cycle
        place = bisect_left(raised, self.deadline_cycle - _NEAR_CYCLES)
        if place < len(raised) and raised[place] <= self.deadline_cycle + _NEAR_CYCLES:
            run = runs[place]
            # The bench sees a call that is interrupted as it begins within the response.
            offset = begin - run.raised - max(0, min(run.left, begin) - run.entered)
        return Met(self.trial, offset, self.answers[-1].end_cycle - begin)


@dataclass
class HazardRun:
    """
    A chip on which trials follow each other; what they do is kept as the actions of a scenario.
    """

    bench: Bench
    subject: Subject
    index: int
    actions: list[Action] = field(default_factory=list)
    meetings: list[_Meeting] = field(default_factory=list)

    def run(self, trial: Trial) -> None:
        """
        Start, let the command meet the step, read, and switch everything off again.
        """
        deadline = self._start(trial.way)
        self._wait_until(deadline + trial.offset)
        answers = [answer for action in trial.command.actions if (answer := self._do(action))]
        self.meetings.append(_Meeting(trial, answers, deadline))
        self._wait(trial.settle_cycles + max(0, deadline - self.bench.due_cycle))
        self._do(Call(CallKind.READ, self.index))
        self._wait(APPROACH_CYCLES)
        self._do(Call(CallKind.INIT if self.subject.is_axis else CallKind.SET_SPEED, self.index))
        self._wait(APPROACH_CYCLES)
        self._do(Call(CallKind.READ, self.index))
        self._wait(APPROACH_CYCLES)

    def _start(self, way: Way) -> int:
        """
        Start the motor; return when the step is due that the command is to meet.
        """
        if way.after_tick_cycles is not None:
            self._wait(_TICK_CYCLES + APPROACH_CYCLES)  # so that there was one
            self._wait_until(self._next_tick() + way.after_tick_cycles)
        self._do(way.start)
        period = self.subject.facts.setting(way.start.top).period_cycles if way.start.top else 0
        self._wait(way.first_cycles + way.second_cycles // 2 + APPROACH_CYCLES)
        deadline = self._last_step() + way.from_first(period)
        if way.again:
            self._wait_until(deadline - way.period_cycles // 2)
            self._do(way.again)
        return deadline

    def _next_tick(self) -> int:
        """
        Return when ``millis()`` goes on next, as far ahead as a call must be prepared.
        """
        vector = self.bench.plan.board.mcu.vector("TIMER0_OVF_vect").number
        last = _raised(self._recent(), vector)
        ahead = self.bench.due_cycle + APPROACH_CYCLES - last
        return last + -(-ahead // _TICK_CYCLES) * _TICK_CYCLES

    def _last_step(self) -> int:
        """
        Return when the interrupt was raised that last wrote to the motor's wires.
        """
        recent = self._recent()
        ports = {port.letter: port.port.address for port in self.bench.plan.board.mcu.ports}
        own = [ports[letter] for letter in self.subject.masks]
        writes = (recent["kind"] == Kind.PORT) & np.isin(recent["source"], own)
        last = int(np.flatnonzero(writes)[-1])
        return _raised(recent[:last], self.subject.vector)

    def _recent(self) -> Events:
        recent: Events = self.bench.events()[-_RECENT_EVENTS:]
        return recent

    def _do(self, action: Action) -> Answer | None:
        if isinstance(action, Wait):
            self._wait(action.cycles)
            return None
        self.actions.append(action)
        return self.bench.call(action)

    def _wait(self, cycles: int) -> None:
        before = self.actions[-1] if self.actions else None
        if isinstance(before, Wait):
            self.actions[-1] = Wait(before.cycles + cycles)
        else:
            self.actions.append(Wait(cycles))
        self.bench.wait(cycles)

    def _wait_until(self, cycle: int) -> None:
        self._wait(max(0, cycle - self.bench.due_cycle))


def _raised(events: Events, vector: int) -> int:
    """
    Return when the last run of the interrupt *vector* in *events* was raised.
    """
    entered = (events["kind"] == Kind.ISR_ENTER) & (events["source"] == vector)
    return int(events["since"][np.flatnonzero(entered)[-1]])


@dataclass(frozen=True)
class HazardOutcome:
    """
    How a row of trials went: as the outcome of a scenario, and trial by trial.
    """

    outcome: Outcome
    met: tuple[Met, ...]


def run_hazards(
    loaded: LoadedSpec,
    plan: Plan,
    elf: Path,
    trials: Iterable[tuple[int, Trial]],
    *,
    name: str = "hazards",
    simulator: Simulator = SIMAVR,
) -> HazardOutcome:
    """
    Run *trials*, each with the number of its motor, one after the other, and judge them all.

    Raises:
        StepgenError: The sketch crashed or hangs.
    """
    every = subjects(loaded, plan, elf)
    actions: list[Action] = []
    with Bench(plan, elf, simulator) as bench:
        bench.set_loop(Loop.EXACT)
        runs = [HazardRun(bench, subject, i, actions) for i, subject in enumerate(every)]
        for index, trial in trials:
            runs[index].run(trial)
        outcome = judge(bench, loaded, Scenario(name, Loop.EXACT, tuple(actions)))
    met: list[Met] = []
    for run in runs:
        seen = outcome.trace.runs(run.subject.vector)
        raised = [one.raised for one in seen]
        met += [meeting.judged(seen, raised) for meeting in run.meetings]
    return HazardOutcome(outcome, tuple(met))

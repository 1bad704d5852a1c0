"""
Running trials of hazards one after the other on one simulated chip, and judging them.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from stepgen.plan.model import Plan
from stepgen.spec import LoadedSpec
from stepgen.verify.bench import APPROACH_CYCLES, Answer, Bench, Call, CallKind, Loop
from stepgen.verify.events import Events, Kind
from stepgen.verify.hazards import Command, Trial, Way
from stepgen.verify.runner import Outcome, judge
from stepgen.verify.scenarios import Action, Scenario, Wait
from stepgen.verify.simulators import SIMAVR, Simulator
from stepgen.verify.subject import Subject, subjects
from stepgen.verify.trace import Run

_RECENT_EVENTS = 200
_NEAR_CYCLES = 100  # update events of the interrupt may move the step a little


@dataclass(frozen=True)
class Meeting:
    """
    A trial as it happened: the call, and the cycle at which the step was due.
    """

    trial: Trial
    answer: Answer
    deadline_cycle: int

    def offset(self, runs: Sequence[Run]) -> int:
        """
        Return the offset that was reached, from the *runs* of the step interrupt.

        What the interrupt itself took is taken off: the call may begin after it only because the
        interrupt came first.
        """
        near = [run for run in runs if abs(run.raised - self.deadline_cycle) <= _NEAR_CYCLES]
        begin = self.answer.begin_cycle
        if not near:
            return begin - self.deadline_cycle
        # The bench sees the begin of a call that is interrupted at once within the response.
        taken = max(0, min(near[0].left, begin) - near[0].entered)
        return begin - near[0].raised - taken


@dataclass
class HazardRun:
    """
    A chip on which trials follow each other; what they do is kept as the actions of a scenario.
    """

    bench: Bench
    subject: Subject
    index: int
    actions: list[Action] = field(default_factory=list)
    meetings: list[Meeting] = field(default_factory=list)

    def run(self, trial: Trial) -> None:
        """
        Start, let the command meet the step, read, and switch everything off again.
        """
        deadline = self._start(trial.way)
        self._wait_until(deadline + trial.offset)
        answers = [self._do(action) for action in trial.command.actions]
        first = next(answer for answer in answers if answer)
        self.meetings.append(Meeting(trial, first, deadline))
        self._wait(trial.settle_cycles + max(0, deadline - self.bench.due_cycle))
        self._do(Call(CallKind.READ, self.index))
        self._wait(APPROACH_CYCLES)
        self._do(Call(CallKind.SET_SPEED, self.index))
        self._wait(APPROACH_CYCLES)
        self._do(Call(CallKind.READ, self.index))
        self._wait(APPROACH_CYCLES)

    def _start(self, way: Way) -> int:
        """
        Start the motor; return when the step is due that the command is to meet.
        """
        self._do(way.start)
        period = self.subject.facts.setting(way.start.top).period_cycles
        self._wait(period + period // 2 + APPROACH_CYCLES)
        deadline = self._last_step() + (way.meets - 1) * period
        if way.again:
            self._wait_until(deadline - period // 2)
            self._do(way.again)
        return deadline

    def _last_step(self) -> int:
        """
        Return when the interrupt was raised that last wrote to the motor's wires.
        """
        recent: Events = self.bench.events()[-_RECENT_EVENTS:]
        letters = {f"{port.letter}": port.port.address for port in self.bench.plan.board.mcu.ports}
        own = [letters[letter] for letter in self.subject.masks]
        writes = (recent["kind"] == Kind.PORT) & np.isin(recent["source"], own)
        last = int(np.flatnonzero(writes)[-1])
        entered = (recent["kind"] == Kind.ISR_ENTER) & (recent["source"] == self.subject.vector)
        return int(recent["since"][np.flatnonzero(entered[:last])[-1]])

    def _do(self, action: Action) -> Answer | None:
        if isinstance(action, Wait):
            self._wait(action.cycles)
            return None
        self.actions.append(action)
        return self.bench.call(action)

    def _wait(self, cycles: int) -> None:
        self.actions.append(Wait(cycles))
        self.bench.wait(cycles)

    def _wait_until(self, cycle: int) -> None:
        self._wait(max(0, cycle - self.bench.due_cycle))


@dataclass(frozen=True)
class HazardOutcome:
    """
    How a row of trials went: as a scenario, and which offsets they reached.
    """

    outcome: Outcome
    reached: tuple[tuple[Trial, int], ...]


def run_hazards(
    loaded: LoadedSpec,
    plan: Plan,
    elf: Path,
    trials: Iterable[tuple[int, Trial]],
    simulator: Simulator = SIMAVR,
) -> HazardOutcome:
    """
    Run *trials*, each with the number of its motor, one after the other, and judge them all.

    Raises:
        StepgenError: The sketch crashed or hangs.
    """
    every = subjects(loaded, plan)
    actions: list[Action] = []
    with Bench(plan, elf, simulator) as bench:
        bench.set_loop(Loop.EXACT)
        runs = [HazardRun(bench, subject, i, actions) for i, subject in enumerate(every)]
        for index, trial in trials:
            runs[index].run(trial)
        outcome = judge(bench, loaded, Scenario("hazards", Loop.EXACT, tuple(actions)))
    reached = []
    for run in runs:
        seen = outcome.trace.runs(run.subject.vector)
        reached += [(meeting.trial, meeting.offset(seen)) for meeting in run.meetings]
    return HazardOutcome(outcome, tuple(reached))


def call_cycles(plan: Plan, elf: Path, command: Command, simulator: Simulator = SIMAVR) -> int:
    """
    Return how long the calls of *command* take from the first one's begin, from rest.
    """
    with Bench(plan, elf, simulator) as bench:
        bench.set_loop(Loop.EXACT)
        answers = [bench.call(action) for action in command.actions if isinstance(action, Call)]
    return sum(answer.end_cycle - answer.begin_cycle for answer in answers)

"""
Running a scenario on a simulated chip, and judging it.
"""

from dataclasses import dataclass
from pathlib import Path

from stepgen.plan.model import Plan
from stepgen.spec import LoadedSpec
from stepgen.verify.bench import Answer, Bench, CallKind, Context, Loop
from stepgen.verify.compare import Comparison, Scene, compare
from stepgen.verify.scenarios import Scenario, Wait
from stepgen.verify.shared_pins import compare_shared
from stepgen.verify.simulators import SIMAVR, Simulator
from stepgen.verify.subject import subjects
from stepgen.verify.trace import Trace


@dataclass(frozen=True)
class Outcome:
    """
    How a scenario went.

    Args:
        scenario: What was asked.
        comparisons: How each motor did.
        shared_findings: What differs from the model at pins that motors share.
        masked_cycles: Longest stretch with interrupts off within a call of the library.
        stack_bytes: Most stack that a step interrupt took.
        trace: Everything that was recorded.
        answers: The calls as they happened.
    """

    scenario: Scenario
    comparisons: tuple[Comparison, ...]
    shared_findings: tuple[str, ...]
    masked_cycles: int
    stack_bytes: int
    trace: Trace
    answers: tuple[Answer, ...]

    @property
    def findings(self) -> tuple[str, ...]:
        """
        Return what differs from the model, with the motor's name before it.
        """
        of_motors = tuple(
            f"{comparison.motor}: {finding}"
            for comparison in self.comparisons
            for finding in comparison.findings
        )
        return of_motors + self.shared_findings


def run_scenario(
    loaded: LoadedSpec,
    plan: Plan,
    elf: Path,
    scenario: Scenario,
    simulator: Simulator = SIMAVR,
) -> Outcome:
    """
    Run *scenario* on the bench *elf* and compare every motor with the model.

    Raises:
        StepgenError: The sketch crashed or hangs.
    """
    with Bench(plan, elf, simulator) as bench:
        bench.set_loop(scenario.loop)
        for action in scenario.actions_on(plan):
            if isinstance(action, Wait):
                bench.wait(action.cycles)
            else:
                bench.call(action)
        return judge(bench, loaded, scenario)


def judge(bench: Bench, loaded: LoadedSpec, scenario: Scenario) -> Outcome:
    """
    Compare every motor with the model, now that *bench* has run *scenario* of *loaded*.
    """
    plan = bench.plan
    trace = Trace(bench.events(), plan.board.mcu)
    answers = tuple(bench.answers)
    scene = Scene(trace, answers, plan, bench.machine.cycle, bench.simulator.tolerance_cycles)
    motors = subjects(loaded, plan, bench.elf)
    comparisons = tuple(compare(motor, i, scene) for i, motor in enumerate(motors))
    return Outcome(
        scenario=scenario,
        comparisons=comparisons,
        shared_findings=tuple(compare_shared(motors, comparisons, scene)),
        masked_cycles=_longest_mask(trace, answers),
        stack_bytes=_stack_bytes(bench, [motor.vector for motor in motors]),
        trace=trace,
        answers=answers,
    )


def is_asleep(scenario: Scenario) -> bool:
    """
    Tell whether interrupts wake the chip there, which makes their response four cycles longer.
    """
    return scenario.loop is Loop.SLEEP


def _longest_mask(trace: Trace, answers: tuple[Answer, ...]) -> int:
    longest = 0
    for answer in answers:
        if answer.call.kind is CallKind.HOLD_UP or answer.call.context is Context.INTERRUPT:
            continue
        which = 0
        while section := trace.commit(answer.begin_cycle, answer.end_cycle, which):
            longest = max(longest, section[1] - section[0])
            which += 1
    return longest


def _stack_bytes(bench: Bench, vectors: list[int]) -> int:
    used = bench.machine.isr_stack
    return max((used.get(vector, 0) for vector in vectors), default=0)

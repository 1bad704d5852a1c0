"""
Rules that hold whatever the model says: no slow step, no interval cut short, no torn read.

The model takes the timer's next deadline from where the firmware set its counter. Whether the
firmware set it right is judged here, by the contract alone.
"""

from collections.abc import Iterator, Sequence
from itertools import pairwise

from stepgen.plan.model import MotorPlan
from stepgen.reference.contract import Control
from stepgen.reference.stimuli import Edge, EdgeKind
from stepgen.reference.timer import TimerSetting
from stepgen.verify.bench import Answer, CallKind
from stepgen.verify.oracle import WAKE_CYCLES, Scene
from stepgen.verify.subject import Subject
from stepgen.verify.trace import ClockStart, Run

# The step interrupt sets the timer with a constant that was measured; compilers differ a little.
_CALIBRATION_CYCLES = 8
# Status, then position; one callback, then the other.
_MASKED_SECTIONS = {CallKind.READ: 2, CallKind.CALLBACKS: 2}
_NO_CODE = {CallKind.READ, CallKind.UPDATE_CHECK, CallKind.CALLBACKS}


def broken_rules(
    subject: Subject, index: int, scene: Scene, runs: Sequence[Run], edges: Sequence[Edge]
) -> Iterator[str]:
    """
    Yield each rule that motor number *index* broke, in words.
    """
    answers = [answer for answer in scene.answers if answer.call.motor == index]
    yield from _unmasked_calls(scene, answers)
    steps = [edge for edge in edges if edge.kind is EdgeKind.STEP]
    calls = [answer for answer in answers if answer.call.kind not in _NO_CODE]
    starts = scene.trace.clock_starts(subject.timer)
    yield from _wrong_changes(subject, runs, calls, steps, starts)
    yield from _wrong_starts(subject, scene, calls, steps)
    yield from _late_edges(subject, scene.plan.motors[index], runs, calls, steps)


def _unmasked_calls(scene: Scene, answers: Sequence[Answer]) -> Iterator[str]:
    """
    Whatever is shared with the interrupt is read and written with interrupts off.
    """
    for answer in answers:
        sections = _MASKED_SECTIONS.get(answer.call.kind, 1)
        if scene.trace.commit(answer.begin_cycle, answer.end_cycle, sections - 1) is None:
            yield f"{answer.call} touches what the interrupt changes without masking it"


def _wrong_changes(
    subject: Subject,
    runs: Sequence[Run],
    calls: Sequence[Answer],
    steps: Sequence[Edge],
    starts: Sequence[ClockStart],
) -> Iterator[str]:
    """
    After a change of speed the first new interval is right, within a tick and the lateness.

    The tick is that of the coarser of the two prescalers; the lateness is how late the step
    came at which the timer was set, since the interval is counted from that step.
    """
    by_deadline = {run.raised: run for run in runs}
    for before, (first, second) in zip(steps, pairwise(steps[1:]), strict=False):
        is_first_of_call = before.call_index != first.call_index == second.call_index
        run = by_deadline.get(first.deadline_cycle)
        if not is_first_of_call or run is None:
            continue
        old, new = _running_prescaler(starts, run.entered), _setting(subject, calls, first)
        late = run.entered - run.raised
        allowed = max(old, new.prescaler) + late + _CALIBRATION_CYCLES
        error = second.deadline_cycle - first.deadline_cycle - new.period_cycles
        if abs(error) > allowed:
            yield (
                f"the interval after the step due at cycle {first.deadline_cycle} is {error:+d} "
                f"cycles off; {allowed} are allowed"
            )


def _running_prescaler(starts: Sequence[ClockStart], cycle: int) -> int:
    """
    Return the prescaler with which the timer ran at *cycle*: that of its last start.
    """
    return next(start.prescaler for start in reversed(starts) if start.cycle < cycle)


def _setting(subject: Subject, calls: Sequence[Answer], edge: Edge) -> TimerSetting:
    return subject.facts.setting(calls[edge.call_index].call.top)


def _wrong_starts(
    subject: Subject, scene: Scene, calls: Sequence[Answer], steps: Sequence[Edge]
) -> Iterator[str]:
    """
    From rest the first step comes one interval after the call, at most one tick early.
    """
    starts = scene.trace.clock_starts(subject.timer)
    firsts: dict[int, Edge] = {}
    for step in steps:
        firsts.setdefault(step.call_index, step)
    for index, answer in enumerate(calls):
        commit = scene.trace.commit(answer.begin_cycle, answer.end_cycle)
        if answer.call.kind != CallKind.SET_SPEED or commit is None:
            continue
        first = firsts.get(index)
        if first is None or not any(commit[0] < start.cycle <= commit[1] for start in starts):
            continue
        setting = subject.facts.setting(max(answer.call.top, subject.facts.wake_cycles))
        wait = first.deadline_cycle - commit[0]
        longest = setting.period_cycles + commit[1] - commit[0]
        if not setting.period_cycles - setting.prescaler <= wait <= longest:
            yield (
                f"the first step is due {wait} cycles after the call at cycle {commit[0]}; "
                f"an interval is {setting.period_cycles}"
            )


def _late_edges(
    subject: Subject,
    motor: MotorPlan,
    runs: Sequence[Run],
    calls: Sequence[Answer],
    steps: Sequence[Edge],
) -> Iterator[str]:
    """
    Within the interrupt the wires change at the cycle that the plan states.

    Before a boundary a few cycles later, and later still where the handler looks at the clock
    before it steps; that way only its own bound limits.
    """
    by_deadline = {run.raised: run for run in runs}
    path = motor.hot_path
    for step in steps:
        run = by_deadline.get(step.deadline_cycle)
        if run is None or not run.writes:
            continue
        call = calls[step.call_index].call
        thinks = motor.motion.watches_clock or (
            call.control & Control.ENDPOINT_MILLIS and call.limit
        )
        latest = motor.isr_bound_cycles if thinks else path.boundary_edge_cycles + WAKE_CYCLES
        taken = subject.edge(run).cycle - run.entered
        if taken > latest:
            yield f"the step due at cycle {run.raised} took {taken} cycles; {latest} are planned"

"""
The comparison: what a motor was seen to do against what the reference model says.
"""

from bisect import bisect_left
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from stepgen.plan.model import MotorPlan, Plan
from stepgen.reference.integer import MotorModel
from stepgen.reference.stimuli import (
    ClockOn,
    Edge,
    EdgeKind,
    Hold,
    Init,
    MillisTick,
    Release,
    SetSpeed,
    Stimulus,
)
from stepgen.verify.bench import Answer, CallKind
from stepgen.verify.electrical import is_between
from stepgen.verify.subject import Subject
from stepgen.verify.trace import PortState, Run, Trace

_WAKE_CYCLES = 4  # more, when the interrupt wakes the chip from idle sleep
_MOST_FINDINGS = 5


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
    """

    motor: str
    findings: list[str] = field(default_factory=list)
    steps: int = 0
    jitter_cycles: int = 0
    longest_isr_cycles: int = 0
    isr_cycles: int = 0

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


def compare(subject: Subject, index: int, scene: Scene) -> Comparison:
    """
    Compare motor number *index* with the model: every edge, pattern, code, status, position.
    """
    result = Comparison(subject.name)
    runs = scene.trace.runs(subject.vector)
    edges = _Oracle(subject, index, scene, runs).predict(result)
    _compare_steps(subject, scene, runs, edges, result)
    _compare_calls(subject, scene, edges, result)
    _compare_strangers(subject, scene, runs, result)
    motor = scene.plan.motors[index]
    for run in runs:
        _check_run(run, motor, scene, result)
    return result


class _Oracle:
    """
    The reference model, fed with what happened on the chip and asked in the order of cycles.
    """

    def __init__(self, subject: Subject, index: int, scene: Scene, runs: list[Run]) -> None:
        self._subject = subject
        self._index = index
        self._scene = scene
        self._raised = [run.raised for run in runs]
        self._runs = runs
        self._model = MotorModel(subject.facts, self._service_cycle)

    def _service_cycle(self, deadline: int) -> int:
        place = bisect_left(self._raised, deadline)
        if place < len(self._runs) and self._raised[place] == deadline:
            return self._runs[place].entered
        return deadline

    def predict(self, result: Comparison) -> list[Edge]:
        """
        Return all edges of the model; report each code, status or position that differs.
        """
        edges: list[Edge] = []
        for cycle, stimulus, answer in self._happenings():
            edges.extend(self._model.advance(cycle - 1))
            if stimulus is not None:
                code = self._model.apply(stimulus)
                if answer and code != answer.result:
                    result.report(
                        f"{answer.call} returned {answer.result}, the model says {int(code)}"
                    )
            elif answer:
                edges.extend(self._model.advance(cycle))
                self._compare_reading(cycle, answer, result)
        edges.extend(self._model.advance(self._scene.until_cycle))
        return edges

    def _compare_reading(self, cycle: int, answer: Answer, result: Comparison) -> None:
        status = int(self._model.status_at(cycle, self._millis))
        if status != answer.status:
            result.report(
                f"status {answer.status:#04x} at cycle {cycle}, the model says {status:#04x}"
            )
        later = self._scene.trace.commit(answer.begin_cycle, answer.end_cycle, 1)
        position = self._position_at(later[0] if later else cycle)
        if answer.position not in {self._model.position, position}:
            result.report(
                f"position {answer.position} at cycle {cycle}, the model says {position}"
            )

    def _position_at(self, cycle: int) -> int:
        self._pending = self._model.advance(cycle)
        return self._model.position

    def _happenings(self) -> Iterator[tuple[int, Stimulus | None, Answer | None]]:
        """
        Yield (cycle, stimulus or None for a reading, answer or None) in the order of effect.
        """
        trace, subject = self._scene.trace, self._subject
        rows: list[tuple[int, int, Stimulus | None, Answer | None]] = []
        for answer in self._scene.answers:
            commit = trace.commit(answer.begin_cycle, answer.end_cycle)
            if answer.call.motor == self._index and commit:
                rows.append((commit[0], 1, _stimulus(answer, commit[0]), answer))
        rows.extend(
            (start.cycle, 2, ClockOn(start.cycle, start.prescaler, start.tcnt), None)
            for start in trace.clock_starts(subject.tccrb, subject.tcnt)
        )
        vector = self._scene.plan.board.mcu.vector("TIMER0_OVF_vect").number
        rows.extend(
            (cycle, 0, MillisTick(cycle, millis), None)
            for cycle, millis in trace.millis_ticks(vector)
        )
        self._millis = 0
        for cycle, _, stimulus, answer in sorted(rows, key=lambda row: row[:2]):
            if cycle > self._scene.until_cycle:
                return
            if isinstance(stimulus, MillisTick):
                self._millis = stimulus.millis
            yield cycle, stimulus, answer


def _stimulus(answer: Answer, cycle: int) -> Stimulus | None:
    call = answer.call
    match call.kind:
        case CallKind.SET_SPEED:
            return SetSpeed(cycle, call.control, call.top, call.limit)
        case CallKind.HOLD:
            return Hold(cycle)
        case CallKind.RELEASE:
            return Release(cycle)
        case CallKind.INIT:
            return Init(cycle)
        case CallKind.READ:
            return None


def _compare_steps(
    subject: Subject, scene: Scene, runs: list[Run], edges: list[Edge], result: Comparison
) -> None:
    """
    Compare each edge that an interrupt makes: its cycle, its pattern, and the way there.
    """
    by_deadline = {run.raised: run for run in runs}
    ports = scene.trace.ports_at(runs[0].entered) if runs else {}
    used = set()
    expected = {edge.deadline_cycle: edge for edge in edges if edge.deadline_cycle in by_deadline}
    for edge in edges:
        is_missing = edge.kind is EdgeKind.STEP and edge.deadline_cycle not in by_deadline
        if is_missing and edge.deadline_cycle + _grace(scene) < scene.until_cycle:
            result.report(f"no step interrupt for the step due at cycle {edge.deadline_cycle}")
    events = iter(scene.trace.ports)
    upcoming = next(events, None)
    for run in runs:
        while upcoming and upcoming.cycle <= run.entered:
            ports[upcoming.port] = upcoming.value
            upcoming = next(events, None)
        matching = expected.get(run.raised)
        before = subject.pattern(ports)
        seen = _play(subject, ports, run.writes, result)
        if matching is None:
            if seen and seen[-1] != before:
                result.report(f"a step at cycle {run.writes[-1].cycle} that nobody asked for")
            continue
        used.add(run.raised)
        after = seen[-1] if seen else before
        if not matching.pattern.allows(after):
            result.report(
                f"pattern {_text(after)} at cycle {run.entered}, the model says {matching.pattern}"
            )
        _check_way(subject, (before, *seen), result)
        if matching.kind is EdgeKind.STEP and run.writes:
            result.steps += 1
            jitter = run.writes[-1].cycle - run.raised
            result.jitter_cycles = max(result.jitter_cycles, jitter)


def _grace(scene: Scene) -> int:
    """
    Return how long after its deadline a step at the very end of a trace may still come.
    """
    return 2 * scene.plan.isr_bound_cycles


def _play(
    subject: Subject, ports: dict[str, int], writes: Sequence[PortState], result: Comparison
) -> list[tuple[bool, ...]]:
    """
    Apply *writes* to *ports*; return the patterns on the way. Other bits must not change.
    """
    seen = []
    for write in writes:
        changed = ports[write.port] ^ write.value
        foreign = changed & ~subject.masks.get(write.port, 0)
        if foreign:
            result.report(
                f"the step interrupt changed bits {foreign:#04x} of port {write.port} "
                f"at cycle {write.cycle}"
            )
        ports[write.port] = write.value
        seen.append(subject.pattern(ports))
    return seen


def _check_way(subject: Subject, way: Sequence[tuple[bool, ...]], result: Comparison) -> None:
    for seen in way[1:-1]:
        if not is_between(subject, way[0], way[-1], seen):
            result.report(
                f"{_text(seen)} on the way from {_text(way[0])} to {_text(way[-1])} drives a "
                "coil that neither does"
            )


def _compare_calls(
    subject: Subject, scene: Scene, edges: list[Edge], result: Comparison
) -> None:
    """
    Compare the edges that calls make: the coils are on or off when the call lets go.
    """
    commits = [
        commit
        for answer in scene.answers
        if (commit := scene.trace.commit(answer.begin_cycle, answer.end_cycle))
    ]
    ends = dict(commits)
    for edge in edges:
        end = ends.get(edge.deadline_cycle)
        if end is None:
            continue
        seen = subject.pattern(scene.trace.ports_at(end))
        if not edge.pattern.allows(seen):
            result.report(
                f"{edge.kind}: {_text(seen)} after the call at cycle {end}, "
                f"the model says {edge.pattern}"
            )


def _compare_strangers(
    subject: Subject, scene: Scene, runs: list[Run], result: Comparison
) -> None:
    """
    Report changes of the motor's wires outside its interrupt and outside the library's calls.
    """
    windows = sorted(
        [(run.entered, run.left) for run in runs]
        + [(answer.begin_cycle, answer.end_cycle) for answer in scene.answers]
    )
    starts = [start for start, _ in windows]
    held: dict[str, int] = {}
    for state in scene.trace.ports:
        changed = held.get(state.port, 0) ^ state.value
        held[state.port] = state.value
        if not changed & subject.masks.get(state.port, 0) or not scene.answers:
            continue
        place = bisect_left(starts, state.cycle) - 1
        inside = place >= 0 and state.cycle <= windows[place][1]
        if not inside and state.cycle > scene.answers[0].begin_cycle:
            result.report(f"port {state.port} changed at cycle {state.cycle} outside the library")


def _check_run(run: Run, motor: MotorPlan, scene: Scene, result: Comparison) -> None:
    """
    Check that a late start is explained: by an instruction, or by interrupts that were off.
    """
    mcu = scene.plan.board.mcu
    delay = run.entered - run.unmasked
    if delay > mcu.response_cycles + 1:
        result.report(f"the interrupt at cycle {run.entered} came {delay} cycles late unexplained")
    length = run.left - run.entered
    result.longest_isr_cycles = max(result.longest_isr_cycles, length)
    result.isr_cycles += length
    if length > motor.isr_bound_cycles + _WAKE_CYCLES:
        result.report(
            f"a step interrupt of {length} cycles; its bound is {motor.isr_bound_cycles}"
        )


def _text(pattern: Sequence[bool]) -> str:
    return "".join(str(int(level)) for level in pattern)

"""
The comparison: what a motor was seen to do against what the reference model says.
"""

from bisect import bisect_left
from collections.abc import Sequence

from stepgen.plan.model import MotorPlan
from stepgen.reference.stimuli import Edge, EdgeKind
from stepgen.verify.drives import Levels
from stepgen.verify.edges import wrong_positions
from stepgen.verify.oracle import WAKE_CYCLES, Comparison, Oracle, Scene
from stepgen.verify.pulses import broken_pulses
from stepgen.verify.rules import broken_rules, wrong_leg_starts
from stepgen.verify.standing import with_dir_of, wrong_levels
from stepgen.verify.subject import Subject
from stepgen.verify.trace import PortState, Run

__all__ = ["Comparison", "Scene", "compare"]


def compare(subject: Subject, index: int, scene: Scene) -> Comparison:
    """
    Compare motor number *index* with the model: every edge, pattern, code, status, position.
    """
    result = Comparison(subject.name)
    runs = scene.trace.runs(subject.vector)
    oracle = Oracle(subject, index, scene, runs)
    edges = oracle.predict(result)
    result.needs, result.intervals = oracle.needs, oracle.intervals
    every_run = runs
    runs = oracle.served(runs)
    runs = within_tolerance(runs, edges, scene.tolerance_cycles)
    result.turns = oracle.turns
    _compare_steps(subject, scene, runs, edges, result)
    _compare_calls(subject, scene, runs, edges, result)
    _compare_strangers(subject, scene, runs, result)
    for broken in broken_pulses(subject, scene, runs, edges, result.turns):
        result.report(broken)
    for broken in broken_rules(subject, index, scene, runs, edges, result.intervals):
        result.report(broken)
    for broken in wrong_leg_starts(subject, scene, oracle.starts):
        result.report(broken)
    for wrong in wrong_positions(subject, index, scene, runs):
        result.report(wrong)
    for wrong in wrong_levels(subject, index, scene, runs, edges):
        result.report(wrong)
    motor = scene.plan.motors[index]
    for run in every_run:
        _check_run(run, motor, scene, result)
    return result


def within_tolerance(runs: list[Run], edges: Sequence[Edge], tolerance_cycles: int) -> list[Run]:
    """
    Return *runs*, those that are raised within the tolerance of an edge as if raised at it.
    """
    if not tolerance_cycles:
        return runs
    near = {
        edge.deadline_cycle + offset: edge.deadline_cycle
        for offset in range(-tolerance_cycles, tolerance_cycles + 1)
        for edge in edges
    }
    return [run._replace(raised=near.get(run.raised, run.raised)) for run in runs]


def _compare_steps(
    subject: Subject, scene: Scene, runs: Sequence[Run], edges: Sequence[Edge], result: Comparison
) -> None:
    """
    Compare each edge that an interrupt makes: its cycle, its pattern, and the way there.
    """
    deadlines = {run.raised for run in runs}
    turned = {turn.cycle for turn in result.turns} if subject.is_axis else set()
    _report_missing(scene, edges, deadlines, result)
    expected = {edge.deadline_cycle: edge for edge in edges if edge.deadline_cycle in deadlines}
    ports = scene.trace.ports_at(runs[0].entered) if runs else {}
    events = iter(scene.trace.ports)
    upcoming = next(events, None)
    for run in runs:
        while upcoming and upcoming.cycle <= run.entered:
            ports[upcoming.port] = upcoming.value
            upcoming = next(events, None)
        before = subject.pattern(ports)
        way: tuple[Levels, ...] = (before, *_play(subject, ports, run.writes, result))
        edge = expected.get(run.raised)
        if edge:
            if run.raised in turned:
                way = tuple(with_dir_of(edge, seen) for seen in way)
            _compare_edge(subject, run, way, edge, result)
        elif any(seen != before for seen in way):
            result.report(f"a step at cycle {run.writes[-1].cycle} that nobody asked for")


def _report_missing(
    scene: Scene, edges: Sequence[Edge], deadlines: set[int], result: Comparison
) -> None:
    """
    Report the steps of the model, and the ends of its moves, for which there was no interrupt.
    """
    last = scene.until_cycle - grace_cycles(scene)
    sections = (scene.trace.commit(one.begin_cycle, one.end_cycle) for one in scene.answers)
    made = deadlines | {section[0] for section in sections if section}
    for edge in edges:
        cycle = edge.deadline_cycle
        if cycle in made and not (edge.kind is EdgeKind.STEP and cycle not in deadlines):
            continue
        if cycle < last:
            result.report(f"no step interrupt for the {edge.kind} due at cycle {cycle}")


def _compare_edge(
    subject: Subject, run: Run, way: Sequence[Levels], edge: Edge, result: Comparison
) -> None:
    """
    Compare what *run* did, the patterns *way* from first to last, with the model's *edge*.
    """
    if not edge.pattern.allows(way[-1]):
        result.report(
            f"pattern {_text(way[-1])} at cycle {run.entered}, the model says {edge.pattern}"
        )
    _check_way(subject, way, result)
    if edge.kind is EdgeKind.STEP and run.writes:
        result.steps += 1
        jitter = subject.edge(run).cycle - run.raised
        if run.put_off:
            return  # late on purpose: its own interrupt looked after a switch first
        result.jitter_cycles = max(result.jitter_cycles, jitter)


def grace_cycles(scene: Scene) -> int:
    """
    Return how long after its deadline a step at the very end of a trace may still come.
    """
    return 2 * max(motor.isr_bound_cycles for motor in scene.plan.motors)


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


def _check_way(subject: Subject, way: Sequence[Levels], result: Comparison) -> None:
    for seen in way[1:-1]:
        if not subject.drive.is_between(way[0], way[-1], seen):
            result.report(
                f"{_text(seen)} on the way from {_text(way[0])} to {_text(way[-1])} drives a "
                "coil that neither does"
            )


def _compare_calls(
    subject: Subject, scene: Scene, runs: Sequence[Run], edges: Sequence[Edge], result: Comparison
) -> None:
    """
    Compare the edges that calls make: the coils are on or off when the call lets go.

    An edge that an interrupt makes can fall due in the very cycle of a call; it is none of these.
    """
    deadlines = {run.raised for run in runs}
    commits = [
        commit
        for answer in scene.answers
        if (commit := scene.trace.commit(answer.begin_cycle, answer.end_cycle))
    ]
    ends = dict(commits)
    for edge in edges:
        end = ends.get(edge.deadline_cycle)
        if end is None or edge.kind is EdgeKind.STEP or edge.deadline_cycle in deadlines:
            continue
        seen = subject.pattern(scene.trace.ports_at(end))
        if not edge.pattern.allows(seen):
            result.report(
                f"{edge.kind}: {_text(seen)} after the call at cycle {end}, "
                f"the model says {edge.pattern}"
            )


def _compare_strangers(subject: Subject, scene: Scene, runs: list[Run], result: Comparison) -> None:
    """
    Report changes of the motor's wires outside its interrupt and outside the library's calls.

    Wires that it shares with another motor are judged in `stepgen.verify.shared_pins`.
    """
    own = subject.own_masks
    windows = (
        [(run.entered, run.left) for run in runs],
        [(answer.begin_cycle, answer.end_cycle) for answer in scene.answers],
    )
    held: dict[str, int] = {}
    for state in scene.trace.ports:
        changed = held.get(state.port, 0) ^ state.value
        held[state.port] = state.value
        if not changed & own.get(state.port, 0) or not scene.answers:
            continue
        inside = any(_is_within(state.cycle, kind) for kind in windows)
        if not inside and state.cycle > scene.answers[0].begin_cycle:
            result.report(f"port {state.port} changed at cycle {state.cycle} outside the library")


def _is_within(cycle: int, windows: Sequence[tuple[int, int]]) -> bool:
    """
    Tell whether *cycle* lies in one of *windows*, which ascend and do not overlap.
    """
    place = bisect_left(windows, (cycle,)) - 1
    return place >= 0 and cycle <= windows[place][1]


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
    if length > motor.isr_bound_cycles + WAKE_CYCLES:
        result.report(f"a step interrupt of {length} cycles; its bound is {motor.isr_bound_cycles}")


def _text(pattern: Sequence[bool]) -> str:
    return "".join(str(int(level)) for level in pattern)

"""
The wires between two edges of the model: they show what the last edge made of them.

The comparison of edges looks only where the model has one. Coils that never go off, or that a call
switches off though nobody asked for it, show between them.
"""

from bisect import bisect_right
from collections.abc import Iterator, Sequence

from stepgen.reference.stimuli import Edge
from stepgen.verify.bench import OF_NO_MOTOR
from stepgen.verify.drives import Levels
from stepgen.verify.oracle import Scene
from stepgen.verify.subject import Subject
from stepgen.verify.trace import Run

_DIR = 1  # the place of DIR among a driver's wires; `stepgen.verify.pulses` judges it


def wrong_levels(
    subject: Subject, index: int, scene: Scene, runs: Sequence[Run], edges: Sequence[Edge]
) -> Iterator[str]:
    """
    Yield where the wires of motor number *index* show what the model does not say, in words.
    """
    yield from _wrong_at_rest(subject, scene, runs, edges)
    yield from _wrong_in_calls(subject, index, scene, runs)


def with_dir_of(edge: Edge, seen: Levels) -> Levels:
    """
    Return what the wires of a driver show, *seen*, with DIR as *edge* has it.
    """
    return (*seen[:_DIR], edge.pattern.driven[_DIR], *seen[_DIR + 1 :])


def _wrong_at_rest(
    subject: Subject, scene: Scene, runs: Sequence[Run], edges: Sequence[Edge]
) -> Iterator[str]:
    """
    Yield where a call, of any motor, or the end finds other levels than those of the last edge.
    """
    done = _done_cycles(scene, runs, edges)
    deadlines = [edge.deadline_cycle for edge in edges]
    moments = [answer.begin_cycle for answer in scene.answers]
    for cycle in (*moments, scene.until_cycle):
        place = bisect_right(deadlines, cycle) - 1
        if place < 0 or done[place] > cycle:
            continue
        edge = edges[place]
        seen: Levels = subject.pattern(scene.trace.ports_at(cycle))
        if subject.facts.has_direction:
            seen = with_dir_of(edge, seen)
        if not edge.pattern.allows(seen):
            yield (
                f"{_text(seen)} at cycle {cycle}, the model says {edge.pattern} since "
                f"cycle {edge.deadline_cycle}"
            )
            return


def _done_cycles(scene: Scene, runs: Sequence[Run], edges: Sequence[Edge]) -> list[int]:
    """
    Return when what each edge asks for is done: its interrupt has left, or its call has let go.

    Where neither is there, as much later as two interrupts may take: nobody did it.
    """
    sections = (scene.trace.commit(one.begin_cycle, one.end_cycle) for one in scene.answers)
    known = dict(section for section in sections if section)
    known |= {run.raised: run.left for run in runs}
    most = 2 * max(motor.isr_bound_cycles for motor in scene.plan.motors)

    def done(deadline: int) -> int:
        if deadline in known:
            return known[deadline]
        section = scene.trace.masked_section(deadline)
        return (section[1] if section else deadline) + most

    return [done(edge.deadline_cycle) for edge in edges]


def _wrong_in_calls(
    subject: Subject, index: int, scene: Scene, runs: Sequence[Run]
) -> Iterator[str]:
    """
    Yield where a call changes a wire and back, or one while it belongs to another motor's call.
    """
    own = subject.own_masks
    changes = [state for state in scene.trace.ports if own.get(state.port, 0)]
    cycles = [state.cycle for state in changes]
    entries = [run.entered for run in runs]
    for answer in scene.answers:
        if answer.call.kind in OF_NO_MOTOR:
            continue
        section = scene.trace.commit(answer.begin_cycle, answer.end_cycle)
        first, last = section or (answer.begin_cycle, answer.end_cycle)
        before = _own(subject, scene.trace.ports_at(first - 1))
        after = _own(subject, scene.trace.ports_at(last))
        if before != after and answer.call.motor != index:
            yield f"{answer.call} of another motor changed the wires at cycle {first}"
            return
        for state in changes[bisect_right(cycles, first - 1) : bisect_right(cycles, last)]:
            run = bisect_right(entries, state.cycle) - 1
            if run >= 0 and state.cycle <= runs[run].left:
                continue
            seen = _own(subject, scene.trace.ports_at(state.cycle))
            if before == after and seen != before:
                yield f"{answer.call} changed the wires at cycle {state.cycle}, and back"
                return


def _own(subject: Subject, ports: dict[str, int]) -> Levels:
    """
    Return what its wires show, those that it shares with another motor left out.
    """
    levels = zip(subject.drive.wires, subject.pattern(ports), strict=True)
    return tuple(level for bit, level in levels if bit not in subject.shared)


def _text(levels: Levels) -> str:
    return "".join(str(int(level)) for level in levels)

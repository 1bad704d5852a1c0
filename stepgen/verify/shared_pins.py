"""
Pins that two motors share, against the model of both motors together.
"""

from collections.abc import Iterator, Sequence
from itertools import zip_longest

from stepgen.devices import PortBit
from stepgen.reference.sharing import Need, shared_changes
from stepgen.verify.compare import grace_cycles
from stepgen.verify.oracle import Comparison, Scene
from stepgen.verify.subject import Subject
from stepgen.verify.trace import PortState


def compare_shared(
    subjects: Sequence[Subject], comparisons: Sequence[Comparison], scene: Scene
) -> Iterator[str]:
    """
    Yield where a shared pin differs from the model: each change of it, its direction and moment.

    It changes while the interrupt or the call that makes the model change it has interrupts off,
    and at no other time.
    """
    for bit in sorted({bit for subject in subjects for bit in subject.shared}, key=str):
        sharers = [index for index, subject in enumerate(subjects) if bit in subject.shared]
        expected = shared_changes(comparisons[index].needs for index in sharers)
        lefts = {
            run.entered: run.left
            for index in sharers
            for run in scene.trace.runs(subjects[index].vector)
        }
        level = subjects[sharers[0]].drive.current_level(bit)
        changes = _changes(scene.trace.ports, bit, needed=level)
        yield from _differences(bit, expected, changes, scene, lefts)


def _changes(states: Sequence[PortState], bit: PortBit, *, needed: bool) -> Iterator[Need]:
    """
    Yield each change of *bit*, whose level is *needed* for current; the first call is Init.

    At reset it is LOW. That Init makes an enable that is active LOW go HIGH is no change of need.
    """
    level = False
    is_fresh = True
    for state in states:
        if state.port == bit.port and bool(state.value >> bit.bit & 1) != level:
            level = not level
            if needed or not is_fresh:
                yield Need(state.cycle, level == needed)
            is_fresh = False


def _differences(
    bit: PortBit,
    expected: Sequence[Need],
    observed: Iterator[Need],
    scene: Scene,
    lefts: dict[int, int],
) -> Iterator[str]:
    """
    Yield the first difference. What happens at the very end may be recorded by half.
    """
    last = scene.until_cycle - grace_cycles(scene)
    for wanted, seen in zip_longest(expected, observed):
        if any(change and change.cycle >= last for change in (wanted, seen)):
            return
        if wanted is None:
            yield f"{bit.name} goes {_level(seen)} at cycle {seen.cycle}, asked by no motor"
            return
        asked = f"{bit.name} must go {_level(wanted)} at cycle {wanted.cycle}"
        end = lefts.get(wanted.cycle) or _end_of_call(scene, wanted.cycle)
        if seen is None or end is None or not wanted.cycle <= seen.cycle <= end:
            yield f"{asked}, but does so at {seen.cycle}" if seen else f"{asked}, but never does"
            return


def _end_of_call(scene: Scene, cycle: int) -> int | None:
    section = scene.trace.masked_section(cycle)
    return section[1] if section else None


def _level(change: Need) -> str:
    return "HIGH" if change.on else "LOW"

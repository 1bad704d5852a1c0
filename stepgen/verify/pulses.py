"""
Pulses: what STEP, DIR and ENABLE were seen to do against what the driver asks for.
"""

from bisect import bisect_left, bisect_right
from collections.abc import Iterator, Sequence
from itertools import pairwise, zip_longest

from stepgen.devices import PortBit
from stepgen.reference.axis import Turn
from stepgen.reference.pulses import PulseFacts
from stepgen.reference.stimuli import Edge, EdgeKind
from stepgen.verify.oracle import Scene
from stepgen.verify.subject import Subject
from stepgen.verify.trace import PortState, Run

Change = tuple[int, bool]
_ENDING_CYCLES = 2_000  # of a trace: what happens then may be recorded by half


def broken_pulses(
    subject: Subject,
    scene: Scene,
    runs: Sequence[Run],
    edges: Sequence[Edge],
    turns: Sequence[Turn],
) -> Iterator[str]:
    """
    Yield each demand of the driver of *subject* that its pins did not meet; none for coils.
    """
    pulse = subject.drive.pulse
    if pulse is None or not scene.answers:
        return
    begin = scene.answers[0].begin_cycle
    step, direction, *enables = (
        list(_changes(scene.trace.ports, bit)) for bit in subject.drive.wires
    )
    rises = [cycle for cycle, level in step if level]
    yield from _wrong_counts(runs, edges, rises)
    yield from wrong_widths(pulse, step)
    seen = [change for change in direction if change[0] > begin]
    by_interrupt = runs if subject.is_axis else ()
    yield from _wrong_turns(scene, by_interrupt, seen, turns)
    yield from wrong_directions(pulse, direction, rises)
    for enable in enables:
        yield from wrong_enables(pulse, enable, rises)


def _changes(states: Sequence[PortState], bit: PortBit) -> Iterator[Change]:
    """
    Yield each change of *bit*, which is LOW at reset.
    """
    level = False
    for state in states:
        if state.port == bit.port and bool(state.value >> bit.bit & 1) != level:
            level = not level
            yield state.cycle, level


def _wrong_counts(
    runs: Sequence[Run], edges: Sequence[Edge], rises: Sequence[int]
) -> Iterator[str]:
    """
    Yield where a step is not one pulse within its interrupt, or a pulse no step.
    """
    steps = {edge.deadline_cycle for edge in edges if edge.kind is EdgeKind.STEP}
    inside = 0
    for run in runs:
        count = bisect_right(rises, run.left) - bisect_left(rises, run.entered)
        inside += count
        if count != (run.raised in steps):
            yield f"{count} pulses on STEP in the interrupt at cycle {run.entered}"
    if inside != len(rises):
        yield f"{len(rises) - inside} pulses on STEP outside the step interrupt"


def wrong_widths(pulse: PulseFacts, step: Sequence[Change]) -> Iterator[str]:
    """
    Yield where STEP is not HIGH or LOW as long as the driver needs, or HIGH much longer.
    """
    for (cycle, level), (following, _) in pairwise(step):
        width = following - cycle
        if level and not pulse.high <= width <= pulse.longest_high:
            yield (
                f"the pulse at cycle {cycle} is {width} cycles long, not {pulse.high} to "
                f"{pulse.longest_high}"
            )
        if not level and width < pulse.low:
            yield f"STEP is LOW for {width} cycles at cycle {cycle}; the driver needs {pulse.low}"


def _wrong_turns(
    scene: Scene, runs: Sequence[Run], seen: Sequence[Change], turns: Sequence[Turn]
) -> Iterator[str]:
    """
    Yield where DIR does not change in the call that turns the motor round, or does elsewhere.

    An axis turns in one of its step interrupts, *runs*, too.
    """
    interrupts = {run.raised: (run.entered, run.left) for run in runs}
    for wanted, change in zip_longest(turns, seen):
        cycle = change[0] if change else wanted.cycle
        if cycle > scene.until_cycle - _ENDING_CYCLES:
            return
        if change is None or wanted is None:
            yield f"DIR {'changes' if change else 'stays'} at cycle {cycle}, unlike the model"
            return
        section = interrupts.get(wanted.cycle) or scene.trace.masked_section(wanted.cycle)
        is_there = section is not None and section[0] <= change[0] <= section[1]
        if not is_there or change[1] != (wanted.direction < 0):
            yield (
                f"DIR goes {'HIGH' if change[1] else 'LOW'} at cycle {change[0]}, the model says "
                f"direction {wanted.direction:+d} at {wanted.cycle}"
            )
            return


def wrong_directions(
    pulse: PulseFacts, direction: Sequence[Change], rises: Sequence[int]
) -> Iterator[str]:
    """
    Yield where DIR changes too short a time before STEP rises or after it.
    """
    for cycle, _ in direction:
        place = bisect_right(rises, cycle)
        if place and cycle - rises[place - 1] < pulse.hold:
            yield f"DIR changes {cycle - rises[place - 1]} cycles after STEP rose at cycle {cycle}"
        if place < len(rises) and rises[place] - cycle < pulse.setup:
            yield f"DIR changes {rises[place] - cycle} cycles before STEP rises, at cycle {cycle}"


def wrong_enables(
    pulse: PulseFacts, enable: Sequence[Change], rises: Sequence[int]
) -> Iterator[str]:
    """
    Yield the steps at which the driver is not enabled, or not for long enough.
    """
    cycles = [cycle for cycle, _ in enable]
    for rise in rises:
        place = bisect_right(cycles, rise) - 1
        since, level = enable[place] if place >= 0 else (0, False)
        if level != pulse.enabled_level:
            yield f"a step at cycle {rise} while the driver is not enabled"
        elif rise - since < pulse.enable:
            yield f"a step at cycle {rise}, {rise - since} cycles after ENABLE"

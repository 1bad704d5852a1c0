"""
Position equals edges: the steps that the wires showed, counted without the model.

What a motor is asked for plays no part here. Each write of its step interrupt must leave a
pattern of the table, a neighbour of the one before or the same, or coils that are off; and whoever
reads the position must get the number of neighbours that went by.
"""

from collections.abc import Iterator, Sequence

from stepgen.reference.axis import wrapped_int32
from stepgen.verify.bench import Answer, CallKind
from stepgen.verify.drives import Levels
from stepgen.verify.happenings import PositionRead, masked_reads
from stepgen.verify.oracle import Scene
from stepgen.verify.subject import Subject
from stepgen.verify.trace import Run


def wrong_positions(
    subject: Subject, index: int, scene: Scene, runs: Sequence[Run]
) -> Iterator[str]:
    """
    Yield where the position of motor number *index* is not what its wires did, in words.
    """
    if not _can_be_counted(subject):
        return
    position = offset = 0
    for cycle, seen, read, named in sorted(_happenings(subject, index, scene, runs), key=_cycle):
        if seen is not None:
            change = _change(subject, position, seen)
            if change is None:
                yield f"{_text(seen)} at cycle {cycle} is no pattern next to the one before"
                return
            position += change
        elif named is not None:
            offset = named - position
        elif read is None:
            position = offset = 0
        elif read != wrapped_int32(position + offset):
            yield f"position {read} at cycle {cycle}, but the wires made {position} steps"
            return


def _can_be_counted(subject: Subject) -> bool:
    """
    Tell whether what the wires show says in which direction they went.

    A table of one's own may repeat a pattern so that it does not, or have one without current; the
    pulses of a STEP wire are counted in `stepgen.verify.pulses`.
    """
    phases = subject.facts.phases
    return not subject.facts.has_direction and all(
        phases[place - 1] != phases[(place + 1) % len(phases)]
        and phase.driven != subject.facts.coils_off.driven
        for place, phase in enumerate(phases)
    )


_Happening = tuple[int, Levels | None, int | None, int | None]
"""
A cycle, and what the wires show from then on, or the position that is read, or what an axis is told
of it; none of them for Init.
"""


def _happenings(
    subject: Subject, index: int, scene: Scene, runs: Sequence[Run]
) -> Iterator[_Happening]:
    ports = {port.letter: 0 for port in scene.plan.board.mcu.ports}
    states = iter(scene.trace.ports)
    upcoming = next(states, None)
    for run in runs:
        while upcoming and upcoming.cycle <= run.left:
            ports[upcoming.port] = upcoming.value
            upcoming = next(states, None)
        if run.writes:
            yield run.writes[-1].cycle, subject.pattern(ports), None, None
    yield from _told(subject, scene, [one for one in scene.answers if one.call.motor == index])


def _told(subject: Subject, scene: Scene, answers: Sequence[Answer]) -> Iterator[_Happening]:
    """
    Yield what the sketch was told of the position by its calls, and what it told the motor of it.

    An axis that comes home gives its place another number: what is read at rest then.
    """
    homing = False
    place = masked_reads(subject.facts).index(PositionRead)
    for answer in answers:
        kind, ends = answer.call.kind, (answer.begin_cycle, answer.end_cycle)
        if kind in {CallKind.HOME, CallKind.INIT} and not answer.result:
            homing = kind is CallKind.HOME
        first, read = scene.trace.commit(*ends), scene.trace.commit(*ends, place)
        if kind is CallKind.READ and read:
            known = (None, answer.position) if homing else (answer.position, None)
            if not homing or not answer.running:
                yield read[0], None, *known
            homing = homing and bool(answer.running)
        elif kind is CallKind.INIT and first:
            yield first[0], None, None, None
        elif kind is CallKind.SET_POSITION and first and not answer.result:
            yield first[0], None, None, answer.call.steps


def _change(subject: Subject, position: int, seen: Levels) -> int | None:
    """
    Return how the position changes when the wires come to show *seen*; None if it is no pattern.
    """
    facts = subject.facts
    for change in (1, -1):
        if facts.phases[(position + change) % len(facts.phases)].allows(seen):
            return change
    place = position % len(facts.phases)
    rest = (facts.phases[place], facts.released[place])
    return 0 if any(pattern.allows(seen) for pattern in rest) else None


def _cycle(happening: _Happening) -> int:
    return happening[0]


def _text(levels: Levels) -> str:
    return "".join(str(int(level)) for level in levels)

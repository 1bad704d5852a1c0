"""
Rules that hold whatever the model says: no slow step, no interval cut short, no torn read.

The model takes the timer's next deadline from where the firmware set its counter. Whether the
firmware set it right is judged here, by the contract alone.
"""

from bisect import bisect_left, bisect_right
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise

from stepgen.plan.model import MotorPlan
from stepgen.reference.contract import Control
from stepgen.reference.stimuli import Edge, EdgeKind
from stepgen.reference.timer import TimerSetting, first_match_cycles
from stepgen.reference.trapezoid import Start
from stepgen.verify.bench import OF_NO_MOTOR, Answer, CallKind
from stepgen.verify.happenings import masked_sections
from stepgen.verify.oracle import WAKE_CYCLES, Scene
from stepgen.verify.subject import Subject
from stepgen.verify.trace import ClockStart, Run

# The step interrupt sets the timer with a constant that was measured; compilers differ a little.
_CALIBRATION_CYCLES = 8
_NO_CODE = {CallKind.READ, CallKind.UPDATE_CHECK, CallKind.CALLBACKS, CallKind.KEEP_ALIVE}


def broken_rules(
    subject: Subject,
    index: int,
    scene: Scene,
    runs: Sequence[Run],
    edges: Sequence[Edge],
    intervals: Mapping[int, TimerSetting],
) -> Iterator[str]:
    """
    Yield each rule that motor number *index* broke, in words.
    """
    answers = [
        answer
        for answer in scene.answers
        if answer.call.motor == index and answer.call.kind not in OF_NO_MOTOR
    ]
    yield from _unmasked_calls(subject, scene, answers)
    steps = [edge for edge in edges if edge.kind is EdgeKind.STEP]
    calls = [answer for answer in answers if answer.call.kind not in _NO_CODE]
    starts = subject.clock_starts(scene.trace)
    yield from _wrong_intervals(intervals, runs, steps, starts)
    yield from _wrong_starts(subject, scene, calls, steps)
    yield from _late_edges(subject, scene.plan.motors[index], runs, calls, steps)


def _unmasked_calls(subject: Subject, scene: Scene, answers: Sequence[Answer]) -> Iterator[str]:
    """
    Whatever is shared with the interrupt is read and written with interrupts off.
    """
    for answer in answers:
        if answer.call.kind is CallKind.SET_PACE and answer.result:
            continue  # refused for what it asks, it touches nothing
        sections = masked_sections(answer.call.kind, subject.facts)
        if scene.trace.commit(answer.begin_cycle, answer.end_cycle, sections - 1) is None:
            yield f"{answer.call} touches what the interrupt changes without masking it"


def _wrong_intervals(
    intervals: Mapping[int, TimerSetting],
    runs: Sequence[Run],
    steps: Sequence[Edge],
    starts: Sequence[ClockStart],
) -> Iterator[str]:
    """
    Each interval of a motion is right, within a tick and the lateness where the timer is set.

    The tick is that of the coarser of the two prescalers; the lateness is how late the step
    came at which the timer was set, since the interval is counted from that step.
    """
    by_deadline = {run.raised: run for run in runs}
    for first, second in pairwise(steps):
        run, new = by_deadline.get(first.deadline_cycle), intervals.get(first.deadline_cycle)
        if new is None:  # an axis came to rest
            continue
        error = second.deadline_cycle - first.deadline_cycle - new.period_cycles
        if run is None or not error or _is_started(starts, run.left, second.deadline_cycle):
            continue
        late = max(0, run.entered - run.raised)
        old = _running_prescaler(starts, run.entered)
        allowed = max(old, new.prescaler) + late + _CALIBRATION_CYCLES
        if abs(error) > allowed:
            yield (
                f"the interval after the step due at cycle {first.deadline_cycle} is {error:+d} "
                f"cycles off; {allowed} are allowed"
            )


def _is_started(starts: Sequence[ClockStart], first: int, last: int) -> bool:
    """
    Tell whether the timer is started between two cycles: a call begins another motion.
    """
    place = bisect_right(starts, first, key=_cycle)
    return place < len(starts) and starts[place].cycle < last


def _cycle(start: ClockStart) -> int:
    return start.cycle


def _running_prescaler(starts: Sequence[ClockStart], cycle: int) -> int:
    """
    Return the prescaler with which the timer ran at *cycle*: that of its last start.
    """
    return starts[bisect_left(starts, cycle, key=_cycle) - 1].prescaler


def _wrong_starts(
    subject: Subject, scene: Scene, calls: Sequence[Answer], steps: Sequence[Edge]
) -> Iterator[str]:
    """
    From rest the first step comes one interval after the call, at most one tick early.
    """
    starts = subject.clock_starts(scene.trace)
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


def wrong_leg_starts(subject: Subject, scene: Scene, legs: Sequence[Start]) -> Iterator[str]:
    """
    Yield where the first step of an axis is not one interval after the call, counted from within.
    """
    if not legs or subject.channel is None:
        return
    sets = scene.trace.channel_sets(subject.channel, subject.timer)
    by_call = [one for one in sets if not one.in_interrupt]
    for leg in legs:
        section = scene.trace.masked_section(leg.cycle)
        place = bisect_right(by_call, leg.cycle, key=lambda one: one.cycle)
        if section is None or place == len(by_call) or by_call[place].cycle > section[1]:
            yield f"the call at cycle {leg.cycle} sets no channel for the first step"
            continue
        interval, one = leg.interval_cycles, by_call[place]
        wait = one.cycle + one.ahead_cycles + interval - first_match_cycles(interval) - leg.cycle
        if not interval <= wait <= interval + section[1] - section[0]:
            yield (
                f"the first step is due {wait} cycles after the call at cycle {leg.cycle}; "
                f"an interval is {interval}"
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
    before it steps; that way only its own bound limits. One that came too late may take longer.
    """
    by_deadline = {run.raised: run for run in runs}
    path = motor.hot_path
    for step in steps:
        run = by_deadline.get(step.deadline_cycle)
        if run is None or not run.writes:
            continue
        call = calls[step.call_index].call
        thinks = motor.motion.changes_speed or (
            call.control & Control.ENDPOINT_MILLIS and call.limit
        )
        edge = path.boundary_edge_cycles + path.pressed_cycles + WAKE_CYCLES
        latest = motor.isr_bound_cycles if thinks else edge
        missed = subject.facts.overrun_cycles
        overrun = missed is not None and run.entered - run.raised >= missed
        latest += motor.gate.late_cycles if overrun or run.serves_later else 0
        taken = subject.edge(run).cycle - run.entered
        if taken > latest:
            yield f"the step due at cycle {run.raised} took {taken} cycles; {latest} are planned"

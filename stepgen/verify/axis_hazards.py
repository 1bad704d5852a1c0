"""
Hazards of axes: calls that come while a step interrupt is near that climbs, descends or ends a leg.
"""

from collections.abc import Iterator

from stepgen.plan.model import Plan
from stepgen.reference.climb import Climb
from stepgen.reference.ladder import Ladder
from stepgen.reference.timer import FRACTIONS
from stepgen.verify.bench import APPROACH_CYCLES, Call, CallKind
from stepgen.verify.scenarios import Wait
from stepgen.verify.trials import Command, Way

_FAR = 100_000


def axis_ways(plan: Plan, index: int, ladder: Ladder) -> Iterator[Way]:
    """
    Yield the ways of the step interrupt of axis number *index* of *plan*, which climbs on *ladder*.
    """
    motor = plan.motors[index]
    cruise_256 = motor.motion.cruise_interval_256
    inner = _inner_step(ladder)

    def way(
        name: str,
        meets: int,
        steps: int | None = None,
        again: Call | None = None,
        pace_256: int = cruise_256,
    ) -> Way:
        call = Call(CallKind.RUN_FORWARD, index)
        if pace_256 != cruise_256:
            call = Call(CallKind.HOME, index)
        elif steps is not None:
            call = Call(CallKind.MOVE, index, steps=steps)
        gaps = tuple(_gaps(ladder, pace_256, steps, meets + 1))
        settle = (gaps[-1] + gaps[-2]) // FRACTIONS
        return Way(name, call, meets, again, settle, gaps_256=gaps)

    yield way("a step after laps", 2)
    yield way("a step within a row", inner)
    yield way("a step at the end of a row", inner - 1)
    yield way("a step on the way down", inner + 3, 2 * inner + 1)
    yield way("the last step", 3, 3)
    yield way("a step after a call", inner, None, Call(CallKind.MOVE_TO, index, steps=_FAR))
    yield way("a step after a turn", inner, None, Call(CallKind.RUN_BACKWARD, index))
    if motor.releases_at_rest:
        yield way("the release after the last step", 3, 2)
    stops = motor.end_stops
    if stops and stops.homing:
        travel, fast_256 = stops.homing.travel, stops.homing.fast.interval_256
        yield way("a step on the way home", 3, travel, pace_256=fast_256)
    if motor.motion.queue:
        back = Call(CallKind.QUEUE_MOVE_TO, index, steps=-1)
        yield way("a step that begins the next leg", 2, 2, back)


def axis_commands(plan: Plan, index: int, ladder: Ladder) -> Iterator[Command]:
    """
    Yield every kind of command for axis number *index* of *plan*.
    """
    motor = plan.motors[index]
    cruise_256 = motor.motion.cruise_interval_256

    def call(kind: CallKind, steps: int = 0, top: int = 0) -> Call:
        return Call(kind, index, top=top, steps=steps)

    def command(name: str, *actions: Call | Wait) -> Command:
        paces = any(isinstance(one, Call) and one.kind is CallKind.SET_PACE for one in actions)
        return Command(name, actions, 0, works_first=paces)

    yield command("farther", call(CallKind.MOVE_TO, _FAR))
    yield command("nearer", call(CallKind.MOVE, 2))
    yield command("here", call(CallKind.MOVE, 0))
    yield command("behind", call(CallKind.MOVE_TO, -3))
    yield command("run on", call(CallKind.RUN_FORWARD))
    yield command("turn round", call(CallKind.RUN_BACKWARD))
    yield command("stop", call(CallKind.STOP))
    yield command("halt", call(CallKind.HALT))
    yield command("slower", call(CallKind.SET_PACE, top=3 * cruise_256))
    yield command(
        "slower than it began", call(CallKind.SET_PACE, top=ladder.first_interval_256 + 1)
    )
    yield command("refused", call(CallKind.SET_PACE, top=1))
    yield command("position", call(CallKind.SET_POSITION, 77))
    yield command("read", call(CallKind.READ))
    yield command("init", call(CallKind.INIT))
    start = call(CallKind.MOVE, -2)
    yield command("halt and start", call(CallKind.HALT), Wait(APPROACH_CYCLES), start)
    yield command("turn and back", start, Wait(APPROACH_CYCLES), call(CallKind.RUN_FORWARD))
    if motor.switches_current:
        yield command("enable", call(CallKind.HOLD))
        yield command("disable", call(CallKind.RELEASE))
    if motor.end_stops:
        yield command("emergency stop", call(CallKind.EMERGENCY_STOP))
        yield command("clear a fault", call(CallKind.CLEAR_FAULT))
    if motor.end_stops and motor.end_stops.homing:
        yield command("home", call(CallKind.HOME))
        yield command("halt and home", call(CallKind.HALT), call(CallKind.HOME))
    if motor.motion.queue:
        yield command("one more", call(CallKind.QUEUE_MOVE_TO, 9))


def _inner_step(ladder: Ladder) -> int:
    """
    Return the number of a step, from 3 on, before which the first row of several steps began.
    """
    steps = 0
    for rung in ladder.rungs:
        if rung.levels * rung.steps > 1:
            break
        steps += rung.levels * rung.steps
    return max(steps, 2) + 1


def _gaps(ladder: Ladder, cruise_256: int, steps: int | None, count: int) -> Iterator[int]:
    """
    Yield the first *count* intervals of a leg of *steps*: that before the first step, and so on.

    After the last step comes the one before it once more.
    """
    climb = Climb(ladder, cruise_256)
    climb.begin(steps)
    for _ in range(count):
        yield climb.interval_256
        if climb.left != 0:
            climb.step()

"""
Scenarios for two motors that share their enables: one lets go while the other needs them.
"""

from collections.abc import Iterator
from itertools import permutations

from stepgen.plan.model import Plan
from stepgen.verify.bench import Call, CallKind, Loop, is_axis
from stepgen.verify.scenarios import BACK, DRIVE, MILLIS, Action, Scenario, Wait

_SWEEP_STEP_CYCLES = 7  # shorter than any stretch of a few instructions with interrupts off
_CALL_CYCLES = 700  # from the wish for a call to its end


def sharing_scenarios(plan: Plan) -> Iterator[Scenario]:
    """
    Yield the scenarios for each two motors of *plan* that share their enables, either way round.

    Those of axes are in `stepgen.verify.axis_scenarios`.
    """
    sharers = [
        index
        for index, motor in enumerate(plan.motors)
        if motor.drive.shared_enables and not is_axis(motor)
    ]
    for one, other in permutations(sharers, 2):
        yield from _of_two(one, other, plan)


def _of_two(one: int, other: int, plan: Plan) -> Iterator[Scenario]:
    title = f"{plan.motors[one].name} lets go, {plan.motors[other].name}"
    fastest = plan.minimum_period_cycles
    yield Scenario(f"{title} runs", Loop.BUSY, tuple(_while_it_runs(one, other, fastest)))
    yield Scenario(f"{title} stands", Loop.HOSTILE, tuple(_while_it_stands(one, other, fastest)))
    if plan.motors[one].releases_at_rest:
        actions = tuple(_at_the_same_moment(one, other, fastest))
        yield Scenario(f"{title} is called at that moment", Loop.BUSY, actions)


def _speed(motor: int, control: int, top: int, limit: int = 0) -> Call:
    return Call(CallKind.SET_SPEED, motor, control, top, limit)


def _do(kind: CallKind, motor: int) -> Call:
    return Call(kind, motor)


def _ways_to_let_go(motor: int, fastest: int) -> Iterator[tuple[Action, ...]]:
    """
    Yield each way to need no current any more: a stop, a release, an end point, an init.
    """
    yield (_speed(motor, 0, 0),)
    yield (_speed(motor, DRIVE, 0), _do(CallKind.RELEASE, motor))
    yield (_speed(motor, BACK, fastest, 5), Wait(9 * fastest), _do(CallKind.RELEASE, motor))
    yield (_speed(motor, MILLIS, fastest, 2), Wait(60_000), _do(CallKind.RELEASE, motor))
    yield (_do(CallKind.INIT, motor),)


def _while_it_runs(one: int, other: int, fastest: int) -> Iterator[Action]:
    """
    Let go of one while the other runs, which comes to its own end later.
    """
    for way in _ways_to_let_go(one, fastest):
        yield _speed(other, BACK, 5_003)
        yield Wait(10_000)
        yield _speed(one, DRIVE, fastest)
        yield Wait(7 * fastest + 333)  # in a phase that is not that of an init
        yield from way
        yield Wait(20_000)
        yield _do(CallKind.READ, one)
        yield _speed(other, DRIVE, 5_003, 3)
        yield Wait(30_000)
        yield from (_do(CallKind.READ, motor) for motor in (one, other))
        yield _speed(one, DRIVE, fastest, 2)
        yield Wait(6 * fastest)
        yield _speed(other, 0, 0)
        yield _do(CallKind.RELEASE, one)


def _while_it_stands(one: int, other: int, fastest: int) -> Iterator[Action]:
    """
    Let go of one while the other holds its position, which is released later.
    """
    for way in _ways_to_let_go(one, fastest):
        yield _speed(other, DRIVE, fastest, 3)
        yield Wait(6 * fastest)
        yield _do(CallKind.HOLD, other)
        yield _speed(one, DRIVE, fastest)
        yield Wait(5 * fastest + 333)
        yield from way
        yield Wait(20_000)
        yield _do(CallKind.HOLD, one)
        yield _do(CallKind.RELEASE, other)
        yield Wait(5_000)
        yield _do(CallKind.INIT, other)
        yield _do(CallKind.RELEASE, one)
        yield Wait(5_000)


def _at_the_same_moment(one: int, other: int, fastest: int) -> Iterator[Action]:
    """
    Call the other within the cycles in which one lets go by itself: start, hold, release, init.
    """
    lets_go = 3 * fastest  # a step, and an interval after it
    for offset in range(0, _CALL_CYCLES, _SWEEP_STEP_CYCLES):
        for call in (
            _speed(other, DRIVE, fastest, 1),
            _do(CallKind.HOLD, other),
            _do(CallKind.RELEASE, other),
            _do(CallKind.INIT, other),
        ):
            yield _speed(one, DRIVE, fastest, 1)
            yield Wait(lets_go - fastest - _CALL_CYCLES + offset)
            yield call
            yield Wait(lets_go)
            yield _speed(other, 0, 0)
    for offset in range(0, fastest, 4 * _SWEEP_STEP_CYCLES):
        yield _speed(one, DRIVE, fastest + 300, 2)
        yield Wait(offset)
        yield _speed(other, DRIVE, fastest, 2)
        yield Wait(5 * fastest)

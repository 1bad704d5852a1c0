"""
Scenarios for compare channels of a timer that runs through: steps that are due before they are set.
"""

from collections.abc import Iterator
from random import Random

from stepgen.plan.model import Plan
from stepgen.verify.bench import Call, CallKind, Loop, is_axis
from stepgen.verify.late_scenarios import hold_up
from stepgen.verify.scenarios import BACK, DRIVE, MILLIS, Action, Scenario, Wait

_LONGEST_HOLD_CYCLES = 30_000
# Up to the counter's half round, from there on with laps, and about as many as there can be.
_PERIODS = (1_500, 8_191, 16_384, 32_767, 32_768, 40_000, 65_535, 65_536, 98_304, 200_003)
_SWEEP_HOLDS = 1_200  # some let a channel be set in the very clock of its match
_STARTS = 400
_MANY_HOLDS = 300  # more than a byte counts
_RANDOM_HOLDS = 250
_SEED = 20_261_101


def passed_scenarios(plan: Plan) -> Iterator[Scenario]:
    """
    Yield the scenarios for each motor of *plan* with a channel of a 16-bit timer that is no axis.
    """
    for index, motor in enumerate(plan.motors):
        if not motor.timing.channel or is_axis(motor):
            continue
        fastest = plan.minimum_period_cycles
        for name, loop, actions in (
            ("interrupts held up for periods and laps", Loop.BUSY, _everywhere(index, fastest)),
            ("interrupts held up for many lengths", Loop.BUSY, _sweep(index, fastest)),
            ("interrupts held up very often", Loop.BUSY, _often(index, fastest)),
            ("starts while the others run", Loop.BUSY, _starts(plan, index, fastest)),
            (
                "interrupts held up at random",
                Loop.HOSTILE,
                random_holds(index, fastest, _SEED, _RANDOM_HOLDS),
            ),
        ):
            yield Scenario(f"{motor.name}: {name}", loop, tuple(actions))


def _everywhere(motor: int, fastest: int) -> Iterator[Action]:
    """
    Hold up for less and more than a period, for laps and for all that can be told; then read.
    """
    read = Call(CallKind.READ, motor)
    for period in (fastest, fastest + 1, fastest + 7, *(one for one in _PERIODS if one > fastest)):
        yield Call(CallKind.SET_SPEED, motor, DRIVE, period)
        for part in range(1, 18):
            for cycles in (period * part // 4, 16_000 + part * 100, _LONGEST_HOLD_CYCLES):
                yield Wait(period + part * period // 17)
                yield hold_up(min(cycles, _LONGEST_HOLD_CYCLES))
                yield read
            yield Wait(12 * fastest)
        yield Call(CallKind.SET_SPEED, motor, BACK, period, 9)
        for _ in range(4):
            yield hold_up(min(3 * period, _LONGEST_HOLD_CYCLES))
        yield read
        yield Wait(10 * period)
        yield read
        yield Call(CallKind.SET_SPEED, motor, MILLIS, period, 5)
        yield hold_up(min(2 * period, _LONGEST_HOLD_CYCLES))
        yield Wait(130_000 + period)
        yield read
    yield Call(CallKind.SET_SPEED, motor, 0, 0)
    yield read


def _sweep(motor: int, fastest: int) -> Iterator[Action]:
    """
    Let the interrupt catch up from many lengths, so that some match comes as its channel is set.
    """
    yield Call(CallKind.SET_SPEED, motor, DRIVE, fastest)
    for index in range(_SWEEP_HOLDS):
        yield Wait(3 * fastest + index % 89)
        yield hold_up(fastest + 4 * index % (4 * fastest))
    yield Call(CallKind.READ, motor)


def _starts(plan: Plan, motor: int, fastest: int) -> Iterator[Action]:
    """
    Start and stop at many points of the periods of the other motors, which use the same timer.
    """
    others = [i for i, one in enumerate(plan.motors) if i != motor and not is_axis(one)]
    for index in others:
        yield Call(CallKind.SET_SPEED, index, DRIVE, fastest + 3 * index)
    for index in range(_STARTS):
        yield Call(CallKind.SET_SPEED, motor, DRIVE if index % 2 else BACK, fastest, 1)
        yield Wait(2 * fastest + 7 * index % fastest)
    yield from (Call(CallKind.READ, index) for index in (motor, *others))


def _often(motor: int, fastest: int) -> Iterator[Action]:
    """
    Count past a byte, then begin anew with an init.
    """
    yield Call(CallKind.SET_SPEED, motor, DRIVE, fastest)
    for index in range(_MANY_HOLDS):
        yield Wait(1 + index % 97)
        yield hold_up(3 * fastest)
    yield Call(CallKind.READ, motor)
    yield Call(CallKind.INIT, motor)
    yield Call(CallKind.READ, motor)


def random_holds(motor: int, fastest: int, seed: int, count: int) -> Iterator[Action]:
    """
    Yield *count* stretches with interrupts off, of any length and at any moment, and calls between.
    """
    random = Random(seed)  # noqa: S311 - repeatable, not secret
    for _ in range(count):
        if random.random() < 0.1:  # noqa: PLR2004 - a tenth of them
            control = random.choice([DRIVE, BACK, MILLIS])
            period = random.choice([fastest, *_PERIODS, random.randrange(fastest, 140_000)])
            limit = random.choice([0, 0, random.randrange(1, 400)])
            yield Call(CallKind.SET_SPEED, motor, control, max(period, fastest), limit)
        yield Wait(int(2 ** random.uniform(0, 15)))
        yield hold_up(int(2 ** random.uniform(6, 14.8)))
        yield Call(CallKind.READ, motor)

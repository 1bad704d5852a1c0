"""
Scenarios for motors that count the steps that come too late: a sketch holds interrupts up.
"""

from collections.abc import Iterator
from random import Random

from stepgen.plan.model import Plan
from stepgen.plan.timings.compare import LONGEST_OVERRUN_CYCLES, LONGEST_WAIT_CYCLES
from stepgen.verify.bench import Call, CallKind, Loop
from stepgen.verify.scenarios import BACK, DRIVE, MILLIS, Action, Scenario, Wait

_LENGTHS = (
    ("as long as allowed", LONGEST_WAIT_CYCLES),
    ("a little too long", LONGEST_WAIT_CYCLES + 100),
    ("nearly as long as can be told", LONGEST_OVERRUN_CYCLES),
)
_ROUND_CYCLES = 4  # of the loop that holds up
_AROUND_CYCLES = 20  # more than it takes to begin and to end, an instruction included
_LAP_CYCLES = 2048
# A lap, a lap and little or much more, two laps, and several.
_PERIODS = (2_048, 2_055, 2_500, 4_088, 4_096, 20_011)
_LONG_PERIODS = tuple(laps * _LAP_CYCLES + 24 for laps in (256, 257))  # more than a byte counts
_MANY_HOLDS = 700  # more than 256 of them come upon a step
_SWEEP_HOLDS = 2_500  # some let a last lap be served in the very tick in which the step is due
_SWEEP_PERIOD = _LAP_CYCLES + 64
_RANDOM_HOLDS = 250
_SEED = 20_260_301


def late_scenarios(plan: Plan) -> Iterator[Scenario]:
    """
    Yield the scenarios for each motor of *plan* that counts such steps.
    """
    for index, motor in enumerate(plan.motors):
        if motor.hot_path.overrun_cycles is None:
            continue
        for name, cycles in _LENGTHS:
            yield Scenario(
                f"{motor.name}: interrupts held up for {name}",
                Loop.BUSY,
                tuple(_everywhere(index, cycles)),
            )
        yield Scenario(
            f"{motor.name}: interrupts held up where a step ends very many laps",
            Loop.BUSY,
            tuple(_after_many_laps(index)),
        )
        yield Scenario(
            f"{motor.name}: interrupts held up very often",
            Loop.BUSY,
            tuple(_often(index)),
        )
        yield Scenario(
            f"{motor.name}: interrupts held up at random",
            Loop.HOSTILE,
            tuple(random_holds(index, _SEED, _RANDOM_HOLDS)),
        )


def hold_up(cycles: int) -> Call:
    """
    Return the call that keeps interrupts off for *cycles*, less a few.
    """
    return Call(CallKind.HOLD_UP, top=(cycles - _AROUND_CYCLES) // _ROUND_CYCLES)


def _everywhere(motor: int, cycles: int) -> Iterator[Action]:
    """
    Hold up at many points of a period; then see status, position and count, also at its end.
    """
    read = Call(CallKind.READ, motor)
    for period in _PERIODS:
        yield Call(CallKind.SET_SPEED, motor, DRIVE, period)
        for offset in range(0, _LAP_CYCLES, 41):
            yield Wait(period + offset)
            yield hold_up(cycles)
            yield read
        yield Call(CallKind.SET_SPEED, motor, BACK, period, 9)
        for _ in range(8):
            yield hold_up(cycles)
            yield Wait(period)
        yield read
        yield Wait(3 * period)
        yield read
    yield Call(CallKind.SET_SPEED, motor, 0, 0)
    yield read


def _after_many_laps(motor: int) -> Iterator[Action]:
    """
    Hold up the first step from rest, whose moment is known; see the next one come in its time.
    """
    for period in _LONG_PERIODS:
        for before in (100, 700):
            yield Call(CallKind.SET_SPEED, motor, DRIVE, period)
            yield Wait(period - before)
            yield hold_up(LONGEST_OVERRUN_CYCLES)
            yield Wait(2 * period)
            yield Call(CallKind.READ, motor)
            yield Call(CallKind.SET_SPEED, motor, 0, 0)


def _often(motor: int) -> Iterator[Action]:
    """
    Count past a byte; before, let the last lap wait until about the step, at every cycle.
    """
    yield Call(CallKind.SET_SPEED, motor, DRIVE, _SWEEP_PERIOD)
    for index in range(_SWEEP_HOLDS):
        yield Wait(1 + index % 97)
        yield hold_up(1_070 + index % 20)
    yield Call(CallKind.READ, motor)
    yield Call(CallKind.SET_SPEED, motor, DRIVE, _LAP_CYCLES)
    for index in range(_MANY_HOLDS):
        yield Wait(1 + index % 97)
        yield hold_up(LONGEST_OVERRUN_CYCLES)
    yield Call(CallKind.READ, motor)
    yield Call(CallKind.INIT, motor)
    yield Call(CallKind.READ, motor)


def random_holds(motor: int, seed: int, count: int) -> Iterator[Action]:
    """
    Yield *count* stretches with interrupts off, of any length and at any moment, and calls between.
    """
    random = Random(seed)  # noqa: S311 - repeatable, not secret
    for _ in range(count):
        if random.random() < 0.1:  # noqa: PLR2004 - a tenth of them
            control = random.choice([DRIVE, BACK, MILLIS])
            period = random.choice([*_PERIODS, random.randrange(2_048, 70_000)])
            limit = random.choice([0, 0, random.randrange(1, 200)])
            yield Call(CallKind.SET_SPEED, motor, control, period, limit)
        yield Wait(int(2 ** random.uniform(0, 15)))
        yield hold_up(random.randrange(100, LONGEST_OVERRUN_CYCLES))
        yield Call(CallKind.READ, motor)

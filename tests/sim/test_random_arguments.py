"""
Any argument to any function, from wherever a sketch may call it: the model says what comes of it.

Control bytes with all bits, the ends of each range and one beyond them, any number of 32 bits, null
callbacks, calls within callbacks and within an interrupt of the sketch. A sketch that hangs and a
motor that moves though it was refused or stopped differ from the model. What the pure functions
return is proven for every argument (tests/proofs); here they are called with the ends of theirs.
"""

from random import Random

import pytest

from stepgen.plan.model import MotorPlan, Plan
from stepgen.reference.axis import wrapped_int32
from stepgen.verify.bench import (
    Bench,
    Call,
    CallKind,
    Context,
    Loop,
    Watchdog,
    has_call,
    is_axis,
)
from stepgen.verify.events import Kind
from stepgen.verify.runner import run_scenario
from stepgen.verify.scenario_model import fields_of
from stepgen.verify.scenarios import Action, Scenario, Wait
from stepgen.verify.watchdog_run import period_cycles
from tests.sim.kinds import KINDS
from tests.sim.shrinking import Library

FIRST_SEED = 20_260_701
CALLS = 150
CAMPAIGN_SEEDS = 30
# A call within an interrupt keeps the step interrupt waiting for as long as it takes: no call is
# longer than this. A motor whose period is not longer may lose a step by that, as the header says.
CALL_WITHIN_CYCLES = 3_000
LARGEST_32, LARGEST_16, LARGEST_INT32 = 0xFFFF_FFFF, 0xFFFF, 0x7FFF_FFFF
LARGEST_64 = (1 << 64) - 1
KINDS_OF_CALL = {
    CallKind.SET_SPEED: 50,
    CallKind.HOLD: 6,
    CallKind.RELEASE: 6,
    CallKind.READ: 10,
    CallKind.INIT: 3,
}
KINDS_OF_AXIS_CALL = {
    CallKind.MOVE_TO: 12,
    CallKind.MOVE: 12,
    CallKind.QUEUE_MOVE_TO: 12,
    CallKind.SET_POSITION: 12,
    CallKind.SET_PACE: 12,
    CallKind.RUN_FORWARD: 5,
    CallKind.RUN_BACKWARD: 5,
    CallKind.STOP: 5,
    CallKind.HALT: 12,
    CallKind.HOLD: 4,
    CallKind.RELEASE: 4,
    CallKind.READ: 5,
    CallKind.INIT: 3,
    CallKind.HOME: 9,
    CallKind.EMERGENCY_STOP: 4,
    CallKind.CLEAR_FAULT: 25,
    CallKind.PRESS: 20,
}
WATCHED = "uno_watchdog"
WATCHDOG_CALLS = 25  # beside those of the motor
OF_UPDATES = {CallKind.UPDATE_CHECK: 12, CallKind.CALLBACKS: 8}


class Arguments:
    """
    Draws calls with arguments for the motors of *plan*, always the same ones for a *seed*.
    """

    def __init__(self, seed: int, plan: Plan) -> None:
        self._random = Random(seed)  # noqa: S311 - repeatable, not secret
        self._plan = plan
        self._is_slow = seed % 2 == 0  # then interrupts call, too

    def scenario(self, name: str) -> Scenario:
        """
        Return calls of any kind from anywhere, each followed by a wait and a look.
        """
        actions: list[Action] = []
        hungry = 0
        for _ in range(CALLS):
            index = self._random.randrange(len(self._plan.motors))
            motor = self._plan.motors[index]
            of_kind = self._axis_call if is_axis(motor) else self._call
            actions.append(of_kind(index, motor))
            wait = Wait(int(2 ** self._random.uniform(4, 17)))
            actions += (wait, Call(CallKind.READ, index))
            hungry += wait.cycles
            if 0 < period_cycles(self._plan) < 2 * hungry:
                actions.append(Call(CallKind.WATCHDOG, control=Watchdog.FEED))
                hungry = 0
        # Whatever was said, a motor can be stopped.
        for index, motor in enumerate(self._plan.motors):
            actions.append(Call(CallKind.HALT if is_axis(motor) else CallKind.SET_SPEED, index))
            actions.append(Wait(100_000))
            actions.append(Call(CallKind.READ, index))
        loop = self._random.choice([Loop.BUSY, Loop.HOSTILE])
        return Scenario(name, loop, tuple(actions))

    def _call(self, index: int, motor: MotorPlan) -> Call:
        draw = self._random
        changes = motor.motion.changes_speed
        timed = {CallKind.KEEP_ALIVE: 8} if motor.command_timeout_ms else {}
        weights = KINDS_OF_CALL | timed | (OF_UPDATES if changes else {})
        if self._plan.watchdog_ms is not None:
            weights[CallKind.WATCHDOG] = WATCHDOG_CALLS
        kind = draw.choices(list(weights), list(weights.values()))[0]
        context = draw.choice(self._contexts(changes=changes))
        if kind is CallKind.WATCHDOG:
            return Call(kind, control=draw.choice([*Watchdog, *Watchdog, 0xFF]), context=context)
        if kind is CallKind.CALLBACKS:
            return Call(
                kind, index, draw.choice([3, 3, 1, 2, 0]), context=context
            )  # 0: null pointers
        if kind is not CallKind.SET_SPEED:
            return Call(kind, index, context=context)
        control = draw.choice([draw.randrange(256), 0x80 | draw.randrange(128), 0x80, 0xFF, 0])
        update = (self._long(), self._word(), self._word()) if changes else (0, 0, 0)
        return Call(kind, index, control, self._top(), self._long(), *update, context=context)

    def _axis_call(self, index: int, motor: MotorPlan) -> Call:
        """
        Return a call of an axis, with positions at the ends of their numbers and any interval.
        """
        draw = self._random
        weights = {kind: n for kind, n in KINDS_OF_AXIS_CALL.items() if has_call(motor, kind)}
        kind = draw.choices(list(weights), list(weights.values()))[0]
        if kind is CallKind.PRESS:
            return Call(kind, index, draw.choice([0, 0, 1, 2, 3]))
        context = draw.choice(self._contexts(changes=False))
        cruise = motor.motion.cruise_interval_256
        paces = (0, cruise - 1, cruise, cruise + 1, LARGEST_32, self._long(), 3 * cruise)
        near = draw.choice([-1, 1]) * int(2 ** draw.uniform(0, 6))
        place = draw.choice([0, -1 << 31, LARGEST_INT32, wrapped_int32(self._long()), near, near])
        return Call(
            kind,
            index,
            top=draw.choice(paces) if kind is CallKind.SET_PACE else 0,
            steps=place if "steps" in fields_of(kind) else 0,
            context=context,
        )

    def _contexts(self, *, changes: bool) -> list[Context]:
        within = [Context.CALLBACK] if changes else []
        within += [Context.INTERRUPT] if self._is_slow else []
        return [Context.LOOP, Context.LOOP, *within]

    def _top(self) -> int:
        """
        Return an end of the range, one beyond it, or any number; none too fast for the calls.
        """
        fastest = max(self._plan.minimum_period_cycles, CALL_WITHIN_CYCLES * self._is_slow)
        slowest, beyond = self._plan.largest_period_cycles, self._plan.minimum_period_cycles - 1
        usual = int(2 ** self._random.uniform(12, 20))
        ends = (0, 1, beyond, fastest, fastest + 1, slowest, slowest + 1, LARGEST_32)
        longer = [1 << 32, LARGEST_64] if slowest > LARGEST_32 else []
        powers = [1 << 16, (1 << 16) - 1, 1 << 31]
        return self._random.choice([*ends, *([usual] * 8), *powers, *longer])

    def _long(self) -> int:
        any_size = self._random.getrandbits(self._random.randrange(1, 33))
        return self._random.choice([0, 1, 2, 0x7FFF_FFFF, 1 << 31, LARGEST_32, any_size, any_size])

    def _word(self) -> int:
        any_size = self._random.getrandbits(self._random.randrange(1, 17))
        return self._random.choice([0, 1, 2, LARGEST_16, 1 << 15, any_size, any_size])


@pytest.mark.parametrize("seed", [FIRST_SEED, FIRST_SEED + 1])
@pytest.mark.parametrize("stem", KINDS)
def test_any_argument_ends_in_a_documented_state(stem: str, seed: int) -> None:
    """
    A hundred and fifty calls: each code, status, position and edge is the model's.
    """
    library = Library.of(stem)

    library.must_pass(Arguments(seed, library.plan).scenario(f"arguments {seed}"))


@pytest.mark.parametrize("seed", [FIRST_SEED, FIRST_SEED + 1])
def test_the_watchdog_is_called_from_anywhere(seed: int) -> None:
    """
    Started, started again, fed and asked in any order: no motor notices, nothing is reset.
    """
    library = Library.of(WATCHED)
    scenario = Arguments(seed, library.plan).scenario(f"watchdog {seed}")
    outcome = run_scenario(library.loaded, library.plan, library.elf, scenario)
    made = [one for one in outcome.answers if one.call.kind is CallKind.WATCHDOG]

    assert outcome.findings == ()
    assert len(made) > WATCHDOG_CALLS
    assert {one.call.control for one in made} == {*Watchdog, 0xFF}
    assert {one.result for one in made} == {0}
    assert not (outcome.trace.events["kind"] == Kind.RESET).any()


@pytest.mark.campaign
@pytest.mark.parametrize("seed", range(FIRST_SEED + 2, FIRST_SEED + 2 + CAMPAIGN_SEEDS))
@pytest.mark.parametrize("stem", [*KINDS, WATCHED])
def test_a_campaign_of_any_arguments(stem: str, seed: int) -> None:
    """
    Thousands more for each kind of spec, each seed repeatable.
    """
    library = Library.of(stem)

    library.must_pass(Arguments(seed, library.plan).scenario(f"arguments {seed}"))


@pytest.mark.parametrize("stem", ["uno_motor_shield", "mega_pan_tilt"])
def test_units_of_any_rate_return_and_stop_nothing(stem: str) -> None:
    """
    ``motorTimerCalcPerSecond`` of every power of two and of 0 returns the clock divided by it.
    """
    library = Library.of(stem)
    f_cpu = library.plan.board.f_cpu_hz

    with Bench(library.plan, library.elf) as bench:
        for rate in (0, *(1 << bit for bit in range(16)), LARGEST_16):
            answer = bench.call(Call(CallKind.TOP_PER_SECOND, top=rate))
            assert answer.position == (f_cpu // rate if rate else 0)
        assert bench.call(Call(CallKind.CLOCKS_PER_SECOND)).position == f_cpu

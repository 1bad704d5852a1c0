"""
Hazards: a command that comes while a step interrupt is near, and which way that one then takes.

A trial starts a motor, lets a command meet one of its steps, and looks what comes of it. Where the
two meet is its offset: how many clocks of its own the program has still to go before the call
begins when the timer raises the interrupt. Below 0 it is within the call, or was.
"""

from collections.abc import Iterator

from stepgen.plan.model import MotorPlan, Plan
from stepgen.reference.contract import Control
from stepgen.verify.axis_hazards import axis_commands, axis_ways
from stepgen.verify.bench import APPROACH_CYCLES, Call, CallKind
from stepgen.verify.ladders import ladder_of
from stepgen.verify.scenarios import Wait
from stepgen.verify.trials import PERIOD_CYCLES, Command, Way

_DRIVE = Control.DRV_EN
_EVENTS = _DRIVE | Control.SPEED_VARIABLE | Control.UPDATE_STEPS
_SHORT_PERIOD = 1_100
# The next prescaler of fast PWM; a multiple of it, so that nothing is cut off. With timing compare
# the last lap is far enough before the step that no command meets both.
_LONG_PERIOD = 67_200
_LATER = _LONG_PERIOD + PERIOD_CYCLES
_RUN_STEPS = 256  # the count of the interrupt starts anew with the first step, then each 255


def ways(plan: Plan, index: int) -> tuple[Way, ...]:
    """
    Return every way of the step interrupt of motor number *index* of *plan*.
    """
    ladder = ladder_of(plan.motors[index].motion)
    if ladder:
        return tuple(axis_ways(plan, index, ladder))
    return tuple(_ways(plan, index))


def commands(plan: Plan, index: int) -> tuple[Command, ...]:
    """
    Return every kind of command for motor number *index* of *plan*.
    """
    ladder = ladder_of(plan.motors[index].motion)
    if ladder:
        return tuple(axis_commands(plan, index, ladder))
    return tuple(_commands(plan, index))


def _ways(plan: Plan, index: int) -> Iterator[Way]:
    motor = plan.motors[index]

    def start(
        control: int = _DRIVE, top: int = PERIOD_CYCLES, limit: int = 0, *update: int
    ) -> Call:
        return Call(CallKind.SET_SPEED, index, int(control), top, limit, *update)

    millis = _DRIVE | Control.ENDPOINT_MILLIS
    yield Way("the usual way", start(), stride=1)
    few = frozenset({"faster", "next prescaler", "reverse", "limit of one step", "stop", "read"})
    yield Way("the way each 255 steps", start(top=_short(plan)), _RUN_STEPS, only=few)
    yield Way("the last step", start(limit=4))
    if motor.releases_at_rest:
        yield Way("the release after the last step", start(limit=3))
    yield Way("the first step of a call", start(), 4, start())
    yield Way("a change of direction", start(), 4, start(_DRIVE | Control.DIRECTION))
    yield Way("a change of prescaler", start(), 4, start(top=_LONG_PERIOD), _LATER)
    yield Way("a step before a millisecond limit", start(millis, limit=60_000))
    # millis() goes on 16384 clocks after it last did, long before the fourth step, so that no
    # command is interrupted by it.
    yield Way("the end of a millisecond limit", start(millis, limit=1), after_tick_cycles=3_000)
    yield Way("a step with the next prescaler", start(top=_LONG_PERIOD), 2, None, _LATER)
    if _has_events(motor):
        by_isr = _EVENTS | Control.IRQ_TIMING
        across = _LONG_PERIOD - PERIOD_CYCLES
        yield Way("an event", start(by_isr, PERIOD_CYCLES, 0, 400, 3, 1), 3)
        yield Way(
            "an event across prescalers",
            start(by_isr, PERIOD_CYCLES, 0, across, 3, 1),
            3,
            None,
            _LATER,
        )
        yield Way("an event for the sketch", start(_EVENTS, PERIOD_CYCLES, 0, 400, 2, 1))
        yield Way(
            "an event for the sketch, across prescalers",
            start(_EVENTS, PERIOD_CYCLES, 0, across, 2, 1),
            settle_cycles=_LATER,
        )


def _commands(plan: Plan, index: int) -> Iterator[Command]:
    def speed(top: int, limit: int = 0, control: int = _DRIVE, *update: int) -> Call:
        return Call(CallKind.SET_SPEED, index, int(control), top, limit, *update)

    def call(kind: CallKind, control: int = 0) -> Call:
        return Call(kind, index, control)

    stop = speed(0)
    yield Command("faster", (speed(_short(plan)),))
    yield Command("slower", (speed(PERIOD_CYCLES + 1_504),))
    yield Command("next prescaler", (speed(_LONG_PERIOD),), _LATER)
    yield Command("reverse", (speed(PERIOD_CYCLES, 0, _DRIVE | Control.DIRECTION),))
    yield Command("limit of one step", (speed(PERIOD_CYCLES, 1),))
    yield Command(
        "limit of milliseconds", (speed(PERIOD_CYCLES, 1, _DRIVE | Control.ENDPOINT_MILLIS),)
    )
    yield Command("the same again", (speed(PERIOD_CYCLES),))
    yield Command("stop", (stop,))
    yield Command("off", (speed(0, 0, 0),))
    yield Command(
        "stop and start", (stop, Wait(APPROACH_CYCLES), speed(PERIOD_CYCLES)), 3 * PERIOD_CYCLES
    )
    yield Command("refused", (speed(1),))
    yield Command("read", (call(CallKind.READ),))
    if plan.motors[index].switches_current:
        yield Command("hold", (call(CallKind.HOLD),))
        yield Command("release", (call(CallKind.RELEASE),))
    yield Command("init", (call(CallKind.INIT),))
    if plan.motors[index].command_timeout_ms is not None:
        yield Command("keep alive", (call(CallKind.KEEP_ALIVE),))
    if _has_events(plan.motors[index]):
        changing = (_EVENTS | Control.IRQ_TIMING, 1_000, 1, 2)
        yield Command("update check", (call(CallKind.UPDATE_CHECK),))
        yield Command("callbacks", (call(CallKind.CALLBACKS, 3),))
        yield Command(
            "speed that changes", (speed(PERIOD_CYCLES, 0, *changing),), 3 * PERIOD_CYCLES
        )


def _short(plan: Plan) -> int:
    """
    Return a period near the shortest, a multiple of 8 clocks, in which a whole call has room.
    """
    return max(plan.minimum_period_cycles, _SHORT_PERIOD) // 8 * 8 + 8


def _has_events(motor: MotorPlan) -> bool:
    return motor.motion.changes_speed

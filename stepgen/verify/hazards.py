"""
Hazards: a command that comes while a step interrupt is near, and which way that one then takes.

A trial starts a motor, lets a command meet one of its steps, and looks what comes of it. Where the
two meet is its offset: how many clocks of its own the program has still to go before the call
begins when the timer raises the interrupt. Below 0 it is within the call, or was.
"""

from collections.abc import Iterator
from dataclasses import dataclass

from stepgen.plan.model import MotorPlan, Plan
from stepgen.reference.contract import Control
from stepgen.verify.bench import APPROACH_CYCLES, Call, CallKind
from stepgen.verify.scenarios import Action, Wait

_DRIVE = Control.DRV_EN
_EVENTS = _DRIVE | Control.SPEED_VARIABLE | Control.UPDATE_STEPS
_PERIOD = 4_000
_SHORT_PERIOD = 1_100
# The next prescaler of fast PWM; a multiple of it, so that nothing is cut off. With timing compare
# the last lap is far enough before the step that no command meets both.
_LONG_PERIOD = 67_200
_LATER = _LONG_PERIOD + _PERIOD
_RUN_STEPS = 256  # the count of the interrupt starts anew with the first step, then each 255
AFTER_CYCLES = 40  # the call begins up to so many clocks after the interrupt has returned
_SWEEP_TRIALS = 60


@dataclass(frozen=True)
class Way:
    """
    What the step interrupt has to do when the command meets it.

    Args:
        name: In words.
        start: The call that starts the motor, from rest.
        meets: Which step of it the command meets, from 2 on.
        again: A call half a period before that step, if there is one.
        settle_cycles: How long it takes from that step until what it did shows.
        after_tick_cycles: How long after ``millis()`` went on the motor starts, if that matters.
        only: The names of the commands that meet it; all, unless that takes too long.
        stride: A command meets it at each clock, or only at each so manieth.
    """

    name: str
    start: Call
    meets: int = 4
    again: Call | None = None
    settle_cycles: int = 0
    after_tick_cycles: int | None = None
    only: frozenset[str] = frozenset()
    stride: int = 3


@dataclass(frozen=True)
class Command:
    """
    What the sketch asks for: *actions*, and how long it takes until that shows.
    """

    name: str
    actions: tuple[Action, ...]
    settle_cycles: int = 2 * _PERIOD


@dataclass(frozen=True)
class Trial:
    """
    *command* meets the interrupt on its *way*, at an offset in clocks.
    """

    way: Way
    command: Command
    offset: int

    @property
    def settle_cycles(self) -> int:
        """
        Return how long to wait from the step, or from the call if that is later.
        """
        return max(self.way.settle_cycles, self.command.settle_cycles)


def ways(plan: Plan, index: int) -> tuple[Way, ...]:
    """
    Return every way of the step interrupt of motor number *index* of *plan*.
    """
    return tuple(_ways(plan, index))


def commands(plan: Plan, index: int) -> tuple[Command, ...]:
    """
    Return every kind of command for motor number *index* of *plan*.
    """
    return tuple(_commands(plan, index))


def window(way: Way, call_cycles: int, first: int = 0) -> range:
    """
    Return the offsets of *way* at the clocks of a call, and of what follows the interrupt.

    They begin with number *first* of those that its stride goes over. Of a call that is longer than
    the period only those clocks that come after the step before.
    """
    begin = -min(call_cycles, way.start.top - APPROACH_CYCLES)
    return range(begin + first % way.stride, AFTER_CYCLES, way.stride)


def sweep(way: Way, call_cycles: int) -> range:
    """
    Return offsets over the rest of the period; with another call in it, over what follows that.
    """
    longest = way.start.top // 2 - APPROACH_CYCLES if way.again else way.start.top
    return range(-longest, -call_cycles, max(longest // _SWEEP_TRIALS, 1))


def _ways(plan: Plan, index: int) -> Iterator[Way]:
    motor = plan.motors[index]

    def start(control: int = _DRIVE, top: int = _PERIOD, limit: int = 0, *update: int) -> Call:
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
        across = _LONG_PERIOD - _PERIOD
        yield Way("an event", start(by_isr, _PERIOD, 0, 400, 3, 1), 3)
        yield Way(
            "an event across prescalers", start(by_isr, _PERIOD, 0, across, 3, 1), 3, None, _LATER
        )
        yield Way("an event for the sketch", start(_EVENTS, _PERIOD, 0, 400, 2, 1))
        yield Way(
            "an event for the sketch, across prescalers",
            start(_EVENTS, _PERIOD, 0, across, 2, 1),
            settle_cycles=_LATER,
        )


def _commands(plan: Plan, index: int) -> Iterator[Command]:
    def speed(top: int, limit: int = 0, control: int = _DRIVE, *update: int) -> Call:
        return Call(CallKind.SET_SPEED, index, int(control), top, limit, *update)

    def call(kind: CallKind, control: int = 0) -> Call:
        return Call(kind, index, control)

    stop = speed(0)
    yield Command("faster", (speed(_short(plan)),))
    yield Command("slower", (speed(_PERIOD + 1_504),))
    yield Command("next prescaler", (speed(_LONG_PERIOD),), _LATER)
    yield Command("reverse", (speed(_PERIOD, 0, _DRIVE | Control.DIRECTION),))
    yield Command("limit of one step", (speed(_PERIOD, 1),))
    yield Command("limit of milliseconds", (speed(_PERIOD, 1, _DRIVE | Control.ENDPOINT_MILLIS),))
    yield Command("the same again", (speed(_PERIOD),))
    yield Command("stop", (stop,))
    yield Command("off", (speed(0, 0, 0),))
    yield Command("stop and start", (stop, Wait(APPROACH_CYCLES), speed(_PERIOD)), 3 * _PERIOD)
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
        yield Command("speed that changes", (speed(_PERIOD, 0, *changing),), 3 * _PERIOD)


def _short(plan: Plan) -> int:
    """
    Return a period near the shortest, a multiple of 8 clocks, in which a whole call has room.
    """
    return max(plan.minimum_period_cycles, _SHORT_PERIOD) // 8 * 8 + 8


def _has_events(motor: MotorPlan) -> bool:
    return motor.motion.changes_speed

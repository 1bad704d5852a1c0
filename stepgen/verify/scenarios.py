"""
Scenarios: what a sketch asks of the library, and when. The standard ones, and the user's own.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from stepgen.plan.model import Plan
from stepgen.reference.contract import Control
from stepgen.verify.bench import Call, CallKind, Loop, has_call, is_axis

DRIVE = int(Control.DRV_EN)
BACK = int(Control.DRV_EN | Control.DIRECTION)
MILLIS = int(Control.DRV_EN | Control.ENDPOINT_MILLIS)
_SETTLE_CYCLES = 20_000
_LONG_MOVE_STEPS = 70_000
# A period in the range of each prescaler of fast PWM: 1, 8, 64, 256 and 1024; all but the first are
# no multiple of it, so that truncation shows.
_PERIODS = (20_000, 100_003, 600_011, 5_000_021, 20_000_099)


@dataclass(frozen=True)
class Wait:
    """
    Let the chip run for a number of CPU cycles.
    """

    cycles: int


Action = Call | Wait


@dataclass(frozen=True)
class Scenario:
    """
    A name, what the sketch does between calls, and the calls and waits in their order.
    """

    name: str
    loop: Loop
    actions: tuple[Action, ...]

    @property
    def cycles(self) -> int:
        """
        Return the simulated time of its waits; calls add a little.
        """
        return sum(action.cycles for action in self.actions if isinstance(action, Wait))

    def actions_on(self, plan: Plan) -> Iterator[Action]:
        """
        Yield its actions without the calls that the library of *plan* does not have.
        """
        for action in self.actions:
            if isinstance(action, Wait) or has_call(plan.motors[action.motor], action.kind):
                yield action


def standard_scenarios(plan: Plan) -> tuple[Scenario, ...]:
    """
    Return the scenarios that every spec must pass, for each of its motors but axes.
    """
    return tuple(
        Scenario(name, loop, tuple(actions))
        for name, loop, actions in _standard(plan, plan.minimum_period_cycles)
    )


def _standard(plan: Plan, fastest: int) -> Iterator[tuple[str, Loop, list[Action]]]:
    motors = [index for index, motor in enumerate(plan.motors) if not is_axis(motor)]
    if not motors:
        return
    slowest = plan.largest_period_cycles
    yield (
        f"{_LONG_MOVE_STEPS} steps at the fastest rate",
        Loop.BUSY,
        list(_long_moves(motors, fastest)),
    )
    for period in _PERIODS:
        yield (
            f"a step each {period} clocks",
            Loop.SLEEP,
            [*_each(motors, BACK, period, 6), Wait(8 * period), *(_read(m) for m in motors)],
        )
    yield (
        "the slowest rate",
        Loop.SLEEP,
        [_speed(motors[0], DRIVE, slowest, 2), Wait(3 * slowest + slowest // 8), _read(motors[0])],
    )
    yield "single steps both ways", Loop.BUSY, list(_single_steps(motors, fastest))
    yield "restart while running", Loop.BUSY, list(_restarts(motors, fastest))
    yield "stop while running", Loop.BUSY, list(_stops(motors, fastest))
    yield "stop at every point of a period", Loop.BUSY, list(_stops_everywhere(motors, fastest))
    yield "change at every point of a period", Loop.BUSY, list(_changes_everywhere(motors, fastest))
    yield "millisecond end points", Loop.BUSY, list(_millis_ends(motors, fastest))
    second = plan.board.f_cpu_hz
    yield (
        "every short millisecond end point",
        Loop.BUSY,
        list(_short_millis_ends(motors, fastest, second // 1000)),
    )
    yield (
        "millisecond end points at slow rates",
        Loop.SLEEP,
        list(_slow_millis_ends(motors, second)),
    )
    yield "refused calls", Loop.BUSY, list(_refusals(motors, fastest, slowest))
    yield "hold and release", Loop.BUSY, list(_hold_and_release(motors, fastest))
    if len(motors) > 1:
        yield "all motors at once", Loop.BUSY, list(_together(motors, fastest))
    yield "a busy, hostile sketch", Loop.HOSTILE, list(_hostile(motors, fastest))


def _speed(motor: int, control: int, top: int, limit: int = 0) -> Call:
    return Call(CallKind.SET_SPEED, motor, control, top, limit)


def _read(motor: int) -> Call:
    return Call(CallKind.READ, motor)


def _each(motors: Sequence[int], control: int, top: int, limit: int = 0) -> Iterator[Call]:
    return (_speed(motor, control, top, limit) for motor in motors)


def _long_moves(motors: Sequence[int], fastest: int) -> Iterator[Action]:
    for motor in motors:
        yield _speed(motor, DRIVE, fastest, _LONG_MOVE_STEPS)
        yield Wait((_LONG_MOVE_STEPS + 2) * fastest)
        yield _read(motor)


def _single_steps(motors: Sequence[int], fastest: int) -> Iterator[Action]:
    for motor in motors:
        for control in (DRIVE, DRIVE, BACK, BACK, BACK, DRIVE):
            yield _speed(motor, control, fastest, 1)
            yield Wait(3 * fastest)
        yield _read(motor)


def _restarts(motors: Sequence[int], fastest: int) -> Iterator[Action]:
    """
    Change speed, direction and limit in mid-run: same prescaler, and across prescalers.
    """
    for motor in motors:
        for control, top, limit, wait in (
            (DRIVE, fastest, 0, 100_000),
            (BACK, fastest, 0, 60_001),
            (BACK, 10_007, 0, 90_000),
            (DRIVE, 65_535, 0, 300_000),
            (DRIVE, 65_536, 0, 300_000),
            (BACK, 800_000, 0, 1_700_000),
            (DRIVE, fastest, 300, 100_000),
            (DRIVE, fastest, 1_000, 20_000),
            (DRIVE, 524_288, 5, 1_100_000),
            (BACK, 2_000_003, 3, 9_000_000),
            (DRIVE, fastest, 0, 20_000),
            (BACK, 70_003, 1, 200_000),  # the longest way: the timer is set anew, and the end
        ):
            yield _speed(motor, control, top, limit)
            yield Wait(wait)
            yield _read(motor)


def _stops(motors: Sequence[int], fastest: int) -> Iterator[Action]:
    for motor in motors:
        for stop in (_speed(motor, 0, 0), _speed(motor, DRIVE, 0), _speed(motor, 0, 5_000)):
            yield _speed(motor, BACK, fastest)
            yield Wait(41_234)
            yield stop
            yield Wait(_SETTLE_CYCLES)
            yield _read(motor)


def _stops_everywhere(motors: Sequence[int], fastest: int) -> Iterator[Action]:
    """
    Stop and start again, each time a cycle later in the period, past its end.

    The period varies too, or the loop of the sketch would always meet it at the same points.
    """
    for motor in motors:
        for offset in range(fastest + 60):
            yield _speed(motor, DRIVE, fastest + offset % 17)
            yield Wait(2 * fastest + offset)
            yield _speed(motor, DRIVE, 0)
            yield Wait(fastest)
        yield _read(motor)


def _changes_everywhere(motors: Sequence[int], fastest: int) -> Iterator[Action]:
    """
    Change speed in mid-run, each time a little later in the period, past its end.
    """
    for motor in motors:
        for offset in range(0, fastest + 60, 7):
            yield _speed(motor, DRIVE if offset % 2 else BACK, fastest + offset % 17)
            yield Wait(3 * fastest + offset)
            yield _speed(motor, BACK, fastest + 160 + offset)
            yield Wait(3 * fastest)
            yield _speed(motor, DRIVE, 66_000)
            yield Wait(100_000)
        yield _read(motor)
        yield _speed(motor, 0, 0)


def _millis_ends(motors: Sequence[int], fastest: int) -> Iterator[Action]:
    for motor in motors:
        for control, top, milliseconds in (
            (MILLIS, fastest, 1),
            (MILLIS, fastest, 25),
            (MILLIS | BACK, 7_000, 10),
            (MILLIS, 900_000, 30),
            (MILLIS, fastest, 0),
        ):
            yield _speed(motor, control, top, milliseconds)
            yield Wait(300_000)
            yield _read(motor)
        yield _speed(motor, MILLIS, fastest, 1_000)
        yield Wait(50_000)
        yield _speed(motor, MILLIS, 70_000, 40)
        yield Wait(1_000_000)
        yield _read(motor)
        yield _speed(motor, DRIVE, 4_000)
        yield Wait(60_000)
        yield _speed(motor, MILLIS, 100_000, 32_768)  # laps are counted, and a timer set anew
        yield Wait(1_000_000)
        yield _read(motor)
        yield _speed(motor, 0, 0)


def _short_millis_ends(motors: Sequence[int], fastest: int, millisecond: int) -> Iterator[Action]:
    """
    End after each number of milliseconds up to where the clock has passed over one: it jumps.

    It leaves one out each 42 ms at 16 MHz, and every other one at 8 MHz.
    """
    for motor in motors:
        for milliseconds in range(1, 16):
            yield _speed(motor, MILLIS, fastest, milliseconds)
            yield Wait((milliseconds + 3) * millisecond)
            yield _read(motor)


def _slow_millis_ends(motors: Sequence[int], second: int) -> Iterator[Action]:
    """
    End far beyond 32 768 ms, and between two slow steps.
    """
    for motor in motors:
        yield _speed(motor, MILLIS, second, 33_500)
        yield Wait(34 * second)
        yield _read(motor)
        yield _speed(motor, MILLIS, second, 1_500)
        yield Wait(26 * second // 16)
        yield _read(motor)
        yield Wait(second)
        yield _read(motor)


def _refusals(motors: Sequence[int], fastest: int, slowest: int) -> Iterator[Action]:
    for motor in motors:
        yield _speed(motor, DRIVE, fastest, 500)
        for call in (
            _speed(motor, DRIVE, fastest - 1),
            _speed(motor, DRIVE, 1),
            _speed(motor, DRIVE, slowest + 1),
            _speed(motor, DRIVE, 0xFFFF_FFFF),
            _speed(motor, DRIVE | 0x40, fastest),
            _speed(motor, DRIVE | 0x3A, fastest),
        ):
            yield call
            yield _read(motor)
            yield Wait(5_000)
        yield Wait(510 * fastest)
        yield _read(motor)
        yield _speed(motor, DRIVE, fastest, 2)
        yield Wait(5 * fastest)
        yield _read(motor)


def _hold_and_release(motors: Sequence[int], fastest: int) -> Iterator[Action]:
    for motor in motors:
        for kind in (CallKind.HOLD, CallKind.RELEASE, CallKind.HOLD):
            yield Call(kind, motor)
            yield _read(motor)
        yield _speed(motor, DRIVE, 30_000, 3)
        yield Wait(40_000)
        yield Call(CallKind.HOLD, motor)
        yield Call(CallKind.RELEASE, motor)
        yield _read(motor)
        yield Wait(60_000)
        yield Call(CallKind.RELEASE, motor)
        yield Wait(60_000)
        yield _speed(motor, BACK, fastest, 7)
        yield Wait(12 * fastest)
        yield _read(motor)
        yield Call(CallKind.INIT, motor)
        yield _read(motor)


def _together(motors: Sequence[int], fastest: int) -> Iterator[Action]:
    yield from _each(motors, DRIVE, fastest)
    yield Wait(1_000_000)
    for motor in motors:
        yield _speed(motor, BACK, fastest + 13 * motor, 400)
        yield Wait(3 * fastest + 77)
    yield Wait(500 * fastest)
    yield from (_read(motor) for motor in motors)


def _hostile(motors: Sequence[int], fastest: int) -> Iterator[Action]:
    for control, top, limit in (
        (DRIVE, fastest, 3_000),
        (BACK, 3_333, 400),
        (MILLIS, fastest, 60),
        (BACK, 70_000, 20),
    ):
        yield from _each(motors, control, top, limit)
        yield Wait(2_000_000)
        yield from (_read(motor) for motor in motors)

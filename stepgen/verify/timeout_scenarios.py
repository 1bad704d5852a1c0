"""
Scenarios for motors with a command time-out: left alone, kept alive, and at an end point before it.
"""

from collections.abc import Iterator

from stepgen.plan.model import Plan
from stepgen.reference.contract import Control
from stepgen.verify.bench import Call, CallKind, Loop
from stepgen.verify.scenarios import BACK, DRIVE, MILLIS, Action, Scenario, Wait

_PHASES = 16  # of the clock of millis(), at which a time-out begins
_EVENTS = DRIVE | Control.SPEED_VARIABLE | Control.FASTER


def timeout_scenarios(plan: Plan) -> Iterator[Scenario]:
    """
    Yield the scenarios for each motor of *plan* that has a command time-out.
    """
    for index, motor in enumerate(plan.motors):
        if motor.command_timeout_ms is not None:
            silence = Silence(plan, index, motor.command_timeout_ms)
            for name, loop, actions in silence.scenarios():
                yield Scenario(f"{motor.name}: {name}", loop, tuple(actions))


class Silence:
    """
    What a sketch does, or does not, with motor number *index* of *plan*.
    """

    def __init__(self, plan: Plan, index: int, timeout_ms: int) -> None:
        self._millisecond = plan.board.f_cpu_hz // 1000
        self._timeout = timeout_ms * self._millisecond
        self._fastest = plan.minimum_period_cycles
        self._index = index
        self._changes = plan.motors[index].motion.changes_speed
        self._longest = plan.largest_period_cycles

    def scenarios(self) -> Iterator[tuple[str, Loop, Iterator[Action]]]:
        """
        Yield name, loop and actions of each.
        """
        yield "left alone", Loop.BUSY, self._left_alone()
        yield "left alone at any point of a millisecond", Loop.BUSY, self._at_any_point()
        yield "kept alive, then no more", Loop.HOSTILE, self._kept_alive()
        yield "spoken to again in the interval after the time-out", Loop.BUSY, self._just_in_time()
        yield "end points before the time-out and after it", Loop.BUSY, self._end_points()
        yield "calls that are no sign of life", Loop.BUSY, self._no_signs()
        if self._changes:
            yield "left alone with update events", Loop.BUSY, self._events()

    def _speed(self, control: int, top: int, limit: int = 0, *update: int) -> Call:
        return Call(CallKind.SET_SPEED, self._index, control, top, limit, *update)

    def _do(self, kind: CallKind, control: int = 0) -> Call:
        return Call(kind, self._index, control)

    @property
    def _read(self) -> Call:
        return self._do(CallKind.READ)

    def _silence(self, top: int) -> Wait:
        return Wait(self._timeout + 4 * self._millisecond + 2 * top)

    def _left_alone(self) -> Iterator[Action]:
        for control, top in (
            (DRIVE, self._fastest),
            (BACK, 7_001),
            (DRIVE, 70_000),
            (BACK, min(self._timeout // 3, self._longest)),
            (DRIVE, min(2 * self._timeout, self._longest)),  # not even one step
        ):
            yield self._speed(control, top)
            yield Wait(self._timeout // 2)
            yield self._read
            yield self._silence(top)
            yield self._read
            yield self._speed(DRIVE, self._fastest, 5)
            yield self._read
            yield Wait(8 * self._fastest)
            yield self._read
        yield self._speed(DRIVE, self._fastest)
        yield self._silence(self._fastest)
        yield self._do(CallKind.INIT)
        yield self._read

    def _at_any_point(self) -> Iterator[Action]:
        for phase in range(_PHASES):
            yield self._speed(DRIVE, 1_999)
            yield self._silence(1_999)
            yield self._read
            yield Wait(self._millisecond * phase // _PHASES + 97)

    def _kept_alive(self) -> Iterator[Action]:
        yield self._speed(BACK, self._fastest + 3)
        for _ in range(6):
            yield Wait(self._timeout * 2 // 3)
            yield self._do(CallKind.KEEP_ALIVE)
            yield self._read
        yield Wait(self._timeout * 2 // 3)
        yield self._speed(DRIVE, 5_003)
        yield Wait(self._timeout * 2 // 3)
        yield self._read
        yield self._silence(5_003)
        yield self._read
        yield self._do(CallKind.KEEP_ALIVE)  # too late: the motor stands
        yield Wait(50_000)
        yield self._read

    def _just_in_time(self) -> Iterator[Action]:
        """
        Yield a step due a quarter of the time-out after its end; the sketch is back before.
        """
        top = min(self._timeout * 5 // 4, self._longest)
        yield self._speed(DRIVE, top)
        yield Wait(self._timeout * 9 // 8)
        yield self._do(CallKind.KEEP_ALIVE)
        yield Wait(self._timeout // 4)
        yield self._read
        yield self._silence(top)
        yield self._read

    def _end_points(self) -> Iterator[Action]:
        steps = self._timeout // 2 // self._fastest
        half = max(self._timeout // self._millisecond // 2, 1)
        for control, limit in (
            (DRIVE, steps),
            (MILLIS, half),
            (DRIVE, 4 * steps),
            (MILLIS, 4 * half),
        ):
            yield self._speed(control, self._fastest, limit)
            yield self._silence(self._fastest)
            yield self._read
        yield self._speed(DRIVE, min(self._timeout * 3 // 4, self._longest), 1)
        yield self._silence(self._timeout)  # it lets go of its coils later than the time-out
        yield self._read

    def _no_signs(self) -> Iterator[Action]:
        yield self._speed(DRIVE, 4_001)
        for call in (
            self._speed(DRIVE, 1),
            self._speed(DRIVE, 0xFFFF_FFFF),
            self._do(CallKind.HOLD),
            self._do(CallKind.RELEASE),
            self._read,
        ):
            yield Wait(self._timeout // 4)
            yield call
        yield Wait(self._timeout // 4)
        yield self._read
        yield self._do(CallKind.HOLD)
        yield self._read

    def _events(self) -> Iterator[Action]:
        for control in (_EVENTS, _EVENTS | Control.IRQ_TIMING):
            yield self._speed(int(control), 9_001, 0, 40, 3, 100)
            for _ in range(8):
                yield Wait(self._timeout // 7)
                yield self._do(CallKind.UPDATE_CHECK)
                yield self._read
            yield self._silence(9_001)
            yield self._do(CallKind.UPDATE_CHECK)
            yield self._read

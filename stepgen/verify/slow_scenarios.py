"""
Scenarios for motors whose steps can be minutes apart: many laps, and limits that end between steps.
"""

from collections.abc import Iterator

from stepgen.plan.model import Plan
from stepgen.verify.bench import Call, CallKind, Loop
from stepgen.verify.scenarios import BACK, DRIVE, MILLIS, Action, Scenario, Wait

_USUAL_CYCLES = 65_535 * 1024
# Around 65536 laps of 16384 clocks, where a count of laps leaves 16 bits.
_PERIODS = ((1 << 30) - 1, (1 << 30) + 16_384 + 5)
# A limit that is counted in laps of 16.384 s, and how long after its start the status is read: just
# before its end and after, and when a comparison of 16 bits would have come round.
_LIMIT_MS = 36_000
_READS_MS = (35_900, 36_100, 68_900, 101_700)


def slow_scenarios(plan: Plan) -> Iterator[Scenario]:
    """
    Yield the scenarios for each motor of *plan* with longer periods than usual.
    """
    slowest = plan.largest_period_cycles
    if slowest <= _USUAL_CYCLES:
        return
    ms = plan.board.f_cpu_hz // 1000
    for index, motor in enumerate(plan.motors):
        for name, actions in (
            ("more laps than 16 bits count", _many_laps(index, slowest)),
            ("a millisecond end point long before the next step", _early_end(index, slowest, ms)),
            ("a millisecond end point between two steps", _end_between(index, slowest)),
        ):
            yield Scenario(f"{motor.name}: {name}", Loop.SLEEP, tuple(actions))


def _many_laps(motor: int, slowest: int) -> Iterator[Action]:
    for period in (each for each in _PERIODS if each <= slowest):
        yield Call(CallKind.SET_SPEED, motor, BACK, period)
        yield Wait(period + period // 16)
        yield Call(CallKind.READ, motor)
        yield Call(CallKind.SET_SPEED, motor, DRIVE, 0)


def _early_end(motor: int, slowest: int, ms: int) -> Iterator[Action]:
    """
    Let a limit end in the first interval, and show that it stays over until the step is due.
    """
    begin = 0
    yield Call(CallKind.SET_SPEED, motor, MILLIS, slowest, _LIMIT_MS)
    for moment in (each for each in _READS_MS if each * ms < slowest):
        yield Wait((moment - begin) * ms)
        yield Call(CallKind.READ, motor)
        begin = moment
    yield Wait(max(slowest - begin * ms, 0) + ms)
    yield Call(CallKind.READ, motor)


def _end_between(motor: int, slowest: int) -> Iterator[Action]:
    """
    Let a limit end in the second interval, whose step is not made.
    """
    period = min(slowest, _USUAL_CYCLES * 6)  # 25 s
    yield Call(CallKind.SET_SPEED, motor, MILLIS, period, _LIMIT_MS)
    yield Wait(2 * period + period // 8)
    yield Call(CallKind.READ, motor)

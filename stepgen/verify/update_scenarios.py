"""
Scenarios for motors whose speed changes by itself: the recorded runs, and each kind of event.
"""

from collections.abc import Iterator

from stepgen.plan.model import Plan
from stepgen.reference.contract import Control
from stepgen.verify.bench import Call, CallKind, Loop
from stepgen.verify.scenarios import Action, Scenario, Wait

_DRIVE = Control.DRV_EN | Control.SPEED_VARIABLE
_BY_ISR = _DRIVE | Control.IRQ_TIMING
_FASTER, _POWER = Control.FASTER, Control.VARIABLE_PWR
_STEPS, _BACK = Control.UPDATE_STEPS, Control.DIRECTION


def update_scenarios(plan: Plan) -> Iterator[Scenario]:
    """
    Yield the scenarios for each motor of *plan* that has update events.
    """
    for index, motor in enumerate(plan.motors):
        if motor.motion.kind == "update-events":
            yield from _of_motor(index, plan)


def _of_motor(motor: int, plan: Plan) -> Iterator[Scenario]:
    """
    Yield the runs of system 1's log (case 1 and 2), then the corners that it does not reach.
    """
    cycles_per_ms = plan.board.f_cpu_hz // 1000
    fastest = plan.minimum_period_cycles

    def speed(control: int, top: int, limit: int, *update: int) -> Call:
        return Call(CallKind.SET_SPEED, motor, int(control), top, limit, *update)

    def wait(milliseconds: float) -> Wait:
        return Wait(round(milliseconds * cycles_per_ms))

    def checks(count: int, milliseconds: float) -> list[Action]:
        check = Call(CallKind.UPDATE_CHECK, motor)
        return [wait(milliseconds), check, read] * count

    def scenario(name: str, loop: Loop, *actions: Action) -> Scenario:
        return Scenario(f"{plan.motors[motor].name}: {name}", loop, actions)

    read = Call(CallKind.READ, motor)
    callbacks = Call(CallKind.CALLBACKS, motor, 3)
    yield scenario(
        "recorded run 1, slowing down",
        Loop.SLEEP,
        speed(_BY_ISR | _POWER, 15_000, 8_900, 64, 1_000, 19),
        wait(13_500),
        read,
    )
    yield scenario(
        "an event that is due with the last step",
        Loop.BUSY,
        callbacks,
        speed(_BY_ISR | _STEPS | _FASTER, 4_000, 10, 5_000, 10, 1),
        *checks(3, 2),
    )
    yield scenario(
        "a millisecond limit that has passed when the sketch looks for an event",
        Loop.BUSY,
        callbacks,
        speed(_DRIVE | Control.ENDPOINT_MILLIS, 60_000_000, 20, 60_000_000, 25, 1),
        *checks(2, 30),
    )
    yield scenario(
        "recorded run 2, speeding up",
        Loop.SLEEP,
        speed(_BY_ISR | _POWER | _FASTER, 4_800_000, 0, 2_385_000, 1_000, 11),
        wait(12_500),
        read,
    )
    yield scenario(
        "an event with each step, each with another prescaler",
        Loop.BUSY,
        speed(_BY_ISR | _POWER | Control.ENDPOINT_MILLIS, 60_000, 60_000, 400_000, 1, 5),
        wait(1_000),
        read,
        speed(0, 0, 0),
    )
    yield scenario(
        "events each few steps, by the interrupt",
        Loop.BUSY,
        speed(_BY_ISR | _STEPS | _FASTER, 20_000, 40, 500, 3, 9),
        wait(60),
        read,
        speed(_BY_ISR | _STEPS, 20_000, 700, 500, 200, 3),
        wait(1_000),
        read,
    )
    yield scenario(
        "events each few steps, by the sketch",
        Loop.BUSY,
        speed(_DRIVE | _STEPS | _FASTER | _BACK, 20_000, 400, 500, 3, 9),
        *checks(30, 7),
    )
    yield scenario(
        "events each few milliseconds, by the sketch",
        Loop.BUSY,
        speed(_DRIVE | _FASTER, 100_000, 100, 5_000, 10, 9),
        *checks(40, 7.3),
    )
    yield scenario(
        "events each few milliseconds, by the interrupt, across prescalers",
        Loop.HOSTILE,
        speed(_BY_ISR | _FASTER, 100_000, 300, 5_000, 3, 30),
        wait(700),
        read,
        speed(_BY_ISR, fastest, 0, 7_000, 2, 40),
        wait(200),
        read,
        speed(Control.DRV_EN, 0, 0),
        read,
    )
    yield scenario(
        "both ends of the range, with callbacks",
        Loop.SLEEP,
        callbacks,
        speed(_BY_ISR | _FASTER, fastest + 360, 0, 100, 2, 30),
        wait(30),
        *checks(2, 1),
        speed(_BY_ISR | _POWER, 60_000_000, 0, 5_000_000, 1, 30),
        wait(9_000),
        *checks(2, 1),
        speed(_DRIVE, fastest, 20, 0, 1, 1),
        *checks(2, 1),
        speed(Control.DRV_EN, fastest, 20),
        *checks(3, 2),
    )
    yield scenario(
        "a millisecond limit beside events",
        Loop.BUSY,
        speed(_BY_ISR | _FASTER | Control.ENDPOINT_MILLIS, 50_000, 100, 1_000, 7, 30),
        wait(150),
        read,
    )

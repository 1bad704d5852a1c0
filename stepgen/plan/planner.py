"""
From a spec to a plan: boards, pins, timers, kernels, and every conflict between them.
"""

from collections.abc import Iterable
from fractions import Fraction

from stepgen.devices import SKETCH_LIBRARIES, Board, boards, find_board, library_claims
from stepgen.plan.claims import (
    Claim,
    drive_claims,
    report_conflicts,
    sketch_claims,
    timing_claims,
)
from stepgen.plan.coils import CoilDrive
from stepgen.plan.drives import plan_drive
from stepgen.plan.faults import Faults
from stepgen.plan.isr import Storage, allocate, compose
from stepgen.plan.kernels import Kernel, choose_kernel
from stepgen.plan.model import MotorPlan, Plan, TimerPlan
from stepgen.plan.timings import plan_timing
from stepgen.plan.timings.fast_pwm import LARGEST_PERIOD_CYCLES
from stepgen.spec import LoadedSpec, Motor

_OTHER_INTERRUPTS_CYCLES = 110  # the core's millis interrupt
_MASKED_CYCLES = 260  # the longest stretch of the library's own calls with interrupts off
_SMALLEST_PERIOD_CYCLES = 640  # system 1: 25 000 steps/s at 16 MHz


def make_plan(loaded: LoadedSpec) -> Plan:
    """
    Decide everything about the library that *loaded* asks for.

    Raises:
        StepgenError: All conflicts and impossibilities, each with its place and a way out.
    """
    faults = Faults(loaded)
    spec = loaded.spec
    board = find_board(spec.board)
    if board is None:
        names = ", ".join(known.name for known in boards())
        faults.at("board").report(f"is no board that stepgen knows; choose one of {names}")
        faults.raise_if_any()
        raise AssertionError
    _check_uses(spec.uses, board, faults)
    timings = _plan_timings(loaded, board, faults)
    parts = {
        name: (plan_drive(motor.drive, board, _at(faults, name).at("drive")), timings[name])
        for name, motor in spec.motors.items()
    }
    report_conflicts(_claims(loaded, board, parts, faults))
    storages = allocate(board.mcu, spec.motors)
    motors = [
        _plan_motor(name, motor, parts[name], storage, (board, _at(faults, name)))
        for (name, motor), storage in zip(spec.motors.items(), storages, strict=True)
    ]
    faults.raise_if_any()
    planned = tuple(motor for motor in motors if motor)
    return Plan(
        library=spec.library,
        board=board,
        motors=planned,
        masked_bound_cycles=_MASKED_CYCLES,
        minimum_period_cycles=_minimum_period_cycles(planned),
        largest_period_cycles=LARGEST_PERIOD_CYCLES,
        uses=spec.uses,
    )


def _minimum_period_cycles(motors: tuple[MotorPlan, ...]) -> int:
    """
    Return the shortest period in which no overflow of any motor can be missed.

    The timer keeps one overflow that waits, not two: each must be served before the next. It
    waits for a call of the library with interrupts off, for every other interrupt once, and
    for what a motor's own last interrupt ran over its period P: own + others - P. So
    P > others + (own + others - P), which is P > others + own / 2.
    """
    shortest = _SMALLEST_PERIOD_CYCLES
    every = sum(motor.isr_bound_cycles for motor in motors)
    for motor in motors:
        own = motor.isr_bound_cycles
        others = every - own + _OTHER_INTERRUPTS_CYCLES + _MASKED_CYCLES
        shortest = max(shortest, others + own // 2 + 1)
    return shortest


def _at(faults: Faults, motor: str) -> Faults:
    return faults.at("motors", motor)


def _check_uses(uses: tuple[str, ...], board: Board, faults: Faults) -> None:
    for index, name in enumerate(uses):
        if library_claims(name, board) is None:
            known = ", ".join(n for n in SKETCH_LIBRARIES if library_claims(n, board))
            faults.at("uses", index).report(
                f"stepgen does not know what {name} takes on the {board.title}; it knows {known}"
            )


def _plan_timings(loaded: LoadedSpec, board: Board, faults: Faults) -> dict[str, TimerPlan | None]:
    """
    Return each motor's timer; those that name one choose before those that take what is free.
    """
    motors = loaded.spec.motors
    named = {name for name, motor in motors.items() if _timer(motor) is not None}
    plans: dict[str, TimerPlan | None] = {}
    for name in sorted(motors, key=lambda name: name not in named):
        free = free_timers(board, loaded.spec.uses, plans.values())
        place = _at(faults, name).at("timing")
        plans[name] = plan_timing(motors[name].timing, board, free, place)
    return plans


def _timer(motor: Motor) -> int | None:
    timer: int | None = getattr(motor.timing, "timer", None)
    return timer


def free_timers(
    board: Board, uses: tuple[str, ...], taken: Iterable[TimerPlan | None]
) -> tuple[int, ...]:
    """
    Return the 16-bit timers of *board* that neither *uses* nor the plans in *taken* need.
    """
    busy = {plan.timer.number for plan in taken if plan}
    for name in uses:
        library = library_claims(name, board)
        if library:
            several = library.objects_per_timer is not None
            busy.update(library.timers[:1] if several else library.timers)
    numbers = (timer.number for timer in board.mcu.timers16)
    return tuple(number for number in numbers if number not in busy)


def _claims(
    loaded: LoadedSpec,
    board: Board,
    parts: dict[str, tuple[CoilDrive | None, TimerPlan | None]],
    faults: Faults,
) -> Iterable[Claim]:
    uses = loaded.spec.uses
    free = free_timers(board, uses, (timing for _, timing in parts.values()))
    yield from sketch_claims(board, uses, faults)
    for name, (drive, timing) in parts.items():
        place = _at(faults, name)
        if drive:
            yield from drive_claims(name, drive, place)
        if timing:
            yield from timing_claims(name, timing, free, place)


def _plan_motor(
    name: str,
    motor: Motor,
    parts: tuple[CoilDrive | None, TimerPlan | None],
    storage: Storage,
    context: tuple[Board, Faults],
) -> MotorPlan | None:
    board, faults = context
    drive, timing = parts
    kernel = drive and choose_kernel(
        drive, board.mcu, owned=motor.port == "owned", faults=faults.at("drive")
    )
    if not (drive and timing and kernel):
        return None
    # avr-gcc takes a function for an interrupt handler only when it is called __vector...
    handler = f"__vector_{name}_boundary"
    return MotorPlan(
        name=name,
        motion=motor.motion.kind,
        drive=drive,
        kernel=kernel,
        timing=timing,
        storage=storage,
        handler=handler,
        hot_path=compose(kernel, storage, board.mcu, handler),
        steps_per_turn=_steps_per_turn(motor, drive),
        releases_at_rest=motor.at_rest == "release",
        owns_ports=motor.port == "owned",
    )


def _steps_per_turn(motor: Motor, drive: CoilDrive) -> Fraction | None:
    if motor.steps_per_turn is None:
        return None
    return motor.steps_per_turn.exact * drive.steps_per_full_step


__all__ = ["Kernel", "free_timers", "make_plan"]

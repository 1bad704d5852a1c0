"""
From a spec to a plan: boards, pins, timers, kernels, and every conflict between them.
"""

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction

from stepgen.devices import Board, boards, find_board
from stepgen.plan.claims import (
    Claim,
    drive_claims,
    report_conflicts,
    sketch_claims,
    switch_claims,
    timing_claims,
)
from stepgen.plan.curves import FRACTION
from stepgen.plan.drives import plan_drive
from stepgen.plan.end_stops import plan_end_stops
from stepgen.plan.faults import Faults
from stepgen.plan.instructions import Storage, allocate
from stepgen.plan.isr import Motion, compose
from stepgen.plan.kernels import Drive, choose_kernel
from stepgen.plan.ladder_isr import compose_ladder
from stepgen.plan.limits import (
    Chip,
    everything,
    held_off,
    rate_limit,
    situations,
)
from stepgen.plan.long_periods import report_impatience, report_unlike
from stepgen.plan.model import Left, MotorPlan, Plan, RateLimit, TimerPlan
from stepgen.plan.motions import plan_motion
from stepgen.plan.polls import Polls, with_switches
from stepgen.plan.scale import Scale
from stepgen.plan.timings import plan_gate, plan_timing, way_out
from stepgen.plan.uses import Use, read_uses
from stepgen.spec import LoadedSpec, Motor


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
    uses = read_uses(spec.uses, board, lambda at, reason: faults.at("uses", at).report(reason))
    timings = _plan_timings(loaded, uses.values(), board, faults)
    parts = {name: (_drive(loaded, name, board, faults), timings[name]) for name in spec.motors}
    report_conflicts((*_claims(uses, board, parts, faults), *_switch_claims(loaded, board, faults)))
    storages = allocate(board.mcu, spec.motors)
    motors = [
        _plan_motor(name, motor, parts[name], storage, (board, _at(faults, name)))
        for (name, motor), storage in zip(spec.motors.items(), storages, strict=True)
    ]
    faults.raise_if_any()
    planned = tuple(motor for motor in motors if motor)
    report_unlike(planned, faults)
    masked = max(motor.masked_bound_cycles for motor in planned)
    alone = Chip(board, planned, (), masked)
    rates = _rates(alone, uses.values(), faults)
    proven = max(limits[-1].period_cycles for limits in rates.values())
    minimum = _minimum_period_cycles(planned, proven, board)
    _report_wishes(planned, rates, board, faults)
    faults.raise_if_any()
    return Plan(
        library=spec.library,
        board=board,
        motors=planned,
        masked_bound_cycles=masked,
        proven_period_cycles=proven,
        minimum_period_cycles=minimum,
        largest_period_cycles=min(motor.timing.largest_period_cycles for motor in planned),
        uses=spec.uses,
        rates=rates,
        held_off=held_off(everything(alone, uses.values()), minimum),
        watchdog_ms=spec.watchdog_ms,
    )


def _rates(
    alone: Chip, uses: Collection[Use], faults: Faults
) -> Mapping[str, tuple[RateLimit, ...]]:
    """
    Return the highest rates of each motor: alone, beside millis, and beside all of *uses*.

    Raises:
        StepgenError: A motor loses steps at every rate.
    """
    rates = {}
    chips = dict(situations(alone, uses))
    for motor in alone.motors:
        limits = [rate_limit(chip, motor, beside) for beside, chip in chips.items()]
        rates[motor.name] = tuple(limit for limit in limits if limit)
        if None in limits:
            _at(faults, motor.name).at("timing").report(
                f"interrupts and calls of this library could keep timer "
                f"{motor.timing.timer.number} waiting too long for {motor.timing.kind}; take "
                "`timing: fast-pwm`, `motion: constant`, pins on fewer ports, or less in `uses`"
            )
    faults.raise_if_any()
    return rates


def _minimum_period_cycles(motors: Sequence[MotorPlan], proven: int, board: Board) -> int:
    """
    Return the shortest period that the library accepts: of the fastest wish, if all have one.
    """
    wishes = [_period_of(motor, board) for motor in motors]
    known = [period for period in wishes if period]
    return max(proven, min(known)) if len(known) == len(wishes) else proven


def _period_of(motor: MotorPlan, board: Board) -> int | None:
    wish = motor.wish_steps_per_second
    return None if wish is None else int(board.f_cpu_hz / wish)


def _report_wishes(
    motors: Iterable[MotorPlan],
    rates: Mapping[str, tuple[RateLimit, ...]],
    board: Board,
    faults: Faults,
) -> None:
    """
    Report each motor that is wished to be faster than proven, or slower than it can be.
    """
    for motor in motors:
        limits = rates[motor.name]
        period = _period_of(motor, board)
        place = _at(faults, motor.name).at(*motor.motion.wish_field)
        if period and period < limits[-1].period_cycles:
            highest = int(limits[-1].steps_per_second)
            fine = [limit.beside for limit in limits[1:-1] if limit.period_cycles <= period]
            escape = f", or empty `uses`: {fine[0]} it is safe" if fine else ""
            place.report(
                f"is more than the {highest} steps/s that are proven to lose none "
                f"{limits[-1].beside}: {limits[-1].cause}; take {highest} or less{escape}"
            )
        elif period and period > (longest := motor.timing.largest_period_cycles):
            place.report(
                f"is less than a step in {longest} clocks, the longest period of "
                f"{motor.timing.kind}; take {board.f_cpu_hz / longest:.3g} or more"
            )


def _at(faults: Faults, motor: str) -> Faults:
    return faults.at("motors", motor)


def _drive(loaded: LoadedSpec, motor: str, board: Board, faults: Faults) -> Drive | None:
    motors = loaded.spec.motors
    beside = [other.drive for name, other in motors.items() if name != motor]
    return plan_drive(motors[motor].drive, beside, board, _at(faults, motor).at("drive"))


def _plan_timings(
    loaded: LoadedSpec, uses: Iterable[Use], board: Board, faults: Faults
) -> dict[str, TimerPlan | None]:
    """
    Return each motor's timer; those that name most of it choose first.
    """
    motors = loaded.spec.motors
    plans: dict[str, TimerPlan | None] = {}
    for name in sorted(motors, key=lambda name: -_named(motors[name])):
        left = Left(free_timers(board, uses, plans.values()), _channels(plans.values()))
        place = _at(faults, name).at("timing")
        plans[name] = plan_timing(motors[name].timing, board, left, place)
    return plans


def _named(motor: Motor) -> int:
    """
    Return how much of its timer *motor* names: timer and channel, the timer, or nothing.
    """
    return sum(getattr(motor.timing, part, None) is not None for part in ("timer", "channel"))


def _channels(taken: Iterable[TimerPlan | None]) -> dict[int, tuple[str, ...]]:
    """
    Return the channels that the plans in *taken* have, by timer.
    """
    channels: dict[int, tuple[str, ...]] = {}
    for plan in taken:
        if plan and plan.channel:
            number = plan.timer.number
            channels[number] = (*channels.get(number, ()), plan.channel)
    return channels


def free_timers(
    board: Board, uses: Iterable[Use], taken: Iterable[TimerPlan | None]
) -> tuple[int, ...]:
    """
    Return the timers of *board* that neither *uses* nor the plans in *taken* need, wide ones first.
    """
    busy = {plan.timer.number for plan in taken if plan}
    busy.update(number for use in uses for number in use.timers)
    numbers = (timer.number for timer in board.mcu.timers)
    return tuple(number for number in numbers if number not in busy)


def _claims(
    uses: Mapping[int, Use],
    board: Board,
    parts: dict[str, tuple[Drive | None, TimerPlan | None]],
    faults: Faults,
) -> Iterable[Claim]:
    free = free_timers(board, uses.values(), (timing for _, timing in parts.values()))
    motors: list[Claim] = []
    for name, (drive, timing) in parts.items():
        place = _at(faults, name)
        motors.extend(drive_claims(name, drive, place) if drive else ())
        if timing:
            motors.extend(timing_claims(name, timing, way_out(timing, board, free), place))
    return (*sketch_claims(uses, board, motors, faults), *motors)


def _switch_claims(loaded: LoadedSpec, board: Board, faults: Faults) -> Iterable[Claim]:
    for name, motor in loaded.spec.motors.items():
        if motor.limits:
            yield from switch_claims(name, motor.limits, board, _at(faults, name))


def _plan_motor(
    name: str,
    motor: Motor,
    parts: tuple[Drive | None, TimerPlan | None],
    storage: Storage,
    context: tuple[Board, Faults],
) -> MotorPlan | None:
    board, faults = context
    drive, timing = parts
    kernel = drive and choose_kernel(
        drive, board.mcu, owned=motor.port == "owned", faults=faults.at("drive")
    )
    if drive and motor.at_rest == "release" and not drive.released:
        faults.at("at_rest").report(
            "the driver has no ENABLE, so that nothing can switch its coils off; add "
            "`at_rest: hold`, or give `enable` a pin"
        )
    scale = Scale(_units(motor, drive))
    motion = plan_motion(motor, scale, board.f_cpu_hz, faults)
    end_stops = None
    if motor.limits and motion:
        end_stops = plan_end_stops(motor.limits, motion, scale, board, faults.at("limits"))
        motion = end_stops.limited(motion) if end_stops else None
    if timing and motion:
        report_impatience(timing, motion, faults.at("timing"))
        timing = _form(timing, motion, faults.at("timing"))
    if not (drive and timing and kernel and motion):
        return None
    # avr-gcc takes a function for an interrupt handler only when it is called __vector...
    handler = f"__vector_{name}_boundary"
    gate = plan_gate(timing, motion, storage, board.mcu)
    if motion.ladder:
        switches = end_stops.switches if end_stops else ()
        gate = with_switches(gate, switches, homes=bool(end_stops and end_stops.homing))
        polls = Polls(switches, f"__vector_{name}_limit")
        hot_path = compose_ladder(kernel, storage, board.mcu, handler, gate, polls)
    else:
        hot_path = compose(kernel, storage, board.mcu, handler, gate, motion)
    return MotorPlan(
        name=name,
        motion=motion,
        end_stops=end_stops,
        drive=drive,
        kernel=kernel,
        timing=timing,
        storage=storage,
        handler=handler,
        gate=gate,
        hot_path=hot_path,
        steps_per_turn=_steps_per_turn(motor, drive),
        steps_per_mm=motor.steps_per_mm,
        releases_at_rest=motor.at_rest == "release",
        owns_ports=motor.port == "owned",
        wish_steps_per_second=_wish(motor, motion, board),
        command_timeout_ms=motor.command_timeout_ms,
    )


def _form(timing: TimerPlan, motion: Motion, faults: Faults) -> TimerPlan | None:
    """
    Return *timing* in the form that *motion* needs; None after reporting that it has none.
    """
    if motion.forms is None:
        return timing
    form = motion.forms.get(timing.module)
    if form is None:
        faults.report(
            f"{motion.kind} needs a compare channel of a 16-bit timer; write "
            "`timing: {kind: compare, timer: 1}`"
        )
        return None
    return replace(timing, form=form)


def _wish(motor: Motor, motion: Motion, board: Board) -> Fraction | None:
    """
    Return the highest rate that the sketch will ask for: with ramps that of their top.
    """
    if motion.ladder:
        return Fraction(board.f_cpu_hz * FRACTION, motion.cruise_interval_256)
    return motor.max_steps_per_second


def _units(motor: Motor, drive: Drive | None) -> dict[str, Fraction]:
    """
    Return the steps in each unit of speeds that the spec of *motor* allows.
    """
    units = {"steps": Fraction(1)}
    if motor.steps_per_mm is not None:
        units["mm"] = motor.steps_per_mm
    if drive and (per_turn := _steps_per_turn(motor, drive)):
        units |= {"turns": per_turn, "deg": per_turn / 360}
    return units


def _steps_per_turn(motor: Motor, drive: Drive) -> Fraction | None:
    if motor.steps_per_turn is None:
        return None
    return motor.steps_per_turn.exact * drive.steps_per_full_step

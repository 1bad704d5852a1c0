"""
Speed against time: what a motor's motion does, drawn from the planner's own numbers.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from math import floor, log10

from stepgen.datasheet.names import together
from stepgen.datasheet.scene import Scene, at
from stepgen.errors import StepgenError
from stepgen.library.example_speeds import example_speed_sps
from stepgen.library.text import listed
from stepgen.plan.curves import FRACTION
from stepgen.plan.ladder import Ladder
from stepgen.plan.model import MotorPlan, Plan
from stepgen.plan.rates import Clock
from stepgen.plan.speed_wishes import Wish, plan_wish
from stepgen.units import MILLISECONDS_PER_SECOND

_WIDTH, _HEIGHT = 340, 90
_LEFT, _RIGHT, _TOP, _BOTTOM = 46, 12, 8, 18
_STEPS_OF_AN_EXAMPLE = 200
_START_FRACTION = 20
_RAMP_PERIODS = 40
_LEAST_RAMP_MS = 1000
_LOOKS = 6  # of curves in style.css.j2

Corner = tuple[float, float]


@dataclass(frozen=True)
class Curve:
    """
    A speed over time, from corner to corner of (s, steps/s), and the call that makes it.

    It is a staircase, each speed held until the next corner, unless it is *sloped*.
    """

    name: str
    corners: tuple[Corner, ...]
    call: str
    sloped: bool = False
    css: str = "c1"


@dataclass(frozen=True)
class Chart:
    """
    A drawing with its curves, and what is to be known of it.

    Args:
        name: The first of its motors.
        caption: All of them.
    """

    name: str
    caption: str
    scene: Scene
    curves: tuple[Curve, ...]
    note: str


def motion_charts(plan: Plan) -> Iterator[Chart]:
    """
    Yield speed against time, one chart for each motion; motors that do the same share a curve.

    The call of a curve is that of its first motor.
    """
    kinds: dict[str, list[MotorPlan]] = {}
    for motor in plan.motors:
        kinds.setdefault(_note(motor, plan), []).append(motor)
    for note, motors in kinds.items():
        alike: dict[tuple[str, tuple[Corner, ...]], tuple[Curve, list[str]]] = {}
        for motor in motors:
            for curve in _curves(motor, plan):
                key = (curve.name, curve.corners)
                alike.setdefault(key, (curve, []))[1].append(motor.name)
        names, called = [motor.name for motor in motors], together(motors, plan)
        curves = [
            replace(
                curve,
                name=curve.name if having == names else f"{listed(having)}, {curve.name}",
                css=f"c{number % _LOOKS + 1}",
            )
            for number, (curve, having) in enumerate(alike.values())
        ]
        scene = _draw(f"Speed of {called} against time", curves)
        yield Chart(
            names[0],
            f"{called}: speed in steps/s against time in s",
            scene,
            tuple(curves),
            note,
        )


def _curves(motor: MotorPlan, plan: Plan) -> tuple[Curve, ...]:
    """
    Return what *motor* can do: a move with ramps, update events, or one turn to and fro.
    """
    if motor.motion.ladder:
        return (_move(motor, motor.motion.ladder, plan.board.f_cpu_hz),)
    ramps = _ramps(motor, plan) if motor.motion.changes_speed else ()
    return ramps or (_there_and_back(motor, example_speed_sps(plan)),)


def _note(motor: MotorPlan, plan: Plan) -> str:
    """
    Return what is to be known of the curves of *motor*.
    """
    if motor.motion.ladder:
        return "A third of the way up, a third at the cruise speed of the spec, a third down."
    if motor.motion.changes_speed and _ramps(motor, plan):
        return (
            "From slow to the highest rate by update events: equal changes of the interval, or "
            "halved ones. stepgen plan works out others."
        )
    return (
        "No ramp: the first step comes one interval after the call, at full rate, and the last "
        "one ends the move; take rates at which motor and load can start and stop."
    )


def _move(motor: MotorPlan, ladder: Ladder, f_cpu_hz: int) -> Curve:
    """
    Return a move of three times the ramp: the ends of the rows of its table, and back down.
    """
    cruise = motor.motion.cruise_interval_256
    clocks_256, interval, up = 0, ladder.first_interval_256, []
    for row in ladder.rows:
        for _ in range(row.levels):
            if interval - row.slope_256 < cruise:
                break
            interval -= row.slope_256
            clocks_256 += interval * row.steps
        up.append((clocks_256 / FRACTION / f_cpu_hz, f_cpu_hz * FRACTION / interval))
    first = (0.0, f_cpu_hz * FRACTION / ladder.first_interval_256)
    steps = ladder.goal(cruise)
    ramp_s, cruise_sps = up[-1][0], f_cpu_hz * FRACTION / cruise
    end_s = 2 * ramp_s + steps / cruise_sps
    down = [(end_s - seconds, speed) for seconds, speed in reversed((first, *up))]
    corners = (first, *up, (ramp_s, cruise_sps), (end_s - ramp_s, cruise_sps), *down, (end_s, 0))
    return Curve(f"{3 * steps} steps", corners, f"{motor.name}Move({3 * steps});", sloped=True)


def _ramps(motor: MotorPlan, plan: Plan) -> tuple[Curve, ...]:
    """
    Return the way up to the highest rate with equal and with halved changes; none if it is slow.
    """
    clock = Clock(plan.board.f_cpu_hz)
    end = plan.minimum_period_cycles
    start = min(end * _START_FRACTION, plan.largest_period_cycles)
    start_ms = Fraction(start * MILLISECONDS_PER_SECOND, plan.board.f_cpu_hz)
    length_ms = max(Fraction(_LEAST_RAMP_MS), start_ms * _RAMP_PERIODS)
    curves = []
    for name, halving in (("equal changes", False), ("halved changes", True)):
        wish = Wish(start, end, halving=halving, duration_ms=Fraction(round(length_ms)))
        try:
            change = plan_wish(wish, clock)
        except StepgenError:  # a motor so slow that there is nothing to speed up
            continue
        corners = [
            (update.due_ms / MILLISECONDS_PER_SECOND, float(update.rate_sps))
            for update in change.updates
        ]
        tail = (corners[-1][0] * 1.08, corners[-1][1])
        call = change.call.replace("motorSetSpeed", f"{motor.name}SetSpeed", 1)
        curves.append(Curve(name, (*corners, tail), call))
    return tuple(curves)


def _there_and_back(motor: MotorPlan, speed_sps: int) -> Curve:
    """
    Return what the example Turn does at *speed_sps*: one turn, and back.
    """
    steps = round(motor.steps_per_turn or _STEPS_OF_AN_EXAMPLE)
    turn_s = steps / speed_sps
    corners = ((0, speed_sps), (turn_s, -speed_sps), (2 * turn_s, 0))
    call = (
        f"{motor.name}SetSpeed(MOTOR_CTRL_DRV_EN, motorTimerCalcPerSecond({speed_sps}), {steps});"
    )
    return Curve(f"{steps} steps there, and back", (*corners, (2.1 * turn_s, 0)), call)


def _draw(title: str, curves: Sequence[Curve]) -> Scene:
    span_s = max(x for curve in curves for x, _ in curve.corners)
    speeds = [y for curve in curves for _, y in curve.corners]
    top, bottom = max(speeds) * 1.08, min(0.0, min(speeds) * 1.08)
    scene = Scene(title, "; ".join(f"{c.name}: {c.call}" for c in curves), at(_WIDTH), at(_HEIGHT))

    def x_of(seconds: float) -> float:
        return _LEFT + seconds / span_s * (_WIDTH - _LEFT - _RIGHT)

    def y_of(speed: float) -> float:
        return _TOP + (top - speed) / (top - bottom) * (_HEIGHT - _TOP - _BOTTOM)

    right, floor_y = _WIDTH - _RIGHT, y_of(bottom)
    for seconds in ticks(span_s):
        scene.stroke(f"M{at(x_of(seconds))} {_TOP}V{at(floor_y)}", "grid")
        scene.write(x_of(seconds), floor_y + 12.5, f"{seconds:.6g}", "axis-text middle")
    for speed in _both_ways(top, bottom):
        scene.stroke(f"M{_LEFT} {at(y_of(speed))}H{right}", "zero" if speed == 0 else "grid")
        scene.write(_LEFT - 5, y_of(speed) + 3.4, f"{speed:.6g}", "axis-text end")
    for curve in curves:
        path = _line if curve.sloped else _staircase
        scene.stroke(path(curve.corners, x_of, y_of), f"curve {curve.css}", curve.name)
    return scene


def _staircase(
    corners: Sequence[Corner], x_of: Callable[[float], float], y_of: Callable[[float], float]
) -> str:
    """
    Return the path that holds each speed until the next.
    """
    (x, y), *more = corners
    start = f"M{at(x_of(0))} {at(y_of(0))}V{at(y_of(y))}" if x == 0 else ""
    return start + "".join(f"H{at(x_of(x))}V{at(y_of(y))}" for x, y in more)


def _line(
    corners: Sequence[Corner], x_of: Callable[[float], float], y_of: Callable[[float], float]
) -> str:
    """
    Return the path that goes straight from corner to corner, up from rest.
    """
    points = "L".join(f"{at(x_of(x))} {at(y_of(y))}" for x, y in corners)
    return f"M{at(x_of(0))} {at(y_of(0))}L{points}"


def _both_ways(top: float, bottom: float) -> list[float]:
    """
    Return speeds for the axis, below zero too: few, since there is little room.
    """
    up = ticks(max(top, -bottom), least=1 if bottom < 0 else 2)
    return sorted({*up, *(-speed for speed in up if speed <= -bottom)} - {-0.0} | {0})


def ticks(largest: float, least: int = 4) -> list[float]:
    """
    Return 0 and its multiples of 1, 2 or 5 times a power of ten up to *largest*: *least* or more.

    There are at most two and a half times as many.
    """
    power = 10 ** floor(log10(largest / least))
    step = max(power * factor for factor in (1, 2, 5) if power * factor <= largest / least)
    return [count * step for count in range(int(largest / step) + 1)]

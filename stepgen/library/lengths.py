"""
The view of a motor that moves something along a way: speeds, steps and positions in metric units.
"""

from dataclasses import dataclass
from fractions import Fraction

from stepgen.library.text import comment_lines
from stepgen.plan.curves import FRACTION
from stepgen.plan.model import MotorPlan

_NM_IN_A_MM = 1_000_000
_UM_IN_A_MM = 1_000
_UINT32_MAX = 0xFFFF_FFFF
_INT32_STATES = 1 << 32
_INT32_MM = _INT32_STATES / 2 / _NM_IN_A_MM

_OF_ALL = ("StepsForMicrometres", "ReadNanometres")
_SPEED, _AXIS_SPEED = "TimerCalcNanometresPerSecond", "IntervalForNanometresPerSecond"


@dataclass(frozen=True)
class Lengths:
    """
    The bodies of its functions, and what they stand for; *speed* in whole statements.

    *speed_function* is the end of the name of the one that makes of a speed what the motor takes;
    *whole* the C type of ways, which an axis can go backward, too.
    """

    speed_function: str
    whole: str
    speed: tuple[str, ...]
    steps: str
    position: str
    speed_comment: tuple[str, ...]
    steps_comment: tuple[str, ...]
    position_comment: tuple[str, ...]


def lengths(motor: MotorPlan, position: str, f_cpu_hz: int) -> Lengths | None:
    """
    Return the functions in metric units of *motor*, None if its spec names no steps per millimetre.

    *position* is the function that tells where it is, in steps.

    All is done in integers: in 32 bits where every result and what leads to it fits.
    """
    per_mm = motor.steps_per_mm
    if per_mm is None:
        return None
    nanometres = _NM_IN_A_MM / per_mm
    each = f"{float(nanometres):.10g} nm each"
    half_range_mm = float(nanometres * _INT32_STATES / 2 / _NM_IN_A_MM)
    is_axis = motor.motion.ladder is not None
    what = "virtual timer TOP"
    zero = "stops the motor"
    if is_axis:
        what, zero = "interval in 1/256 clocks", "SetSpeed refuses"
    return Lengths(
        speed_function=speed_function(motor),
        whole="int32_t" if is_axis else "uint32_t",
        speed=_interval(nanometres, f_cpu_hz) if is_axis else _top(nanometres, f_cpu_hz),
        steps=(_signed_steps if is_axis else _steps)(per_mm / _UM_IN_A_MM),
        position=_position(f"{position}()", nanometres),
        speed_comment=comment_lines(
            f"The {what} for a speed in nanometres per second, {float(per_mm):.10g} "
            f"steps in a millimetre; 0 for 0, which {zero}."
        ),
        steps_comment=comment_lines(
            f"Steps for a way in micrometres, rounded: {each}. They wrap at 2^32."
        ),
        position_comment=comment_lines(
            f"Where the motor is, in nanometres: {each}, backward ones subtracted. It is read "
            f"whole, and wraps at 32 bits: {min(half_range_mm, _INT32_MM):.6g} mm either way."
        ),
    )


def functions(motor: MotorPlan) -> tuple[str, ...]:
    """
    Return what the names of the functions in metric units of *motor* end with; none without them.
    """
    return () if motor.steps_per_mm is None else (speed_function(motor), *_OF_ALL)


def speed_function(motor: MotorPlan) -> str:
    """
    Return what the name of the function ends with that makes of a speed what *motor* takes.
    """
    return _AXIS_SPEED if motor.motion.ladder else _SPEED


def _top(nanometres: Fraction, f_cpu_hz: int) -> tuple[str, ...]:
    """
    Return the statements; only 0 gives 0, which stops the motor.

    What does not fit 32 bits is their largest and refused as too slow; less than 1 is 1, too fast.
    """
    clocks = "motorTimerGetIOclocksPerSecond()"
    number, divisor = nanometres.numerator, nanometres.denominator
    if divisor == 1 and f_cpu_hz * number <= _UINT32_MAX:
        return (
            "if (speed == 0) return 0;",
            f"const uint32_t top = {clocks} * {number}UL / speed;",
            "return top ? top : 1;",
        )
    below = "speed" if divisor == 1 else f"({divisor}ULL * speed)"
    return (
        "if (speed == 0) return 0;",
        f"const uint64_t top = {clocks} * {number}ULL / {below};",
        "if (top > UINT32_MAX) return UINT32_MAX;",
        "return top ? top : 1;",
    )


def _interval(nanometres: Fraction, f_cpu_hz: int) -> tuple[str, ...]:
    """
    Return the statements; what does not fit 32 bits is their largest, less than 1 is refused.
    """
    number, divisor = (FRACTION * f_cpu_hz * nanometres).as_integer_ratio()
    below = "speed" if divisor == 1 else f"({divisor}ULL * speed)"
    return (
        "if (speed == 0) return 0;",
        f"const uint64_t interval = {number}ULL / {below};",
        "return interval < UINT32_MAX ? interval : UINT32_MAX;",
    )


def _signed_steps(per_um: Fraction) -> str:
    number, divisor = per_um.numerator, per_um.denominator
    if divisor == 1:
        return f"static_cast<int32_t>(static_cast<uint32_t>(micrometres) * {number}UL)"
    half = divisor // 2
    return (
        f"static_cast<int32_t>((micrometres * {number}LL + (micrometres < 0 ? -{half} : {half})) / "
        f"{divisor})"
    )


def _steps(per_um: Fraction) -> str:
    number, divisor = per_um.numerator, per_um.denominator
    if divisor == 1:
        return f"micrometres * {number}UL"
    return f"static_cast<uint32_t>((micrometres * {number}ULL + {divisor // 2}) / {divisor})"


def _position(steps: str, nanometres: Fraction) -> str:
    number, divisor = nanometres.numerator, nanometres.denominator
    if divisor == 1:
        return f"static_cast<int32_t>(static_cast<uint32_t>({steps}) * {number}UL)"
    return f"static_cast<int32_t>({steps} * {number}LL / {divisor})"

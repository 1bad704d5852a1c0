"""
The view of a motor that moves something along a way: speeds, steps and positions in metric units.
"""

from dataclasses import dataclass
from fractions import Fraction

from stepgen.library.text import comment_lines
from stepgen.plan.model import MotorPlan

_NM_IN_A_MM = 1_000_000
_UM_IN_A_MM = 1_000
_UINT32_MAX = 0xFFFF_FFFF
_INT32_STATES = 1 << 32

FUNCTIONS = ("TimerCalcNanometresPerSecond", "StepsForMicrometres", "ReadNanometres")
"""What the names of its functions end with."""


@dataclass(frozen=True)
class Lengths:
    """
    The bodies of its functions, and what they stand for; *top* in whole statements.
    """

    top: tuple[str, ...]
    steps: str
    position: str
    top_comment: tuple[str, ...]
    steps_comment: tuple[str, ...]
    position_comment: tuple[str, ...]


def lengths(motor: MotorPlan, f_cpu_hz: int) -> Lengths | None:
    """
    Return the functions in metric units of *motor*, None if its spec names no steps per millimetre.

    All is done in integers: in 32 bits where every result and what leads to it fits.
    """
    per_mm = motor.steps_per_mm
    if per_mm is None:
        return None
    nanometres = _NM_IN_A_MM / per_mm
    each = f"{float(nanometres):.10g} nm each"
    half_range_mm = float(nanometres * _INT32_STATES / 2 / _NM_IN_A_MM)
    return Lengths(
        top=_top(nanometres, f_cpu_hz),
        steps=_steps(per_mm / _UM_IN_A_MM),
        position=_position(motor.name, nanometres),
        top_comment=comment_lines(
            f"The virtual timer TOP for a speed in nanometres per second, {float(per_mm):.10g} "
            "steps in a millimetre; 0 for 0, which stops the motor."
        ),
        steps_comment=comment_lines(
            f"Steps for a way in micrometres, rounded: {each}. They wrap at 2^32."
        ),
        position_comment=comment_lines(
            f"Where the motor is, in nanometres: {each}, backward ones subtracted. It is read "
            f"whole, and wraps at 32 bits: {min(half_range_mm, _INT32_MM):.6g} mm either way."
        ),
    )


_INT32_MM = _INT32_STATES / 2 / _NM_IN_A_MM


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


def _steps(per_um: Fraction) -> str:
    number, divisor = per_um.numerator, per_um.denominator
    if divisor == 1:
        return f"micrometres * {number}UL"
    return f"static_cast<uint32_t>((micrometres * {number}ULL + {divisor // 2}) / {divisor})"


def _position(name: str, nanometres: Fraction) -> str:
    number, divisor = nanometres.numerator, nanometres.denominator
    if divisor == 1:
        return f"static_cast<int32_t>(static_cast<uint32_t>({name}ReadPosition()) * {number}UL)"
    return f"static_cast<int32_t>({name}ReadPosition() * {number}LL / {divisor})"

"""
Fast PWM: registers, mode bits, and the ticks that pass until a step has set the timer anew.
"""

from dataclasses import dataclass

from stepgen.plan.model import MotorPlan
from stepgen.plan.timings.fast_pwm import PRESCALERS, choose_setting, elapsed_cycles

_BYTE_MAX = 0xFF


@dataclass(frozen=True)
class FastPwmView:
    """
    Names of a timer's registers and bits, the two values that select its mode, and the ticks.
    """

    number: int
    struct_prefix: str
    shared_by: str
    tccra: str
    tccrb: str
    tcnt: str
    ocra: str
    timsk: str
    tifr: str
    tov: str
    toie: str
    waiting: str
    mode_a: str
    mode_b: str
    linkage: str
    object: str
    elapsed_type: str
    elapsed_read: str
    elapsed_ticks: tuple[str, ...]
    elapsed_woken: int
    elapsed_limited: int
    elapsed_note: str
    wake: str


def view(motor: MotorPlan) -> FastPwmView:
    """
    Return what the partial prints of the timer of *motor*.
    """
    timer = motor.timing.timer
    n = timer.number
    elapsed = elapsed_cycles(motor)
    changes = motor.motion.changes_speed
    return FastPwmView(
        number=n,
        struct_prefix="",
        shared_by="fast_pwm",
        tccra=timer.tccra.name,
        tccrb=timer.tccrb.name,
        tcnt=timer.tcnt.name,
        ocra=timer.ocra.name,
        timsk=timer.timsk.name,
        tifr=timer.tifr.name,
        tov=f"TOV{n}",
        toie=f"TOIE{n}",
        waiting="an overflow",
        mode_a=f"_BV(WGM{n}1) | _BV(WGM{n}0)",
        mode_b=f"_BV(WGM{n}3) | _BV(WGM{n}2)",
        linkage="SHARED" if changes else "INLINE",
        object=f"near({motor.name}Motion)" if changes else f"{motor.name}Motion",
        elapsed_type="uint8_t" if max(elapsed) <= _BYTE_MAX else "uint16_t",
        elapsed_read="pgm_read_byte" if max(elapsed) <= _BYTE_MAX else "pgm_read_word",
        elapsed_ticks=tuple(_ticks(cycles) for cycles in elapsed),
        elapsed_woken=len(PRESCALERS),
        elapsed_limited=2 * len(PRESCALERS),
        elapsed_note="; then both with a limit in\n// milliseconds" if changes else "",
        wake=_wake(motor.wake_cycles),
    )


def _wake(cycles: int) -> str:
    """
    Return the setting of an interval of *cycles* as an initialiser; empty if there is none.
    """
    if not cycles:
        return ""
    setting = choose_setting(cycles)
    return f"{{{setting.top}, {PRESCALERS.index(setting.prescaler) + 1}}}"


def _ticks(cycles: int) -> str:
    """
    Return *cycles* in whole ticks of each prescaler, as entries of a table.
    """
    return " ".join(f"{cycles // prescaler}," for prescaler in PRESCALERS)

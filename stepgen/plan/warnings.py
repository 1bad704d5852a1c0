"""
Warnings: what a finished plan keeps from the sketch that the spec says nothing about.

A library that the spec names in ``uses`` is a claim, and a conflict with it an error. One that
it does not name may be used all the same, so what it would miss is said here.
"""

from collections.abc import Iterable
from dataclasses import dataclass

from stepgen.devices import CORE, SKETCH_LIBRARIES, UNBOUND, LibraryClaims, Pin, library_claims
from stepgen.plan.limits import Chip, everything, shortest_period
from stepgen.plan.model import MotorPlan, Plan
from stepgen.plan.timings import way_out
from stepgen.plan.uses import ANALOG_WRITE, accepted_uses

# What else fails beside the library itself where its pins are taken.
_ALSO = {"Serial": ", and uploading may be disturbed"}


@dataclass(frozen=True)
class PlanWarning:
    """
    Something of a plan that may surprise, with the name of the motor that it comes from, or "".

    *limit* is the rate up to which it does no harm, where it tells one.
    """

    motor: str
    cause: str
    limit: str = ""

    @property
    def reason(self) -> str:
        """
        Return what may surprise.
        """
        return f"{self.cause}, {self.limit} beside it" if self.limit else self.cause

    def __str__(self) -> str:
        """
        Return the warning as one line, beginning with the motor if it comes from one.
        """
        return f"motor {self.motor}: {self.reason}" if self.motor else self.reason


def plan_warnings(plan: Plan) -> tuple[PlanWarning, ...]:
    """
    Return what the motors of *plan* keep from libraries and functions that it does not name.

    In the order of the motors; of each motor first its timer, then its pins. Before them comes what
    a boot loader makes of the watchdog.
    """
    found = [PlanWarning("", reason) for reason in _watchdog_reasons(plan)]
    for motor in plan.motors:
        kinds = (_timer_reasons, _pwm_reasons, _pin_reasons)
        found += [PlanWarning(motor.name, text) for kind in kinds for text in kind(motor, plan)]
        found += _unbound_warnings(motor, plan)
    return tuple(found)


def _watchdog_reasons(plan: Plan) -> Iterable[str]:
    """
    Yield what a boot loader makes of a reset by the watchdog.
    """
    if plan.watchdog_ms is not None and plan.board.may_reset_for_ever:
        yield (
            "watchdog_ms: the boot loader ATmegaBOOT, which a board of this kind may have, leaves "
            "the watchdog on after its reset, and is reset again and again until the power is "
            "switched off: the motors stay off, but the sketch does not come back; Optiboot does"
        )


def _unbound_warnings(motor: MotorPlan, plan: Plan) -> Iterable[PlanWarning]:
    """
    Yield what of the core and of `uses` can hold up *motor* for longer than anything bounds.
    """
    uses = accepted_uses(plan.uses, plan.board)
    vectors = {vector.name for vector in plan.board.mcu.vectors}
    for name in (*CORE, *(use.name for use in uses)):
        unbound = UNBOUND.get(name)
        if unbound is None or unbound.vector not in vectors:
            continue
        f_cpu = plan.board.f_cpu_hz
        held = unbound.microseconds * f_cpu // 1_000_000 + unbound.cycles
        masked = plan.masked_bound_cycles + held
        chip = everything(Chip(plan.board, plan.motors, (), masked), uses)
        period = shortest_period(chip, motor)
        allowed = "no rate is safe"
        if period is not None:
            allowed = f"up to {f_cpu // period} steps/s are safe"
        cause = f"nothing bounds {name}, which {unbound.why}: it is not in the highest rate; if it "
        yield PlanWarning(motor.name, f"{cause}takes {unbound.assumed}", allowed)


def _named(plan: Plan) -> set[str]:
    return {text.split()[0] for text in plan.uses}


def _libraries(plan: Plan) -> Iterable[LibraryClaims]:
    found = (library_claims(name, plan.board) for name in SKETCH_LIBRARIES)
    return (claims for claims in found if claims)


def _timer_reasons(motor: MotorPlan, plan: Plan) -> Iterable[str]:
    """
    Yield the libraries that need the timer of *motor*, at once or with many objects.
    """
    number = motor.timing.timer.number
    for library in _libraries(plan):
        if number not in library.timers:
            continue
        objects = library.timers.index(number) * (library.objects_per_timer or 0)
        if objects and library.name in plan.uses:
            yield (
                f"{library.name} takes timer {number}, too, if more than {objects} are attached; "
                f"name their pins (`{library.name} D22 D23 ...`), or attach {objects} at most"
            )
        elif library.name not in _named(plan):
            beyond = f" if more than {objects} are attached" if objects else ""
            yield (
                f"{library.name} needs timer {number}{beyond} and will not work beside it; "
                f"{_way_out(motor, library, plan)}"
            )


def _way_out(motor: MotorPlan, library: LibraryClaims, plan: Plan) -> str:
    """
    Return what *motor* can take that neither the plan nor *library* with few objects needs.
    """
    busy = {motor.timing.timer.number for motor in plan.motors} | {library.timers[0]}
    for use in accepted_uses(plan.uses, plan.board):
        busy.update(use.timers)
    mcu = plan.board.mcu
    # Ramps need a compare channel of 16 bits.
    timers = [timer.number for timer in (mcu.timers16 if motor.motion.ladder else mcu.timers)]
    free = tuple(number for number in timers if number not in busy)
    return f"if the sketch uses it, {way_out(motor.timing, plan.board, free)}"


def _pwm_reasons(motor: MotorPlan, plan: Plan) -> Iterable[str]:
    """
    Yield the PWM pins of the motor's timer, as far as no motor has them.
    """
    if ANALOG_WRITE in _named(plan):
        return
    timer = motor.timing.timer
    taken = {pin.bit for each in plan.motors for pin in each.pins}
    free = {channel: bit for channel, bit in timer.outputs if bit not in taken}
    pins = [pin for pin in plan.board.pins if pin.bit in free.values()]
    if pins:
        top = f"it rewrites OCR{timer.number}A, and the motor would run away"
        effect = top if "A" in free else "it would follow the motor's timer"
        yield (
            f"no {ANALOG_WRITE}() on {_listed(pins, 'or')}, PWM of timer {timer.number}: "
            f"{effect}; take other pins for it"
        )


def _pin_reasons(motor: MotorPlan, plan: Plan) -> Iterable[str]:
    """
    Yield the libraries whose pins *motor* takes, and the board's LED.

    None of them is named: with a library in `uses` a shared pin is an error.
    """
    pins = motor.pins
    for library in _libraries(plan):
        shared = [pin for pin in pins if pin.bit in library.pins]
        if shared:
            yield (
                f"{library.name} needs {_listed(shared, 'and')} and will not work beside it"
                f"{_ALSO.get(library.name, '')}; if the sketch uses it, give the motor other pins"
            )
    for pin in pins:
        if "LED" in pin.uses:
            yield f"{pin.label} is the board's LED; the sketch must leave LED_BUILTIN alone"


def _listed(pins: list[Pin], word: str) -> str:
    labels = [pin.label for pin in sorted(pins, key=lambda pin: pin.number)]
    return f"{', '.join(labels[:-1])} {word} {labels[-1]}" if labels[1:] else labels[0]

"""
Which points a spec depends on: all of them in this one place.

Verification says that each step comes at its cycle, that no step is slow, and that interrupts which
were off explain the rest. A simulator that does not meet the points below could say so wrongly.
"""

from collections.abc import Mapping, Sequence

from stepgen.errors import StepgenError
from stepgen.plan.model import Plan
from stepgen.verify.compilers import Compiler
from stepgen.verify.conformance.point import (
    MEGA_1280_CHIP,
    MEGA_CHIP,
    UNO_CHIP,
    USB_CHIP,
    Point,
)
from stepgen.verify.conformance.points import points
from stepgen.verify.conformance.suite import judge
from stepgen.verify.simulators import Simulator

# Whatever the spec: the bench sleeps, masks interrupts, uses millis() and prints over Serial.
ALWAYS = (
    *("pending-once", "sei-delay", "masked-flag", "wake-up"),
    *("port-write-cycles", "millis-period", "uart"),
)
OF_CHIP: Mapping[str, Sequence[str]] = {
    UNO_CHIP: ("instruction-cycles", "response"),
    USB_CHIP: (
        *("instruction-cycles-32u4", "response-32u4", "two-timers-32u4"),
        *("usb-frames", "uart-32u4"),
    ),
    MEGA_1280_CHIP: ("instruction-cycles-1280", "response-1280", "four-timers-1280"),
    MEGA_CHIP: ("instruction-cycles-2560", "response-2560", "four-timers", "channel-c"),
}
_OF_CHANNELS = ("normal-compare", "two-channels", "flag-write")
OF_TIMING: Mapping[str, Sequence[str]] = {
    "fast-pwm": (
        *("fast-pwm-period", "prescaler-phase", "start-order", "counts-exactly", "flag-write"),
        # Without these a slow step, or one too many at a start, would not be seen.
        *("double-buffer", "slow-step", "count-kept", "late-compare-shows"),
    ),
    "ctc": (
        *("ctc-period", "prescaler-phase", "compare-flag-edge", "counts-exactly", "flag-write"),
        # Without these a compare that has already passed would not be seen.
        *("ctc-wrap", "count-kept"),
    ),
    "compare": ("timer2-compare", "timer2-moves", "flag-write"),
    "wide-compare": _OF_CHANNELS,
    "long-compare": _OF_CHANNELS,
    "ladder-compare": _OF_CHANNELS,
}
OF_KERNEL: Mapping[str, Sequence[str]] = {
    "toggle": ("pin-writes", "pin-writes-1280", "pin-writes-2560"),
    "ring": (),
    "pulse": ("pin-writes", "pin-writes-1280", "pin-writes-2560"),
}
OF_SWITCHES = ("driven-input",)
OF_WATCHDOG = (
    *("watchdog-period", "watchdog-fed", "watchdog-sequence", "watchdog-reset"),
    *("watchdog-reset-32u4", "watchdog-reset-1280", "watchdog-reset-2560"),
)


def needed_points(plan: Plan) -> tuple[Point, ...]:
    """
    Return the points that the library of *plan* and its verification depend on.

    A point about another chip is left out.
    """
    chip = plan.board.mcu.name
    names = {*ALWAYS, *OF_CHIP[chip]}
    for motor in plan.motors:
        names.update(
            OF_TIMING[motor.timing.form or motor.timing.kind], OF_KERNEL[motor.kernel.kind]
        )
        names.update(OF_SWITCHES if motor.end_stops and motor.end_stops.switches else ())
    names.update(OF_WATCHDOG if plan.watchdog_ms is not None else ())
    return tuple(one for one in points() if one.name in names and one.mcu in {UNO_CHIP, chip})


def dependents(point: Point) -> tuple[str, ...]:
    """
    Return what depends on *point*, in words; nothing if no spec does.
    """
    found = [f"every spec for the {chip}" for chip, names in OF_CHIP.items() if point.name in names]
    if point.name in ALWAYS:
        found.append("every spec")
    found += [f"timing {kind}" for kind, names in OF_TIMING.items() if point.name in names]
    found += [f"kernel {kind}" for kind, names in OF_KERNEL.items() if point.name in names]
    found += ["limit switches"] if point.name in OF_SWITCHES else []
    found += ["watchdog_ms"] if point.name in OF_WATCHDOG else []
    return tuple(found)


def refusal(plan: Plan, simulator: Simulator, compiler: Compiler) -> str:
    """
    Return why *simulator* cannot be used for *plan*; "" if it can.
    """
    if simulator.find_version() is None:
        return f"{simulator.name} is not here; {simulator.install}"
    mcu = plan.board.mcu
    if mcu.name not in simulator.mcus:
        return f"{simulator.title} has no {mcu.title}"
    failed = [
        f"{one.demand} ({one.name}: {'; '.join(verdict.findings)})"
        for one in needed_points(plan)
        if (verdict := judge(one, simulator, compiler)).findings
    ]
    return (
        f"{simulator.title} is unlike the chip in what this spec depends on: " + "; ".join(failed)
        if failed
        else ""
    )


def refuse(plan: Plan, place: str, simulator: Simulator, compiler: Compiler) -> None:
    """
    Raise StepgenError if *simulator* must not be used for *plan*, the spec in *place*.
    """
    reason = refusal(plan, simulator, compiler)
    if reason:
        raise StepgenError.of(f"{reason}; choose another simulator", place=place)

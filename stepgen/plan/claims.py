"""
Claims: what each part of a sketch takes for itself, and the one checker of conflicts.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from stepgen.devices import Board, Pin
from stepgen.plan.faults import Faults
from stepgen.plan.kernels import Drive
from stepgen.plan.model import TimerPlan
from stepgen.plan.uses import ANALOG_WRITE, Use, pwm_channel
from stepgen.spec.limits import Limits

_VECTOR = "vector "
_CORE_TIMER = "as the core sets it up"
_EXAMPLE_PINS = 4


@dataclass(frozen=True)
class Claim:
    """
    Something that only one owner can have.

    Args:
        resource: What is taken, such as ``pin D12 (PB4)`` or ``timer 1``.
        owner: Who takes it, in words for a message.
        faults: Where to report that somebody else has it already.
        way_out: What the user can do about it.
        role: What the owner takes it for, words that follow the owner's.
        escape: What the user can do when somebody else wants it too, or "".
        sharing: Claims with the same sharing, other than "", do not conflict.
    """

    resource: str
    owner: str
    faults: Faults
    way_out: str
    role: str = ""
    escape: str = ""
    sharing: str = ""


def drive_claims(motor: str, drive: Drive, faults: Faults) -> Iterable[Claim]:
    """
    Return what *drive* takes: its pins.
    """
    for wire in drive.every_wire:
        shared = drive.shared_enables and wire in drive.released
        yield Claim(
            _pin(wire.pin),
            f"motor {motor}",
            faults.at("drive"),
            drive.pins_way_out,
            role=f", as {wire.signal}",
            sharing=f"as an enable of {drive.kind}" if shared else "",
        )


def switch_claims(motor: str, limits: Limits, board: Board, faults: Faults) -> Iterable[Claim]:
    """
    Return what *limits* take: the pins of the switches that the board has.
    """
    for end, switch in (("low", limits.low), ("high", limits.high)):
        pin = switch and board.find_pin(switch.pin)
        if pin:
            yield Claim(
                _pin(pin),
                f"motor {motor}",
                faults.at("limits", end, "pin"),
                "give the switch a pin of its own",
                role=f", as its {end} limit switch",
            )


def timing_claims(motor: str, timing: TimerPlan, way_out: str, faults: Faults) -> Iterable[Claim]:
    """
    Return what *timing* takes: its timer, or a channel of one that it shares, and its vector.
    """
    place = faults.at("timing", "timer")
    timer, owner = f"timer {timing.timer.number}", f"motor {motor}"
    yield Claim(timer, owner, place, way_out, sharing=timing.sharing)
    if timing.channel:
        another = f"take another `channel`, or {way_out.removeprefix('take ')}"
        yield Claim(f"channel {timing.channel} of {timer}", owner, place, another)
    yield Claim(_VECTOR + timing.vector, owner, place, way_out)


def sketch_claims(
    uses: Mapping[int, Use], board: Board, motors: Iterable[Claim], faults: Faults
) -> Iterable[Claim]:
    """
    Return what the sketch's other libraries take: timers, vectors and pins.

    *motors* are the claims of the motors: no way out leads to what they have.
    """
    busy = {claim.resource for claim in motors}
    for index, use in uses.items():
        place = faults.at("uses", index)
        way_out = f"remove {use.name} from `uses`"
        if use.name == ANALOG_WRITE:
            yield from _analog_write_claims(use, _free_pwm(board, busy), place)
            continue
        sharing = _CORE_TIMER if use.keeps_the_core_timers else ""
        for number in use.timers:
            yield Claim(f"timer {number}", use.name, place, way_out, "", way_out, sharing)
        for resource in (*(_VECTOR + name for name in use.vectors), *map(_pin, use.pins)):
            yield Claim(resource, use.name, place, way_out, escape=way_out)


def _analog_write_claims(use: Use, free: tuple[str, ...], faults: Faults) -> Iterable[Claim]:
    """
    Yield the pins of analogWrite() and their timers, whose compare registers it writes.
    """
    way_out = "remove it from `uses`"
    if free:
        way_out = f"use analogWrite on {' or '.join(free[:_EXAMPLE_PINS])}"
    for pin in use.pins:
        timer, channel = pwm_channel(pin) or (0, "")
        # OCRnA is the TOP of a motor's timer; the other channels only lose their frequency.
        top = f"it rewrites OCR{timer}A, so that the motor would run away"
        effect = top if channel == "A" else "its PWM would follow the motor's timer"
        role = f" on {pin.label} ({effect})"
        name = ANALOG_WRITE
        yield Claim(f"timer {timer}", name, faults, way_out, role, way_out, _CORE_TIMER)
        yield Claim(_pin(pin), name, faults, way_out, "", way_out)


def _free_pwm(board: Board, busy: set[str]) -> tuple[str, ...]:
    """
    Return the PWM pins that are nobody's in *busy*, on timers that are nobody's there.
    """
    channels = ((pin, pwm_channel(pin)) for pin in board.pins)
    return tuple(
        pin.label
        for pin, channel in channels
        if channel and not {_pin(pin), f"timer {channel[0]}"} & busy
    )


def _pin(pin: Pin) -> str:
    return f"pin {pin.label} ({pin.bit.name})"


def report_conflicts(claims: Iterable[Claim]) -> None:
    """
    Report each claim on what an earlier claim has taken already, those of two owners together.
    """
    taken: dict[str, Claim] = {}
    conflicts: dict[tuple[str, str, tuple[str | int, ...]], list[tuple[Claim, Claim]]] = {}
    for claim in claims:
        first = taken.setdefault(claim.resource, claim)
        if first is claim or (claim.sharing and claim.sharing == first.sharing):
            continue
        key = (first.owner, claim.owner, tuple(claim.faults.location))
        conflicts.setdefault(key, []).append((first, claim))
    for pairs in conflicts.values():
        _report(pairs)


def _report(pairs: list[tuple[Claim, Claim]]) -> None:
    """
    Report the conflicts of two owners as one; a timer's vector is no news beside the timer.
    """
    news = [pair for pair in pairs if not pair[1].resource.startswith(_VECTOR)] or pairs
    first, second = news[0]
    roles = (first.role, second.role) if len(news) == 1 else ("", "")
    names = [claim.resource for _, claim in news]
    listed = f"{', '.join(names[:-1])} and {names[-1]}" if names[1:] else names[0]
    way_out = ", or ".join(dict.fromkeys(filter(None, (second.way_out, first.escape))))
    second.faults.report(
        f"{listed} {'are' if names[1:] else 'is'} taken by {first.owner}{roles[0]} and wanted by "
        f"{second.owner}{roles[1]}; {way_out}"
    )

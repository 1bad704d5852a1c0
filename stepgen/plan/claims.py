"""
Claims: what each part of a sketch takes for itself, and the one checker of conflicts.
"""

from collections.abc import Iterable
from dataclasses import dataclass

from stepgen.devices import Board, library_claims
from stepgen.plan.coils import CoilDrive
from stepgen.plan.faults import Faults
from stepgen.plan.model import TimerPlan


@dataclass(frozen=True)
class Claim:
    """
    Something that only one owner can have.

    Args:
        resource: What is taken, such as ``pin D12`` or ``timer 1``.
        owner: Who takes it, in words for a message.
        faults: Where to report that somebody else has it already.
        way_out: What the user can do about it.
    """

    resource: str
    owner: str
    faults: Faults
    way_out: str


def drive_claims(motor: str, drive: CoilDrive, faults: Faults) -> Iterable[Claim]:
    """
    Return what *drive* takes: its pins.
    """
    for wire in drive.every_wire:
        yield Claim(
            f"pin {wire.pin.label} ({wire.pin.bit.name})",
            f"motor {motor}, as {wire.signal}",
            faults.at("drive"),
            "give one of them other pins",
        )


def timing_claims(
    motor: str, timing: TimerPlan, free: tuple[int, ...], faults: Faults
) -> Iterable[Claim]:
    """
    Return what *timing* takes: its timer. *free* are the timers that nobody has taken.
    """
    choice = " or ".join(str(number) for number in free)
    way_out = f"take timer {choice}" if choice else "no other 16-bit timer is left on this board"
    owner = f"motor {motor}"
    place = faults.at("timing", "timer")
    yield Claim(f"timer {timing.timer.number}", owner, place, way_out)


def sketch_claims(board: Board, uses: tuple[str, ...], faults: Faults) -> Iterable[Claim]:
    """
    Return what the sketch's other libraries take: the first of their timers, and their pins.
    """
    for index, name in enumerate(uses):
        library = library_claims(name, board)
        if library is None:
            continue
        timers = library.timers if library.objects_per_timer is None else library.timers[:1]
        resources = [f"timer {number}" for number in timers]
        pins = (pin for pin in board.pins if pin.bit in library.pins)
        resources.extend(f"pin {pin.label} ({pin.bit.name})" for pin in pins)
        for resource in resources:
            yield Claim(resource, name, faults.at("uses", index), f"remove {name} from `uses`")


def report_conflicts(claims: Iterable[Claim]) -> None:
    """
    Report each claim on what an earlier claim has taken already.
    """
    taken: dict[str, Claim] = {}
    for claim in claims:
        first = taken.setdefault(claim.resource, claim)
        if first is not claim:
            claim.faults.report(
                f"{claim.resource} is taken by {first.owner} and wanted by {claim.owner}; "
                f"{claim.way_out}"
            )

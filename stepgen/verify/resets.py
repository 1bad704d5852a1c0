"""
What a reset leaves: no wire is driven until ShieldInit, and then to rest at once.

Any reset gives each I/O register its initial value at once and leaves RAM alone (ATmega328P
datasheet, "System Control and Reset"). Pins are inputs without pull-ups.
"""

from collections.abc import Iterable, Iterator

from stepgen.devices import Mcu, PortBit
from stepgen.verify.events import Events, Kind
from stepgen.verify.subject import Subject


def restless_wires(motors: Iterable[Subject], events: Events, mcu: Mcu) -> Iterator[str]:
    """
    Yield each wire of *motors* that shows something else in *events*, all since a reset.
    """
    for subject in motors:
        for bit in subject.drive.wires:
            first, *after = _levels(events, bit, mcu)
            if first is not None or tuple(after) not in _at_rest(subject, bit):
                yield f"{subject.name}: {bit.name} shows {first}, {after} after the reset"


def _levels(events: Events, bit: PortBit, mcu: Mcu) -> list[bool | None]:
    """
    Return what *bit* showed since reset, in order: LOW, HIGH, or None where nothing drives it.

    A pull-up drives nothing, but is HIGH where it is not the first thing that happens.
    """
    port = mcu.port(bit.port)
    held = {port.port.address: 0, port.ddr.address: 0}
    shown: list[bool | None] = [None]
    for event in events[events["kind"] == Kind.PORT]:
        if int(event["source"]) not in held:
            continue
        held[int(event["source"])] = int(event["value"])
        is_output = held[port.ddr.address] >> bit.bit & 1
        level = bool(held[port.port.address] >> bit.bit & 1)
        now = level if is_output or level else None
        if now != shown[-1]:
            shown.append(now)
    return shown


def _at_rest(subject: Subject, bit: PortBit) -> list[tuple[bool, ...]]:
    """
    Return which levels *bit* may show after ShieldInit: no current, no pulse on STEP.
    """
    place = subject.drive.wires.index(bit)
    off = subject.drive.coils_off
    if off.care[place]:
        return [(off.driven[place],)]
    if subject.drive.pulse is not None and place == 0:
        return [(False,)]
    return [(False,), (True,)]

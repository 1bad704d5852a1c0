"""
Kernels: how one step changes the ports. The planner takes the cheapest that is right.
"""

from dataclasses import dataclass

from stepgen.devices import Mcu, Port, Register
from stepgen.plan.coils import CoilDrive, PortPatterns, patterns_by_port
from stepgen.plan.cycles import HandlerCycles
from stepgen.plan.faults import Faults
from stepgen.plan.pulses import Pulse, PulseDrive, pulse_kernel

_RING_BYTES = 256  # a row is named by one byte: its distance from the start of the ring


@dataclass(frozen=True)
class Toggle:
    """
    Each step toggles one of two groups of bits in turn, by one write of ones to PINx.

    Args:
        port: The only port.
        masks: The bits that the step from phase 0 to 1 toggles, and those of 1 to 2.
        values: What the port's bits show in each of the four phases.
    """

    port: Port
    masks: tuple[int, int]
    values: tuple[int, ...]

    kind = "toggle"
    state_note = "the bits that the next step toggles"
    handler = HandlerCycles(longest=150, masked=45, to_clock=71, to_clock_thinking=93)

    @property
    def both(self) -> int:
        """
        Return all bits that step.
        """
        return self.masks[0] | self.masks[1]

    @property
    def registers(self) -> tuple[Register, ...]:
        """
        Return the registers that its instructions name ``port0`` and so on.
        """
        return (self.port.pin,)


@dataclass(frozen=True)
class PortWrite:
    """
    One write of a step: ``clear`` and ``set`` keep the other bits, ``merge`` does both at once.
    """

    port: Port
    mask: int
    operation: str


@dataclass(frozen=True)
class Ring:
    """
    A table in flash with two rows for each phase: one to go on forward, one to go on backward.

    A row begins with the distance of the row that follows it; then comes a byte for each of
    *writes*. Turning round is stepping to the phase's other row.
    """

    ports: tuple[PortPatterns, ...]
    writes: tuple[PortWrite, ...]
    rows: tuple[tuple[int, ...], ...]

    kind = "ring"
    state_note = "the row of the present phase"

    @property
    def handler(self) -> HandlerCycles:
        """
        Return the cycles of the boundary handler, which makes a step itself when it thinks.
        """
        thinking = 104 + 11 * len(self.writes)
        more = len(self.writes) - 1
        far = sum(not share.port.port.in_io for share in self.ports)  # LDS and STS, not IN and OUT
        return HandlerCycles(
            longest=166 + 3 * more,
            masked=9 * more + 8 * far,
            # With four bytes in a row the compiler moves some registers to and fro: 0 to 10 cycles.
            to_clock=77 + (3 if len(self.writes) > 3 else 0),  # noqa: PLR2004
            to_clock_thinking=thinking,
        )

    @property
    def registers(self) -> tuple[Register, ...]:
        """
        Return the registers that its instructions name ``port0`` and so on.
        """
        return tuple(share.port.port for share in self.ports)

    @property
    def row_bytes(self) -> int:
        """
        Return the length of a row.
        """
        return 1 + len(self.writes)

    @property
    def size_bytes(self) -> int:
        """
        Return the length of the ring.
        """
        return self.row_bytes * len(self.rows)

    @property
    def alignment_bytes(self) -> int:
        """
        Return the power of two that keeps the ring within one 256-byte page of flash.
        """
        return 1 << (self.size_bytes - 1).bit_length()


Drive = CoilDrive | PulseDrive
Kernel = Toggle | Ring | Pulse


def choose_kernel(drive: Drive, mcu: Mcu, *, owned: bool, faults: Faults) -> Kernel | None:
    """
    Return the kernel for *drive*; None after reporting that its table is too large.
    """
    if isinstance(drive, PulseDrive):
        return pulse_kernel(drive, mcu, owned=owned)
    return _coil_kernel(drive, mcu, owned=owned, faults=faults)


def _coil_kernel(
    drive: CoilDrive, mcu: Mcu, *, owned: bool, faults: Faults
) -> Toggle | Ring | None:
    """
    Return the kernel that shows the phases of *drive*.

    Toggling never looks at the port, so one stray write of the sketch to a motor's bit would
    stay wrong for ever: it is for ports that the motor owns. The ring writes absolute
    patterns, which mend themselves at the next step.
    """
    ports = patterns_by_port(drive, mcu.ports)
    masks = _alternating_masks(ports) if owned else None
    if masks:
        return Toggle(ports[0].port, masks, ports[0].values)
    ring = _ring(ports, len(drive.phases))
    if ring.size_bytes > _RING_BYTES:
        most = _RING_BYTES // (2 * ring.row_bytes)
        faults.report(
            f"{len(drive.phases)} patterns on {len(ports)} ports are too many, {most} are possible;"
            " shorten the table or use pins of one port"
        )
        return None
    return ring


def _alternating_masks(ports: tuple[PortPatterns, ...]) -> tuple[int, int] | None:
    """
    Return the two masks that a sequence of four phases toggles in turn, if it does.
    """
    if len(ports) != 1 or len(ports[0].values) != 4:  # noqa: PLR2004 - a cycle of full steps
        return None
    values = ports[0].values
    masks = [now ^ values[(index + 1) % 4] for index, now in enumerate(values)]
    alternate = masks[0] == masks[2] and masks[1] == masks[3]
    return (masks[0], masks[1]) if alternate and not masks[0] & masks[1] else None


def _ring(ports: tuple[PortPatterns, ...], phases: int) -> Ring:
    *first, last = ports
    writes = (
        *(PortWrite(share.port, share.mask, "clear") for share in first),
        PortWrite(last.port, last.mask, "merge"),
        *(PortWrite(share.port, share.mask, "set") for share in reversed(first)),
    )
    width = 1 + len(writes)
    rows = []
    for phase in range(phases):
        values = _row_values(ports, phase)
        forward, backward = (phase + 1) % phases, (phase - 1) % phases
        rows.append((2 * forward * width, *values))
        rows.append(((2 * backward + 1) * width, *values))
    return Ring(ports, writes, tuple(rows))


def _row_values(ports: tuple[PortPatterns, ...], phase: int) -> tuple[int, ...]:
    *first, last = ports
    cleared = (share.values[phase] | ~share.mask & 0xFF for share in first)
    set_ = (share.values[phase] for share in reversed(first))
    return (*cleared, last.values[phase], *set_)

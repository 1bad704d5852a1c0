"""
Coil drives: wires, phase tables, and the order in which ports are written.
"""

from dataclasses import dataclass
from fractions import Fraction

from stepgen.devices import Port
from stepgen.plan.wires import Wire, bits_by_port

Pattern = tuple[bool, ...]

FULL_STEPS_PER_CYCLE = 4  # a two-phase motor repeats its coil currents after four full steps


@dataclass(frozen=True)
class CoilDrive:
    """
    How a motor's coils are connected and what they see in each phase.

    Args:
        kind: The spec's name of the drive.
        title: What the driver is called in prose.
        sequence: The spec's name of the sequence, or ``table``.
        wires: The wires that change from phase to phase, in the order of the patterns.
        phases: What the wires show in each phase; a step forward goes to the next.
        enables: Wires that are HIGH while the motor is driven, LOW when it is released.
        quiet: Wires that stay LOW for ever.
        released: The wires, of either kind, that go LOW when the coils are switched off.
        shared_enables: Whether another drive has the same enables: they are HIGH while either
            motor is driven.
        pins_way_out: What the user can do about a pin that somebody else has.
    """

    kind: str
    title: str
    sequence: str
    wires: tuple[Wire, ...]
    phases: tuple[Pattern, ...]
    enables: tuple[Wire, ...]
    quiet: tuple[Wire, ...]
    released: tuple[Wire, ...]
    shared_enables: bool = False
    pins_way_out: str = "give one of them other pins"

    edge_note = "The wires change"
    enable_cycles = 0

    @property
    def every_wire(self) -> tuple[Wire, ...]:
        """
        Return all wires, each once: those that step, the enables and the quiet ones.
        """
        return (*self.wires, *self.enables, *self.quiet)

    @property
    def steps_per_full_step(self) -> Fraction:
        """
        Return how many steps of this sequence make one full step of the motor.
        """
        return Fraction(len(self.phases), FULL_STEPS_PER_CYCLE)

    @property
    def steps_text(self) -> str:
        """
        Return what the motor makes at a time, such as ``half steps``.
        """
        if self.sequence == "table":
            return f"own table of {len(self.phases)} patterns"
        return f"{self.sequence} steps"

    @property
    def facts(self) -> tuple[tuple[str, str], ...]:
        """
        Return what ``stepgen plan`` shows of it beside the wires.
        """
        digits = ("".join(str(int(high)) for high in phase) for phase in self.phases)
        return (("phases", " ".join(digits)),)


@dataclass(frozen=True)
class PortPatterns:
    """
    The part of a drive that lies on one port: its bits, and their value in each phase.
    """

    port: Port
    mask: int
    values: tuple[int, ...]


def patterns_by_port(drive: CoilDrive, ports: tuple[Port, ...]) -> tuple[PortPatterns, ...]:
    """
    Return each port's share of *drive*, in the order in which the ports are written.

    On several ports a step is one write per port to switch off what the next phase does not
    drive, and one to switch on what it does. The last port needs just one write for both, so
    the port with the most wires comes last: two wires that trade places there do so at once.
    Before all others, a port with wires that only turn a coil's current comes last: they change
    between switching off and switching on, while the coil that they turn is off.
    """
    turning = bits_by_port(tuple(wire for wire in drive.wires if wire not in drive.released))
    by_letter = {port.letter: port for port in ports}
    shares = [
        PortPatterns(by_letter[letter], mask, tuple(_value(drive, letter, p) for p in drive.phases))
        for letter, mask in bits_by_port(drive.wires).items()
    ]

    def rank(share: PortPatterns) -> tuple[bool, int, str]:
        return (share.port.letter in turning, share.mask.bit_count(), share.port.letter)

    return tuple(sorted(shares, key=rank))


def _value(drive: CoilDrive, letter: str, pattern: Pattern) -> int:
    high = (wire.pin.bit for wire, on in zip(drive.wires, pattern, strict=True) if on)
    return sum(1 << bit.bit for bit in high if bit.port == letter)

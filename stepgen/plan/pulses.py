"""
Drivers with STEP and DIR inputs: their wires and times, and the kernel that makes their pulses.
"""

from dataclasses import dataclass
from fractions import Fraction

from stepgen.devices import Mcu, Port, PortBit, Register
from stepgen.plan.cycles import HandlerCycles
from stepgen.plan.wires import Wire

# From the response until STEP rises: the vector's JMP, PUSH, IN, OUT and a count of four
# instructions, at least; and one instruction of the main program before that.
_WAY_IN_CYCLES = 3 + 4 + 4 + 1
_RISE_CYCLES = 2  # SBI
_FAR_CYCLES = 6  # load, change and store, twice, against SBI and CBI
# Of a call that waits before it writes DIR, which keeps more in registers; DIR and ENABLE beyond
# SBI and CBI are in it.
_HOLD_CYCLES = 28


@dataclass(frozen=True)
class PulseCycles:
    """
    A driver's least times in CPU cycles, as `stepgen.devices.PulseTimes` has them.
    """

    high: int
    low: int
    setup: int
    hold: int
    enable: int


@dataclass(frozen=True)
class PulseDrive:
    """
    How a driver with STEP and DIR inputs is connected.

    Args:
        kind: The spec's name of the drive.
        title: What the driver is called in prose.
        step: STEP; each rising edge is a microstep.
        direction: DIR; LOW is forward.
        enables: ENABLE, if there is one.
        microsteps: Into how many of them the driver divides a full step.
        cycles: Its least times.
        shared_enables: Whether another driver has the same ENABLE.
        pins_way_out: What the user can do about a pin that somebody else has.
    """

    kind: str
    title: str
    step: Wire
    direction: Wire
    enables: tuple[Wire, ...]
    microsteps: int
    cycles: PulseCycles
    shared_enables: bool = False
    pins_way_out: str = "give one of them other pins"

    quiet: tuple[Wire, ...] = ()
    edge_note = "STEP rises"

    @property
    def wires(self) -> tuple[Wire, ...]:
        """
        Return the wires that change with each step: STEP.
        """
        return (self.step,)

    @property
    def every_wire(self) -> tuple[Wire, ...]:
        """
        Return all wires.
        """
        return (self.step, self.direction, *self.enables)

    @property
    def released(self) -> tuple[Wire, ...]:
        """
        Return the wires that switch the coils off.
        """
        return self.enables

    @property
    def steps_per_full_step(self) -> Fraction:
        """
        Return how many microsteps make one full step of the motor.
        """
        return Fraction(self.microsteps)

    @property
    def steps_text(self) -> str:
        """
        Return what the motor makes at a time.
        """
        return f"1/{self.microsteps} steps" if self.microsteps > 1 else "full steps"

    @property
    def facts(self) -> tuple[tuple[str, str], ...]:
        """
        Return what ``stepgen plan`` shows of it beside the wires.
        """
        c = self.cycles
        return (
            ("STEP", f"HIGH at least {c.high} cycles, LOW at least {c.low}"),
            ("DIR", f"{c.setup} cycles before STEP rises, {c.hold} after it"),
            ("ENABLE", f"{c.enable} cycles before the first step" if self.enables else "none"),
        )

    @property
    def enable_cycles(self) -> int:
        """
        Return how long before the first step it must be enabled; 0 without ENABLE.
        """
        return self.cycles.enable if self.enables else 0


@dataclass(frozen=True)
class Pulse:
    """
    Each step is a pulse on STEP; DIR is written by the call that turns the motor round.

    STEP rises and falls by SBI and CBI where they reach its port; elsewhere by a write of ones to
    PINx where the motor owns the port, else by load, change and store.

    Args:
        port: The port of STEP.
        bit: Its bit.
        direction_port: The port of DIR.
        direction: The bit of DIR.
        toggles: Whether it is written to PINx.
        cycles: The driver's least times.
        response_cycles: How long the chip takes from an interrupt to its vector, and for RETI.
    """

    port: Port
    bit: int
    direction_port: Port
    direction: PortBit
    toggles: bool
    cycles: PulseCycles
    response_cycles: int

    kind = "pulse"
    state_note = ""

    @property
    def is_near(self) -> bool:
        """
        Return whether SBI and CBI reach STEP.
        """
        return self.port.port.bit_addressable

    @property
    def registers(self) -> tuple[Register, ...]:
        """
        Return the registers that its instructions name ``port0`` and so on.
        """
        return (self.port.pin if self.toggles else self.port.port,)

    @property
    def fall_cycles(self) -> int:
        """
        Return how long the compiler's write takes that makes STEP fall, at least.
        """
        return 2 if self.is_near or self.toggles else 5

    @property
    def low_wait_cycles(self) -> int:
        """
        Return what STEP must stay LOW beyond RETI and the way to the next step, at least.
        """
        return max(0, self.cycles.low - 2 * self.response_cycles - _WAY_IN_CYCLES - _RISE_CYCLES)

    @property
    def hold_wait_cycles(self) -> int:
        """
        Return what a call must wait before it writes DIR: a step may have been made just before.
        """
        return max(0, self.cycles.hold - self.cycles.high - self.response_cycles - 1)

    @property
    def setup_wait_cycles(self) -> int:
        """
        Return what a call must wait after it has written DIR: a step may be due at once.
        """
        return max(0, self.cycles.setup - self.response_cycles - _WAY_IN_CYCLES - _RISE_CYCLES)

    @property
    def handler(self) -> HandlerCycles:
        """
        Return the cycles of the boundary handler, which makes a pulse itself when it thinks.
        """
        far = 0 if self.is_near or self.toggles else _FAR_CYCLES
        pulse = self.cycles.high + self.low_wait_cycles + far
        hold = self.hold_wait_cycles and self.hold_wait_cycles + _HOLD_CYCLES
        return HandlerCycles(
            longest=151 + pulse,
            masked=14 + hold + self.setup_wait_cycles,
            to_clock=75,
            to_clock_thinking=94 + pulse,
            turning=self.hold_wait_cycles + self.setup_wait_cycles,
        )


def pulse_kernel(drive: PulseDrive, mcu: Mcu, *, owned: bool) -> Pulse:
    """
    Return the kernel of *drive*; *owned*: the sketch leaves the port of STEP alone.
    """
    step, direction = drive.step.pin.bit, drive.direction.pin.bit
    port = mcu.port(step.port)
    return Pulse(
        port=port,
        bit=step.bit,
        direction_port=mcu.port(direction.port),
        direction=direction,
        toggles=owned and not port.port.bit_addressable,
        cycles=drive.cycles,
        response_cycles=mcu.response_cycles,
    )

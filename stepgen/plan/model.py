"""
The plan: every number decided, nothing left for the templates to work out.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property

from stepgen.devices import Board, Pin, Timer
from stepgen.plan.end_stops import EndStops, EndSwitch
from stepgen.plan.instructions import Gate, Storage
from stepgen.plan.isr import HotPath, Motion
from stepgen.plan.kernels import Drive, Kernel
from stepgen.spec import Library

_WAKE_TICKS_CYCLES = 2 * 1024


@dataclass(frozen=True)
class Setting:
    """
    A timer's prescaler and TOP; it overflows each prescaler * (TOP + 1) I/O clocks.
    """

    prescaler: int
    top: int

    @property
    def period_cycles(self) -> int:
        """
        Return the I/O clocks between two overflows.
        """
        return self.prescaler * (self.top + 1)


@dataclass(frozen=True)
class TimerPlan:
    """
    The timer that paces a motor, and the interrupt vector that makes its steps.

    Args:
        kind: The spec's name of the timing.
        timer: Its timer.
        vector: The vector.
        event: What raises the interrupt, in words that follow the timer's number.
        instant: When that is, in words.
        smallest_period_cycles: Shortest time between two steps that the timing allows.
        largest_period_cycles: Longest time between two steps.
        rule: What the sketch has to mind beside the timer's pins, in whole sentences, or "".
        is_set_anew: Whether a change of speed can mean that the timer is set anew.
        form: Which form of the timing it is, if there are several: its module and partial.
        channel: The compare channel, where other motors can have the others; else "".
        sharing: Timings with the same sharing, other than "", can be on one timer.
    """

    kind: str
    timer: Timer
    vector: str
    event: str
    instant: str
    smallest_period_cycles: int
    largest_period_cycles: int
    rule: str = ""
    is_set_anew: bool = True
    form: str = ""
    channel: str = ""
    sharing: str = ""

    @property
    def module(self) -> str:
        """
        Return the name of what decides and prints it: of its form, or of its kind.
        """
        return (self.form or self.kind).replace("-", "_")

    @property
    def has_long_periods(self) -> bool:
        """
        Tell whether steps can be minutes apart.
        """
        return self.module == "long_compare"


@dataclass(frozen=True)
class Left:
    """
    What other motors and libraries leave of the timers.

    Args:
        free: The timers that nobody has, wide ones first.
        channels: Those that motors share, each with the channels that are taken.
    """

    free: tuple[int, ...]
    channels: Mapping[int, tuple[str, ...]] = field(default_factory=dict)


@dataclass(frozen=True)
class Cadence:
    """
    How often a timing's interrupt comes, and how long each may be kept waiting before it is lost.
    """

    spacing_cycles: int
    patience_cycles: int


@dataclass(frozen=True)
class Part:
    """
    Something that an interrupt waits for, and for how long at most.
    """

    cause: str
    cycles: int


@dataclass(frozen=True)
class RateLimit:
    """
    The highest rate at which a motor loses no step, while all motors run at theirs.

    Args:
        beside: What else there is: ``alone``, ``beside millis``, ``beside millis and Servo``.
        period_cycles: The shortest time between two steps.
        steps_per_second: The rate.
        cause: What does not allow more, in words.
        parts: What a step can wait for at that rate, and its own interrupt.
        unproven: Whose interrupts have figures that no test proves, and where these come from.
    """

    beside: str
    period_cycles: int
    steps_per_second: float
    cause: str
    parts: tuple[Part, ...]
    unproven: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class HeldOff:
    """
    How long the sketch may have interrupts off in one go, at one time between steps.

    Args:
        period_cycles: The time between two steps of every motor.
        steps_per_second: Their rate.
        stretch_cycles: The longest stretch with which no step is lost.
        late_cycles: How late a step then begins at most: the stretch, and what else it waits for.
    """

    period_cycles: int
    steps_per_second: float
    stretch_cycles: int
    late_cycles: int


@dataclass(frozen=True)
class MotorPlan:
    """
    Everything decided about one motor.

    Args:
        name: Its name in the spec: the prefix of its functions.
        motion: What its motion asks of the step interrupt.
        end_stops: The limits that it keeps to, or None.
        drive: How its coils are connected and what they see.
        kernel: How one step changes the ports.
        timing: What paces it.
        storage: Where its step interrupt keeps its state.
        handler: Where the step interrupt goes on in its rare ways, by the linker's name.
        gate: What the timing puts before the step.
        hot_path: The step interrupt.
        steps_per_turn: Steps of its sequence in one turn of the shaft, or None.
        steps_per_mm: Steps of its sequence, or microsteps, in one millimetre of its way, or None.
        releases_at_rest: Whether the coils go off when it comes to rest.
        owns_ports: Whether the sketch leaves the motor's ports alone.
        wish_steps_per_second: The highest rate that the sketch will ask for, or None.
        command_timeout_ms: How long it runs without a word from the sketch, or None: for ever.
    """

    name: str
    motion: Motion
    end_stops: EndStops | None
    drive: Drive
    kernel: Kernel
    timing: TimerPlan
    storage: Storage
    handler: str
    gate: Gate
    hot_path: HotPath
    steps_per_turn: Fraction | None
    steps_per_mm: Fraction | None
    releases_at_rest: bool
    owns_ports: bool
    wish_steps_per_second: Fraction | None = None
    command_timeout_ms: int | None = None

    @cached_property
    def isr_bound_cycles(self) -> int:
        """
        Return the longest that its step interrupt may take, from the response through RETI.
        """
        return self.punctual_bound_cycles + self.gate.late_cycles

    @cached_property
    def punctual_bound_cycles(self) -> int:
        """
        Return the same of an interrupt that was not held up for too long.
        """
        return (
            self.hot_path.boundary_entry_cycles
            + self.kernel.handler.longest
            + self.motion.handler_cycles
            + (self.kernel.handler.turning if self.motion.ladder else 0)
            + self.gate.handler_cycles
            - (0 if self.timing.is_set_anew else self.motion.setting_cycles)
        )

    @cached_property
    def recurring_bound_cycles(self) -> int:
        """
        Return the same of the interrupts that can come at each step of a long motion.
        """
        recurring = self.hot_path.recurring_cycles
        return self.punctual_bound_cycles if recurring is None else recurring

    @property
    def masked_bound_cycles(self) -> int:
        """
        Return the longest that a call for it may have interrupts off.
        """
        return (
            self.motion.masked_cycles
            + self.kernel.handler.masked
            + self.gate.masked_cycles
            - (0 if self.timing.is_set_anew else self.motion.masked_setting_cycles)
        )

    @property
    def switches_current(self) -> bool:
        """
        Return whether its coils can be switched off.
        """
        return bool(self.drive.released)

    @property
    def end_switches(self) -> tuple[EndSwitch, ...]:
        """
        Return the switches that it looks at before each step.
        """
        return self.end_stops.switches if self.end_stops else ()

    @property
    def pins(self) -> tuple[Pin, ...]:
        """
        Return every pin that it has, those of its switches last.
        """
        wires = (wire.pin for wire in self.drive.every_wire)
        return (*wires, *(switch.pin for switch in self.end_switches))

    @property
    def wake_cycles(self) -> int:
        """
        Return how long the first interval from rest must be at least; 0 where every one is.

        It is cut off to whole ticks, and its first one can be short: two ticks of 1024 make up.
        """
        enable = self.drive.enable_cycles
        return enable + _WAKE_TICKS_CYCLES if enable > self.timing.smallest_period_cycles else 0

    @property
    def port_letters(self) -> str:
        """
        Return the ports of the stepping wires, such as ``B`` or ``B and D``.
        """
        return " and ".join(sorted({wire.pin.bit.port for wire in self.drive.wires}))


@dataclass(frozen=True)
class Plan:
    """
    A spec with every number decided and every conflict found.

    Args:
        library: The metadata of the library.
        board: The board.
        motors: Its motors, in the order of the spec.
        masked_bound_cycles: Longest stretch of a call of the library with interrupts off.
        proven_period_cycles: Shortest time between two steps in which no motor loses one.
        minimum_period_cycles: Shortest that the library accepts: that, or a longer one where every
            motor of the spec says how fast it will be.
        largest_period_cycles: Longest time between two steps.
        uses: The other libraries of the sketch.
        rates: For each motor its highest rates, the last one beside all that is named.
        held_off: How long the sketch may have interrupts off at some rates, fastest last.
        watchdog_ms: The period of the watchdog that the library has, or None.
    """

    library: Library
    board: Board
    motors: tuple[MotorPlan, ...]
    masked_bound_cycles: int
    proven_period_cycles: int
    minimum_period_cycles: int
    largest_period_cycles: int
    uses: tuple[str, ...]
    rates: Mapping[str, tuple[RateLimit, ...]]
    held_off: tuple[HeldOff, ...]
    watchdog_ms: int | None = None

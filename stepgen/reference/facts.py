"""
What the model is told about a motor and about the chip that drives it.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Literal

from stepgen.reference.contract import MotionKind, TimingKind
from stepgen.reference.end_stops import EndStopFacts
from stepgen.reference.ladder import Ladder
from stepgen.reference.sequences import Pattern
from stepgen.reference.timer import FASTEST_CYCLES, SETTINGS, SLOWEST_CYCLES, TimerSetting

ServiceCycle = Callable[[int], int]
SetCycle = Callable[[int], int | None]


@dataclass(frozen=True)
class MotorFacts:
    """
    What the spec decides about a motor.

    Args:
        phases: The coil table, phase 0 first.
        coils_off: The pattern without current.
        minimum_cycles: The smallest virtual value that is accepted, 4 to 65535 * 1024.
        slowest_cycles: The largest virtual value that is accepted.
        at_rest: Whether the coils stay on when the motor stops.
        motion: Whether its library has update events.
        shares_enables: Whether the wires that switch its coils off are another motor's too.
        timing: What paces it.
        overrun_cycles: How late an interrupt is served, from its deadline to its response, from
            which on the step counts as missed; None where the hardware cannot tell.
        has_direction: Whether *phases* are what the wires show forward and backward, not a table
            to go along.
        wake_cycles: The shortest first interval from rest, as a virtual value.
        command_timeout_millis: How long after the last word of the sketch a step is still made, as
            ``millis()`` counts; None for ever.
        sees_passed: Whether a step counts as missed that is due before the one before it is made.
        ladder: The intervals that an axis climbs through, None for a motor that is none.
        cruise_256: The shortest interval that an axis accepts, in 1/256 clock, and that after Init.
        queue: How many destinations of an axis can wait.
        end_stops: What keeps an axis within its limits, None without any.
    """

    phases: tuple[Pattern, ...]
    coils_off: Pattern
    minimum_cycles: int
    at_rest: Literal["hold", "release"]
    motion: MotionKind = "constant"
    shares_enables: bool = False
    timing: TimingKind = "fast-pwm"
    overrun_cycles: int | None = None
    has_direction: bool = False
    wake_cycles: int = 0
    command_timeout_millis: int | None = None
    sees_passed: bool = False
    ladder: Ladder | None = None
    cruise_256: int = 0
    queue: int = 0
    end_stops: EndStopFacts | None = None
    slowest_cycles: int = SLOWEST_CYCLES

    def __post_init__(self) -> None:
        if not FASTEST_CYCLES <= self.minimum_cycles <= SLOWEST_CYCLES:
            raise ValueError(f"minimum_cycles = {self.minimum_cycles} is out of range")

    def setting(self, virtual_cycles: int) -> TimerSetting:
        """
        Return what the timing makes of *virtual_cycles* between two steps.
        """
        return SETTINGS[self.timing](virtual_cycles)

    @property
    def tells_missed(self) -> bool:
        """
        Tell whether steps that are missed are counted.
        """
        return self.sees_passed or self.overrun_cycles is not None

    @property
    def released(self) -> tuple[Pattern, ...]:
        """
        Return what the wires show in each phase while the motor needs no current.

        Shared enables show what `stepgen.reference.sharing` says. The other wires then keep the
        phase, since the coils may have current all the same.
        """
        if not self.shares_enables:
            return (self.coils_off,) * len(self.phases)
        kept = tuple(not care for care in self.coils_off.care)
        return tuple(
            Pattern(_only(phase.driven, kept), _only(phase.care, kept)) for phase in self.phases
        )


def _only(wires: Iterable[bool], kept: Iterable[bool]) -> tuple[bool, ...]:
    return tuple(wire and keep for wire, keep in zip(wires, kept, strict=True))


def never_set(_deadline_cycle: int) -> None:
    """
    Return None: no interrupt sets a channel.
    """


def served_at_once(deadline_cycle: int) -> int:
    """
    Return the deadline itself: the interrupt is taken without any delay.
    """
    return deadline_cycle

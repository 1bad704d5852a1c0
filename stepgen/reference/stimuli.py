"""
What happens to a motor, and what it then does: the input and the output of the model.

Cycles are CPU cycles since reset, absolute. In a list of stimuli, those of one cycle are in
their order of effect, a `MillisTick` before a call that reads it.
"""

from dataclasses import dataclass
from enum import StrEnum

from stepgen.reference.contract import ALL_CONTROL_BITS
from stepgen.reference.sequences import Pattern
from stepgen.reference.timer import COUNTER_STATES, PRESCALERS

UINT16_STATES = 1 << 16
UINT32_STATES = 1 << 32
UINT64_STATES = 1 << 64


@dataclass(frozen=True)
class SetSpeed:
    """
    A call of ``motorSetSpeed`` at its commit: the moment it masks the interrupts.

    Args:
        cycle: The commit; a step interrupt that is served later belongs to this call.
        control: Control bits, 0 to 255.
        virtual_cycles: I/O clocks between two steps, 32 bits, or 64 where they can be minutes; 0
            stops.
        limit: Steps, or milliseconds with ENDPOINT_MILLIS, 32 bits; 0 = endless.
        modification: What the first update event changes the virtual value by, 32 bits.
        update_interval: Milliseconds, or steps with UPDATE_STEPS, between two update events,
            16 bits.
        update_count: How many update events there are at most, 16 bits.
    """

    cycle: int
    control: int
    virtual_cycles: int
    limit: int = 0
    modification: int = 0
    update_interval: int = 0
    update_count: int = 0

    def __post_init__(self) -> None:
        _need("control", self.control, ALL_CONTROL_BITS + 1)
        _need("virtual_cycles", self.virtual_cycles, UINT64_STATES)
        _need("limit", self.limit, UINT32_STATES)
        _need("modification", self.modification, UINT32_STATES)
        _need("update_interval", self.update_interval, UINT16_STATES)
        _need("update_count", self.update_count, UINT16_STATES)


@dataclass(frozen=True)
class ClockOn:
    """
    The clock select of the step timer was written, with *tcnt* in the counter.
    """

    cycle: int
    prescaler: int
    tcnt: int

    def __post_init__(self) -> None:
        _need("tcnt", self.tcnt, COUNTER_STATES)
        if self.prescaler not in PRESCALERS:
            raise ValueError(f"prescaler {self.prescaler} is none of {PRESCALERS}")


@dataclass(frozen=True)
class ChannelSet:
    """
    A call set the motor's compare channel: it matches *ahead_cycles* later, 1 to 65 536.
    """

    cycle: int
    ahead_cycles: int


@dataclass(frozen=True)
class MillisTick:
    """
    From this cycle on ``millis()`` returns *millis*, 32 bits.
    """

    cycle: int
    millis: int

    def __post_init__(self) -> None:
        _need("millis", self.millis, UINT32_STATES)


@dataclass(frozen=True)
class Hold:
    """
    A call of ``motorHold``, at the moment it masks the interrupts.
    """

    cycle: int


@dataclass(frozen=True)
class Release:
    """
    A call of ``motorRelease``, at the moment it masks the interrupts.
    """

    cycle: int


@dataclass(frozen=True)
class Init:
    """
    A call of ``...ShieldInit``.
    """

    cycle: int


@dataclass(frozen=True)
class UpdateCheck:
    """
    A call of ``motorTimerUpdateCheck``, at the moment it masks the interrupts; it has no code.

    A `CallBack` follows.
    """

    cycle: int


@dataclass(frozen=True)
class CallBack:
    """
    The same call at the moment it masks the interrupts again, to see what it must call back.

    In between a step, an end point or the clock may have come.
    """

    cycle: int


@dataclass(frozen=True)
class KeepAlive:
    """
    A call of ``motorKeepAlive``, at the moment it masks the interrupts; it has no code.
    """

    cycle: int


@dataclass(frozen=True)
class Callbacks:
    """
    From this cycle on these callbacks are registered; before the first, none is.

    Args:
        cycle: The moment at which it is so.
        reached: Whether ``motorCallBackPositionReached`` has been given a function.
        fault: Whether ``motorCallBackFault`` has been given one.
    """

    cycle: int
    reached: bool
    fault: bool


@dataclass(frozen=True)
class MoveTo:
    """
    A call of an axis to go to *position*, int32.
    """

    cycle: int
    position: int


@dataclass(frozen=True)
class Move:
    """
    A call of an axis to go *steps* on from where it is, int32.
    """

    cycle: int
    steps: int


@dataclass(frozen=True)
class QueueMoveTo:
    """
    A call of an axis to go to *position*, int32, after all that was asked for before.
    """

    cycle: int
    position: int


@dataclass(frozen=True)
class RunOn:
    """
    A call of an axis to go on for ever in *direction*, +1 or -1.
    """

    cycle: int
    direction: int


@dataclass(frozen=True)
class Stop:
    """
    A call of an axis to come to rest as soon as its ramp allows.
    """

    cycle: int


@dataclass(frozen=True)
class Halt:
    """
    A call of an axis to make no step any more.
    """

    cycle: int


@dataclass(frozen=True)
class SetPace:
    """
    A call of an axis to make *interval_256*, in 1/256 clock, its shortest interval.
    """

    cycle: int
    interval_256: int

    def __post_init__(self) -> None:
        _need("interval_256", self.interval_256, UINT32_STATES)


@dataclass(frozen=True)
class SetPosition:
    """
    A call of an axis to call *position*, int32, where it is.
    """

    cycle: int
    position: int


@dataclass(frozen=True)
class Home:
    """
    A call of an axis to find the switch from which its positions count.
    """

    cycle: int


@dataclass(frozen=True)
class EmergencyStop:
    """
    A call of an axis to make no step any more until the fault is cleared.
    """

    cycle: int


@dataclass(frozen=True)
class ClearFault:
    """
    A call of an axis to forget why it moves no more.
    """

    cycle: int


@dataclass(frozen=True)
class Switches:
    """
    From this cycle on the limit switches of an axis at the ends *pressed* are pressed, no others.

    An interrupt whose response begins in this cycle sees them so.
    """

    cycle: int
    pressed: frozenset[str]


Call = SetSpeed | Hold | Release | Init
AxisCall = (
    MoveTo
    | Move
    | QueueMoveTo
    | RunOn
    | Stop
    | Halt
    | SetPace
    | SetPosition
    | Hold
    | Release
    | Init
    | Home
    | EmergencyStop
    | ClearFault
)
AxisStimulus = AxisCall | Switches | ChannelSet | ClockOn | MillisTick
Stimulus = Call | UpdateCheck | CallBack | KeepAlive | Callbacks | ClockOn | ChannelSet | MillisTick


class EdgeKind(StrEnum):
    """
    Why the wires are written.
    """

    STEP = "step"
    ENERGISE = "energise"
    COILS_OFF = "coils-off"


@dataclass(frozen=True)
class Edge:
    """
    One write of the wires.

    Every step is an edge, also where an own table repeats a pattern; the coils going on or off
    is one only where it changes their state, or where Init turns wires of a motor without current
    back to phase 0.

    Args:
        deadline_cycle: When the timer sets TOV, or the commit of the call that causes it.
        pattern: What the wires show from then on.
        position: The position from then on.
        kind: Why they are written.
        call_index: Which call it belongs to: an index into the return codes.
    """

    deadline_cycle: int
    pattern: Pattern
    position: int
    kind: EdgeKind
    call_index: int


def _need(name: str, value: int, states: int) -> None:
    if not 0 <= value < states:
        raise ValueError(f"{name} = {value} is not within 0 to {states - 1}")

"""
What the sketch is told: the status bits, and the callbacks that ``motorTimerUpdateCheck`` makes.
"""

from dataclasses import dataclass, field
from typing import Literal

from stepgen.reference.contract import Status

_COUNT_STATES = 1 << 16

CallbackMade = tuple[int, Literal["reached", "fault"]]


@dataclass
class Notices:
    """
    The status bits but SPIN_FIXED, and who is to be called.

    Args:
        status: The bits that are set.
        has_reached_callback: Whether a callback for a reached end point is registered.
        has_fault_callback: Whether one for faults is registered.
        made: Each callback so far, with the cycle of the check that made it.
        overruns: Deadlines since Init that were served too late, 16 bits.
        timed_out: Whether the command time-out ended the last motion.
    """

    status: Status = field(default_factory=lambda: Status(0))
    has_reached_callback: bool = False
    has_fault_callback: bool = False
    made: list[CallbackMade] = field(default_factory=list)
    overruns: int = 0
    timed_out: bool = False
    _at_end_point: bool = False

    def clear(self) -> None:
        """
        Clear all bits; a callback that has not been made yet is dropped.
        """
        self.status = Status(0)
        self.timed_out = False
        self._at_end_point = False

    def fault(self, bits: Status) -> None:
        """
        Set the *bits* of a new fault, which has not been called back; nothing without bits.
        """
        if bits:
            self.status = self.status & ~Status.FAULT_CALLED | bits

    def overrun(self) -> None:
        """
        Count a deadline that was served too late, and set MISSED.
        """
        self.status |= Status.MISSED
        self.overruns = (self.overruns + 1) % _COUNT_STATES

    def stopped(self) -> None:
        """
        Set REACHED for a stop, which is no end point: it calls nobody back.
        """
        self.status |= Status.REACHED

    def left_alone(self) -> None:
        """
        Note a stop by the command time-out, which is one like any other.
        """
        self.stopped()
        self.timed_out = True

    def end_point(self) -> None:
        """
        Set REACHED for an end point, which is called back once.
        """
        self.status |= Status.REACHED
        self._at_end_point = True

    def deliver(self, cycle: int) -> None:
        """
        Make the callbacks that are due, first that for the end point, and note that they were.
        """
        status = self.status
        if self._at_end_point and self.has_reached_callback and not status & Status.REACH_CALLED:
            self.made.append((cycle, "reached"))
            self.status |= Status.REACH_CALLED
        if self.has_fault_callback and status & Status.FAULT and not status & Status.FAULT_CALLED:
            self.made.append((cycle, "fault"))
            self.status |= Status.FAULT_CALLED
            if status & Status.TIMER_DIV_ERROR:
                self.status |= Status.TIMER_DIV_CALLED

"""
Update events: what is left of them, when the next one is due, and what it does to the speed.
"""

from dataclasses import dataclass
from typing import Self

from stepgen.reference.contract import Control
from stepgen.reference.stimuli import SetSpeed
from stepgen.reference.timer import SLOWEST_CYCLES


@dataclass
class Updates:
    """
    The update events of one accepted call with SPEED_VARIABLE.

    Args:
        control: The control bits of the call.
        modification: What the next event changes the virtual value by.
        interval: Milliseconds or steps from one event to the next.
        left: Events that may still happen.
        due_at: Milliseconds or steps since the call at which the next event is due.
        fastest_cycles: The limit of the virtual value at the fast end.
    """

    control: int
    modification: int
    interval: int
    left: int
    due_at: int
    fastest_cycles: int

    @classmethod
    def of(cls, call: SetSpeed, fastest_cycles: int) -> Self | None:
        """
        Return the update events that *call* asks for, None without SPEED_VARIABLE.
        """
        if not call.control & Control.SPEED_VARIABLE:
            return None
        return cls(
            control=call.control,
            modification=call.modification,
            interval=call.update_interval,
            left=call.update_count,
            due_at=call.update_interval,
            fastest_cycles=fastest_cycles,
        )

    @property
    def in_interrupt(self) -> bool:
        """
        Tell whether the step interrupt applies the events, or else ``motorTimerUpdateCheck``.
        """
        return bool(self.control & Control.IRQ_TIMING)

    def due(self, elapsed_millis: int, steps_made: int) -> bool:
        """
        Tell whether event n is due: n * interval milliseconds, or steps, since the call.
        """
        by_steps = self.control & Control.UPDATE_STEPS
        return self.left > 0 and (steps_made if by_steps else elapsed_millis) >= self.due_at

    def apply(self, virtual_cycles: int) -> tuple[int, bool]:
        """
        Let one event happen; return the new virtual value, and whether it stopped at a limit.

        v - m with FASTER, else v + m; then with VARIABLE_PWR m is halved or doubled. Where that
        would leave the range of virtual values the value becomes the limit, m stays as it is
        and no event is left. So m never passes 32 bits: doubled is only one that fitted.
        """
        faster = self.control & Control.FASTER
        wanted = (
            virtual_cycles - self.modification if faster else virtual_cycles + self.modification
        )
        within = min(max(wanted, self.fastest_cycles), SLOWEST_CYCLES)
        if within != wanted:
            self.left = 0
            return within, True
        self.left -= 1
        self.due_at += self.interval
        if self.control & Control.VARIABLE_PWR:
            self.modification = self.modification >> 1 if faster else 2 * self.modification
        return within, False

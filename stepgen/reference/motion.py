"""
What one accepted call asks for, and how much of it is left.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Self

from stepgen.reference.contract import Control
from stepgen.reference.facts import MotorFacts
from stepgen.reference.stimuli import UINT32_STATES, SetSpeed
from stepgen.reference.timer import TimerSetting
from stepgen.reference.updates import Updates


@dataclass
class Motion:
    """
    A motion until its end point, if it has one, with the update events of its call.

    Args:
        virtual_cycles: The virtual value, after the update events so far.
        direction: +1, or -1 with DIRECTION.
        call_index: The call that asked for it.
        steps_left: Steps still to be made, None without a steps limit.
        millis_limit: Its length, None without a millis limit.
        start_millis: What ``millis()`` returned at the commit of the call.
        updates: Its update events, None at a fixed speed.
        setting: What the timing makes of a virtual value.
        steps_made: Steps of this call so far.
    """

    virtual_cycles: int
    direction: int
    call_index: int
    steps_left: int | None
    millis_limit: int | None
    start_millis: int
    updates: Updates | None
    setting: Callable[[int], TimerSetting]
    steps_made: int = 0
    _next: TimerSetting = field(init=False)

    def __post_init__(self) -> None:
        self._next = self.setting(self.virtual_cycles)

    @classmethod
    def of(cls, call: SetSpeed, call_index: int, millis: int, facts: MotorFacts) -> Self:
        """
        Return the motion that the accepted *call* starts while ``millis()`` returns *millis*.
        """
        limit = call.limit or None
        by_millis = bool(call.control & Control.ENDPOINT_MILLIS)
        return cls(
            virtual_cycles=call.virtual_cycles,
            direction=-1 if call.control & Control.DIRECTION else 1,
            call_index=call_index,
            steps_left=None if by_millis else limit,
            millis_limit=limit if by_millis else None,
            start_millis=millis,
            updates=Updates.of(call, facts.minimum_cycles),
            setting=facts.setting,
        )

    @property
    def modification(self) -> int:
        """
        Return what the next update event changes the virtual value by, 0 at a fixed speed.
        """
        return self.updates.modification if self.updates else 0

    @property
    def updates_left(self) -> int:
        """
        Return how many update events may still happen.
        """
        return self.updates.left if self.updates else 0

    @property
    def updates_in_interrupt(self) -> bool:
        """
        Tell whether the step interrupt applies the update events.
        """
        return self.updates is not None and self.updates.in_interrupt

    def ended_at(self, millis: int) -> bool:
        """
        Tell whether no step is due any more: (millis - start) mod 2^32 >= limit.
        """
        return self.millis_limit is not None and self._elapsed(millis) >= self.millis_limit

    def begin_interval(self) -> TimerSetting:
        """
        Return prescaler and period of the interval that begins now.
        """
        return self._next

    def count_step(self) -> bool:
        """
        Count one step that was made, and tell whether it was the last.
        """
        self.steps_made += 1
        if self.steps_left is None:
            return False
        self.steps_left -= 1
        return self.steps_left == 0

    def update(self, millis: int) -> bool:
        """
        Let the next update event happen if it is due, and tell whether it stopped at a limit.

        The change acts from the next step that is served: as with a call while running, an
        overflow that still waits for its interrupt belongs to what comes after.
        """
        updates = self.updates
        if updates is None or not updates.due(self._elapsed(millis), self.steps_made):
            return False
        self.virtual_cycles, stopped = updates.apply(self.virtual_cycles)
        self._next = self.setting(self.virtual_cycles)
        return stopped

    def _elapsed(self, millis: int) -> int:
        return (millis - self.start_millis) % UINT32_STATES

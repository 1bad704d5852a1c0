"""
Motion ``constant``: what one accepted call asks for, and how much of it is left.

Another motion (update events) is another class with the same members: the model asks for
the setting anew at each step.
"""

from dataclasses import dataclass
from typing import Self

from stepgen.reference.contract import Control
from stepgen.reference.stimuli import UINT32_STATES, SetSpeed
from stepgen.reference.timer import TimerSetting, timer_setting


@dataclass
class ConstantMotion:
    """
    A motion at one speed until its end point, if it has one.

    Args:
        setting: Prescaler and period of the interval after each step.
        direction: +1, or -1 with DIRECTION.
        call_index: The call that asked for it.
        steps_left: Steps still to be made, None without a steps limit.
        millis_limit: Its length, None without a millis limit.
        start_millis: What ``millis()`` returned at the commit of the call.
    """

    setting: TimerSetting
    direction: int
    call_index: int
    steps_left: int | None
    millis_limit: int | None
    start_millis: int

    @classmethod
    def of(cls, call: SetSpeed, call_index: int, millis: int) -> Self:
        """
        Return the motion that the accepted *call* starts while ``millis()`` returns *millis*.
        """
        limit = call.limit or None
        by_millis = bool(call.control & Control.ENDPOINT_MILLIS)
        return cls(
            setting=timer_setting(call.virtual_cycles),
            direction=-1 if call.control & Control.DIRECTION else 1,
            call_index=call_index,
            steps_left=None if by_millis else limit,
            millis_limit=limit if by_millis else None,
            start_millis=millis,
        )

    def ended_at(self, millis: int) -> bool:
        """
        Tell whether no step is due any more: (millis - start) mod 2^32 >= limit.
        """
        if self.millis_limit is None:
            return False
        return (millis - self.start_millis) % UINT32_STATES >= self.millis_limit

    def count_step(self) -> bool:
        """
        Count one step that was made, and tell whether it was the last.
        """
        if self.steps_left is None:
            return False
        self.steps_left -= 1
        return self.steps_left == 0

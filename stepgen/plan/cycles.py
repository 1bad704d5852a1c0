"""
How long the boundary handler of a kernel takes.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class HandlerCycles:
    """
    How long the boundary handler takes, with both compilers on both chips.

    The first two are bounds, proven for each program that is verified (stepgen/verify/bounds);
    the others were measured.

    Args:
        longest: With everything at once, to the end of RETI.
        masked: How much longer a call has interrupts off than with a write to one port.
        to_clock: Until it starts the clock of a timer that it sets anew.
        to_clock_thinking: The same when it looked at the clock and made the step itself.
        turning: How much longer an axis takes that turns round there, since its driver has to see
            DIR for a while before and after.
    """

    longest: int
    masked: int
    to_clock: int
    to_clock_thinking: int
    turning: int = 0

"""
Trials of hazards: a command, the way of the step interrupt that it meets, and where they meet.
"""

from dataclasses import dataclass

from stepgen.reference.timer import FRACTIONS
from stepgen.verify.bench import APPROACH_CYCLES, Call
from stepgen.verify.scenarios import Action

AFTER_CYCLES = 40  # the call begins up to so many clocks after the interrupt has returned
PERIOD_CYCLES = 4_000  # the usual one of a trial
_SWEEP_TRIALS = 60


@dataclass(frozen=True)
class Way:
    """
    What the step interrupt has to do when the command meets it.

    Args:
        name: In words.
        start: The call that starts the motor, from rest.
        meets: Which step of it the command meets, from 2 on.
        again: A call half a period before that step, if there is one.
        settle_cycles: How long it takes from that step until what it did shows.
        after_tick_cycles: How long after ``millis()`` went on the motor starts, if that matters.
        only: The names of the commands that meet it; all, unless that takes too long.
        stride: A command meets it at each clock, or only at each so manieth.
        gaps_256: Of an axis the intervals before each step, in 1/256 clock; else they are all that
            of the start.
    """

    name: str
    start: Call
    meets: int = 4
    again: Call | None = None
    settle_cycles: int = 0
    after_tick_cycles: int | None = None
    only: frozenset[str] = frozenset()
    stride: int = 3
    gaps_256: tuple[int, ...] = ()

    @property
    def first_cycles(self) -> int:
        """
        Return how long after the start the first step comes.
        """
        return self.gaps_256[0] // FRACTIONS if self.gaps_256 else self.start.top

    @property
    def second_cycles(self) -> int:
        """
        Return how long after the first step the next one comes.
        """
        return self.gaps_256[1] // FRACTIONS if self.gaps_256 else self.start.top

    @property
    def period_cycles(self) -> int:
        """
        Return the interval before the step that is met.
        """
        return self.gaps_256[self.meets - 1] // FRACTIONS if self.gaps_256 else self.start.top

    def from_first(self, period: int) -> int:
        """
        Return how long after the first step the one is due that is met, each after *period*.

        An axis has intervals of its own, which add up with the fraction of a clock of the first.
        """
        if not self.gaps_256:
            return (self.meets - 1) * period
        first, *others = self.gaps_256[: self.meets]
        return (first % FRACTIONS + sum(others)) // FRACTIONS


@dataclass(frozen=True)
class Command:
    """
    What the sketch asks for: *actions*, and how long it takes until that shows.

    Args:
        name: In words.
        actions: Calls, and waits between them.
        settle_cycles: How long it takes until what they did shows.
        works_first: Whether the call works for long before it masks interrupts; what matters is how
            the step meets that section, at its end.
    """

    name: str
    actions: tuple[Action, ...]
    settle_cycles: int = 2 * PERIOD_CYCLES
    works_first: bool = False


@dataclass(frozen=True)
class Trial:
    """
    *command* meets the interrupt on its *way*, at an offset in clocks.
    """

    way: Way
    command: Command
    offset: int

    @property
    def settle_cycles(self) -> int:
        """
        Return how long to wait from the step, or from the call if that is later.
        """
        return max(self.way.settle_cycles, self.command.settle_cycles)


def window(way: Way, call_cycles: int, first: int = 0) -> range:
    """
    Return the offsets of *way* at the clocks of a call, and of what follows the interrupt.

    They begin with number *first* of those that its stride goes over. Of a call that is longer than
    the period only those clocks that come after the step before.
    """
    begin = -min(call_cycles, way.period_cycles - APPROACH_CYCLES)
    return range(begin + first % way.stride, AFTER_CYCLES, way.stride)


def sweep(way: Way, call_cycles: int) -> range:
    """
    Return offsets over the rest of the period; with another call in it, over what follows that.
    """
    longest = way.period_cycles // 2 - APPROACH_CYCLES if way.again else way.period_cycles
    return range(-longest, -call_cycles, max(longest // _SWEEP_TRIALS, 1))

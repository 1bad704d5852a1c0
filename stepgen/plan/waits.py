"""
How long a step interrupt can be kept waiting, and whether one is lost meanwhile.

An AVR runs no interrupt within another, takes the waiting one with the lowest vector number first,
and runs one instruction of the main line between two of them. So an interrupt waits for

- the instruction in which it becomes due;
- one with a higher number that has just begun; after that no further one of them is taken;
- a stretch with interrupts off: the instruction after that one may be CLI;
- those with a lower number, each as often as it can come until then;
- its own earlier runs, where these have not caught up, and an instruction after each interrupt.

As long as interrupts are waiting the main line has just these single instructions. In them it
comes from one long stretch with interrupts off to the next only after `LONG_APART` of them, and
from any stretch to a short one after `SHORT_APART`: a test finds that in the linked programs. Of a
sketch's own stretches, those that are closer together count as one.

The worst comes when all become due at once, just after what cannot be interrupted has begun. Run q
of the interrupt is then due q periods later and begins at the smallest w for which

    w = longest of higher number + stretches(w) + sum of n_j(w) * C_j + q * C + instructions(w)

holds, C its own cycles and n_j how often the one of lower number can have come by w. It is lost if
w is later than q periods and its patience. The runs are followed up to the first that finds
nothing waiting: from there all begins anew.

Source: Davis, Burns, Bril, Lukkien, Controller Area Network (CAN) schedulability analysis: Refuted,
revisited and revised, Real-Time Systems 35, 2007, section 3; it is the same arbitration.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

from stepgen.plan.model import Part

SHORT_STRETCH_CYCLES = 150
"""Interrupts off for so long at most are a short stretch: reading a position, `digitalWrite()`."""

SHORT_APART = 2
"""How many instructions at least lie between the end of a stretch and a short one."""

LONG_APART = 32
"""How many lie between two long ones: each call that has one works out a timer setting first."""

RARE_RUNS = 3
"""How often the rare way comes without a call between: a run's, a move's and the coils' end."""

_MOST_RUNS = 50  # a backlog that lasts longer counts as one that never ends


@dataclass(frozen=True)
class Source:
    """
    An interrupt.

    Args:
        cause: What a report calls it.
        vector: The number of its vector.
        cycles: The longest it takes, from the response through RETI.
        spacing_cycles: Shortest time between two.
        at_once: How many can follow each other without that time between.
        waiting: How many can be waiting after interrupts were off for long.
        rare_cycles: How much longer it takes now and then: up to `RARE_RUNS` times together, and
            once more for each call that there can be meanwhile.
    """

    cause: str
    vector: int
    cycles: int
    spacing_cycles: int
    at_once: int = 1
    waiting: int = 1
    rare_cycles: int = 0

    def total_cycles(self, count: int) -> int:
        """
        Return what *count* runs of it take together, at most.
        """
        rare = min(count, RARE_RUNS + count // LONG_APART)
        return count * self.cycles + rare * self.rare_cycles

    def most(self, window: int, masked: int) -> int:
        """
        Return how many can be served in *window* cycles, *masked* of them with interrupts off.

        The chip notes no more than *waiting* of those that come while interrupts are off; what
        comes afterwards adds to them.
        """
        arriving = window // self.spacing_cycles + self.at_once
        after = max(0, window - masked) // self.spacing_cycles + self.at_once
        kept = self.waiting + after
        return min(arriving, kept)


@dataclass(frozen=True)
class MainLine:
    """
    What of the main line has interrupts wait.

    Args:
        masked_cycles: Its longest stretch with interrupts off.
        instruction_cycles: Its longest instruction.
    """

    masked_cycles: int
    instruction_cycles: int


@dataclass(frozen=True)
class Wait:
    """
    The longest that an interrupt can wait, and what for when it has not run just before.
    """

    cycles: int
    parts: tuple[Part, ...]


def longest_wait(
    own: Source, patience_cycles: int, others: Sequence[Source], main: MainLine
) -> Wait | None:
    """
    Return the longest that *own* waits; None if it can wait for its patience, and be lost.
    """
    queue = _Queue.of(own, others, main)
    first: _Causes = []
    start = latest = 0
    for runs in range(_MOST_RUNS):
        due = runs * own.spacing_cycles
        causes = queue.settle(runs, start, due + patience_cycles)
        if causes is None:
            return None
        start = _total(causes)
        first, latest = first or causes, max(latest, start - due)
        rare = own.rare_cycles if runs < RARE_RUNS else 0
        ended = start + own.cycles + rare + main.instruction_cycles
        if ended <= due + own.spacing_cycles:
            return Wait(latest, tuple(Part(*cause) for cause in first))
    return None


# What an interrupt waits for, and for how many cycles.
_Causes = list[tuple[str, int]]


def _total(causes: _Causes) -> int:
    return sum([cycles for _, cycles in causes])


@dataclass(frozen=True)
class _Queue:
    """
    What *own* has to wait for.

    Args:
        own: The interrupt.
        ahead: Those of lower number, which are served first.
        begun: Of those of higher number the one that takes longest: it has just begun.
        main: What of the main line has interrupts wait.
    """

    own: Source
    ahead: tuple[Source, ...]
    begun: Source | None
    main: MainLine

    @classmethod
    def of(cls, own: Source, others: Sequence[Source], main: MainLine) -> Self:
        """
        Return the queue of *own* among *others*.
        """
        ahead = tuple(other for other in others if other.vector < own.vector)
        higher = [other for other in others if other.vector > own.vector]
        return cls(own, ahead, max(higher, key=lambda one: one.total_cycles(1), default=None), main)

    def settle(self, runs: int, start: int, too_late: int) -> _Causes | None:
        """
        Return what comes before the run after *runs* others; None if it begins too late.

        It does not begin before *start*, and has to begin before *too_late*.
        """
        while start < too_late:
            causes = self._before(runs, start)
            found = _total(causes)
            if found <= start:
                return causes
            start = found
        return None

    def _before(self, runs: int, start: int) -> _Causes:
        """
        Return what can come before a run that begins at *start*, counted from the first due time.
        """
        masked, instruction = self.main.masked_cycles, self.main.instruction_cycles
        counts = [one.most(start, masked) for one in self.ahead]
        passed = 1 + sum(counts) + runs  # instructions since the stretch that comes first
        short = passed // SHORT_APART * SHORT_STRETCH_CYCLES
        causes = [
            ("a call with interrupts off", masked * (1 + passed // LONG_APART)),
            ("short stretches with interrupts off", short),
        ]
        if self.begun:
            causes.append((self.begun.cause, self.begun.total_cycles(1)))
        for one, count in zip(self.ahead, counts, strict=True):
            if count:
                causes.append((one.cause, one.total_cycles(count)))
        if runs:
            causes.append(("its own earlier steps", self.own.total_cycles(runs)))
        causes.append(("instructions in between", (passed + bool(self.begun)) * instruction))
        return causes

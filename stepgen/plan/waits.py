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

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

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
    first: tuple[Part, ...] = ()
    start = latest = 0
    for runs in range(_MOST_RUNS):
        due = runs * own.spacing_cycles
        parts = _settle(own, runs, others, main, (start, due + patience_cycles))
        if parts is None:
            return None
        start = sum(part.cycles for part in parts)
        first, latest = first or parts, max(latest, start - due)
        rare = own.rare_cycles if runs < RARE_RUNS else 0
        ended = start + own.cycles + rare + main.instruction_cycles
        if ended <= due + own.spacing_cycles:
            return Wait(latest, first)
    return None


def _settle(
    own: Source,
    runs: int,
    others: Sequence[Source],
    main: MainLine,
    window: tuple[int, int],
) -> tuple[Part, ...] | None:
    """
    Return what comes before the run after *runs* others; None if it begins too late.

    *window* is where to look for its beginning: not before the first, and before the second.
    """
    start, too_late = window
    while start < too_late:
        parts = tuple(_before(own, runs, others, main, start))
        found = sum(part.cycles for part in parts)
        if found <= start:
            return parts
        start = found
    return None


def _before(
    own: Source, runs: int, others: Sequence[Source], main: MainLine, start: int
) -> Iterator[Part]:
    """
    Yield what can come before a run that begins at *start*, counted from the first due time.
    """
    later = [other for other in others if other.vector > own.vector]
    lower = max(later, key=lambda other: other.total_cycles(1), default=None)
    masked = main.masked_cycles
    counts = [(one, one.most(start, masked)) for one in others if one.vector < own.vector]
    served = sum(count for _, count in counts) + runs + bool(lower)
    passed = 1 + served - bool(lower)  # instructions since the stretch that comes first
    yield Part("a call with interrupts off", masked * (1 + passed // LONG_APART))
    yield Part("short stretches with interrupts off", passed // SHORT_APART * SHORT_STRETCH_CYCLES)
    if lower:
        yield Part(lower.cause, lower.total_cycles(1))
    yield from (Part(one.cause, one.total_cycles(count)) for one, count in counts if count)
    if runs:
        yield Part("its own earlier steps", own.total_cycles(runs))
    yield Part("instructions in between", (1 + served) * main.instruction_cycles)

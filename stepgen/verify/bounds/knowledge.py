"""
What is known of registers, memory and flags on one way through a program, bit by bit.

A bit is 0, 1, or a number from 2 on that stands for a bit nobody knows: the same number wherever
the same bit was copied to, so that what one test finds out holds for the next one too.
"""

from dataclasses import dataclass, field
from itertools import count

Byte = tuple[int, ...]
"""Eight bits, the lowest first."""

Condition = frozenset[tuple[int, int]] | None
"""Unknown bits and what all of them must be for it to hold; None never holds."""

_FIRST_UNKNOWN = 2
_names = count(_FIRST_UNKNOWN)


def unknown() -> int:
    """
    Return a new unknown bit.
    """
    return next(_names)


def unknown_byte() -> Byte:
    """
    Return a byte of new unknown bits.
    """
    return tuple(unknown() for _ in range(8))


def byte(value: int) -> Byte:
    """
    Return *value* modulo 256 as known bits.
    """
    return tuple(value >> bit & 1 for bit in range(8))


def number(bits: Byte) -> int | None:
    """
    Return the value of *bits*, or None if one of them is unknown.
    """
    if any(bit >= _FIRST_UNKNOWN for bit in bits):
        return None
    return sum(bit << place for place, bit in enumerate(bits))


def all_equal(first: Byte, second: Byte) -> Condition:
    """
    Return the condition under which the two bytes are equal.
    """
    found = set()
    for one, other in zip(first, second, strict=True):
        low, high = sorted((one, other))
        if low == high:
            continue
        if high < _FIRST_UNKNOWN:
            return None
        # Of two unknown bits only that they are equal or not can be said: a bit of its own.
        found.add((high, low) if low < _FIRST_UNKNOWN else (unknown(), 1))
    return frozenset(found)


def both(first: Condition, second: Condition) -> Condition:
    """
    Return the condition that both hold.
    """
    return None if first is None or second is None else first | second


@dataclass
class Facts:
    """
    Which unknown bits have turned out to be what, and which cannot all be at once.
    """

    bits: dict[int, int] = field(default_factory=dict)
    excluded: list[frozenset[tuple[int, int]]] = field(default_factory=list)

    def copy(self) -> "Facts":
        """
        Return a copy that can go its own way.
        """
        return Facts(dict(self.bits), list(self.excluded))

    def resolve(self, bits: Byte) -> Byte:
        """
        Return *bits* with what has turned out.
        """
        return tuple(self.bits.get(bit, bit) for bit in bits)

    def holds(self, condition: Condition) -> bool | None:
        """
        Tell whether *condition* holds; None if it may or may not.
        """
        left = self._left(condition)
        if left is None:
            return False
        if not left:
            return True
        open_ = (self._left(excluded) for excluded in self.excluded)
        return False if any(one is not None and one <= left for one in open_) else None

    def learn(self, condition: Condition, *, is_true: bool) -> bool:
        """
        Note that *condition* holds, or that it does not; tell whether that is possible.
        """
        left = self._left(condition)
        if left is None or not left:
            return bool(left is not None) == is_true
        if not is_true:
            self.excluded.append(left)
        else:
            self.bits.update(left)
        return self._follow()

    def _follow(self) -> bool:
        """
        Draw the conclusion where only one bit is left that can keep an exclusion.
        """
        waiting = True
        while waiting:
            waiting = False
            for excluded in self.excluded:
                left = self._left(excluded)
                if left is None:
                    continue
                if not left:
                    return False
                if len(left) == 1:
                    ((bit, value),) = left
                    self.bits[bit] = 1 - value
                    waiting = True
            self.excluded = [one for one in self.excluded if self._left(one) is not None]
        return True

    def _left(self, condition: Condition) -> Condition:
        """
        Return what of *condition* is still open.
        """
        if condition is None:
            return None
        known = self.bits
        if any(known.get(bit, value) != value for bit, value in condition):
            return None
        return frozenset(part for part in condition if part[0] not in known)

"""
Whole numbers that are not known, for running the reference model with them.
"""

from typing import Any, Self

import z3

from stepgen.verify.proof.paths import Paths

BITS = 72
"""
Wide enough to be without end: sums, differences and doubles of numbers of 64 bits, and products of
16 and 10 bits, stay far below 2**71.
"""


def wide(value: Any) -> Any:  # noqa: ANN401 - z3 has no types
    """
    Return the unsigned *value* of the chip as a number.
    """
    return z3.ZeroExt(BITS - value.size(), value)


def wide_signed(value: Any) -> Any:  # noqa: ANN401
    """
    Return the signed *value* of the chip as a number.
    """
    return z3.SignExt(BITS - value.size(), value)


class Number:
    """
    An unknown whole number; where the model asks what it is, `Paths.decide` answers.
    """

    __hash__ = None  # type: ignore[assignment]  # nothing unknown can be a key

    def __init__(self, value: Any, paths: Paths) -> None:  # noqa: ANN401
        self.value = value
        self._paths = paths

    def _new(self, value: Any) -> Self:  # noqa: ANN401
        return type(self)(value, self._paths)

    def __bool__(self) -> bool:
        return self._paths.decide(self.value != 0)

    def __add__(self, other: object) -> Self:
        return self._new(self.value + term(other))

    def __sub__(self, other: object) -> Self:
        return self._new(self.value - term(other))

    def __mul__(self, other: object) -> Self:
        return self._new(self.value * term(other))

    def __and__(self, other: object) -> Self:
        return self._new(self.value & term(other))

    def __rshift__(self, other: object) -> Self:
        return self._new(self.value >> term(other))

    def __floordiv__(self, other: int) -> Self:
        return self._new(z3.LShR(self.value, _power_of_two(other)))

    def __mod__(self, other: int) -> Self:
        return self._new(self.value & ((1 << _power_of_two(other)) - 1))

    def __lt__(self, other: object) -> bool:
        return self._paths.decide(self.value < term(other))

    def __le__(self, other: object) -> bool:
        return self._paths.decide(self.value <= term(other))

    def __gt__(self, other: object) -> bool:
        return self._paths.decide(self.value > term(other))

    def __ge__(self, other: object) -> bool:
        return self._paths.decide(self.value >= term(other))

    def __eq__(self, other: object) -> bool:
        return self._paths.decide(self.value == term(other))

    def __ne__(self, other: object) -> bool:
        return not self == other

    __radd__, __rmul__, __rand__ = __add__, __mul__, __and__


def term(number: object) -> Any:  # noqa: ANN401
    """
    Return *number*, known or unknown, for z3.
    """
    if isinstance(number, Number):
        return number.value
    if not isinstance(number, int):
        raise TypeError(f"{number} is no whole number")
    return z3.BitVecVal(int(number), BITS)


def _power_of_two(number: int) -> int:
    """
    Return the exponent: the model divides what is not negative, and by powers of two.
    """
    if number.bit_count() != 1:
        raise ValueError(f"{number} is no power of two")
    return number.bit_length() - 1

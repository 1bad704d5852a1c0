"""
The integers of an AVR: how many bits a type has, and when an operation loses some.
"""

from dataclasses import dataclass
from typing import Any

import z3


@dataclass(frozen=True)
class Integer:
    """
    An integer type of *bits* bits.
    """

    bits: int
    signed: bool = False

    def wide(self, value: Any, bits: int) -> Any:  # noqa: ANN401 - z3 has no types
        """
        Return *value* of this type as a signed number of *bits* bits, more than it has.
        """
        extend = z3.SignExt if self.signed else z3.ZeroExt
        return extend(bits - self.bits, value)


BOOL = Integer(1)
U8, U16, U24, U32, U64 = Integer(8), Integer(16), Integer(24), Integer(32), Integer(64)
I8, I16, I32, I64 = (Integer(bits, signed=True) for bits in (8, 16, 32, 64))

_NAMES = {
    "bool": BOOL,
    "uint8_t": U8,
    "unsigned char": U8,
    "int8_t": I8,
    "signed char": I8,
    "uint16_t": U16,
    "unsigned int": U16,
    "sizetype": U16,
    "int16_t": I16,
    "int": I16,
    "__uint24": U24,
    "uint32_t": U32,
    "long unsigned int": U32,
    "unsigned long": U32,
    "int32_t": I32,
    "long int": I32,
    "signed long": I32,
    "int64_t": I64,
    "long long int": I64,
    "uint64_t": U64,
    "long long unsigned int": U64,
}


def integer(name: str) -> Integer | None:
    """
    Return the integer type that C calls *name*, None if it is none.
    """
    return _NAMES.get(" ".join(part for part in name.split() if part not in {"const", "volatile"}))


def converted(value: Any, given: Integer, wanted: Integer) -> Any:  # noqa: ANN401
    """
    Return *value* of the type *given* as one of the type *wanted*, modulo its range.
    """
    if wanted == BOOL:
        return z3.If(value == 0, z3.BitVecVal(0, 1), z3.BitVecVal(1, 1))
    if wanted.bits <= given.bits:
        return z3.Extract(wanted.bits - 1, 0, value)
    return given.wide(value, wanted.bits)


def keeps(value: Any, given: Integer, wanted: Integer) -> Any:  # noqa: ANN401
    """
    Tell whether the conversion of *value* keeps its value.
    """
    if wanted == BOOL:
        return z3.BoolVal(val=True)
    bits = max(given.bits, wanted.bits) + 1
    return given.wide(value, bits) == wanted.wide(converted(value, given, wanted), bits)

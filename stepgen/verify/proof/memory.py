"""
The variables of a library: bit vectors by place, such as ``("motorMotion", "next", "top")``.
"""

from collections.abc import Iterator
from typing import Any

import z3

from stepgen.verify.proof.integers import U8, U32, Integer, integer
from stepgen.verify.proof.source import Source

Place = tuple[str, ...]

GENERAL_PURPOSE = {0x3E: "GPIOR0", 0x4A: "GPIOR1", 0x4B: "GPIOR2"}
"""The registers that are nothing but memory, by address, on both chips; section "I/O Registers"."""

CLOCK = ("timer0_millis",)


class Memory:
    """
    What is where; at first all of it is unknown.
    """

    def __init__(self, source: Source) -> None:
        self._structs = source.structs
        self._types: dict[Place, Integer] = {CLOCK: U32}
        self._types |= {(name,): U8 for name in GENERAL_PURPOSE.values()}
        for name, kind in source.variables.items():
            self.declare((name,), kind)
        for name, (kind, size) in source.arrays.items():
            for number in range(size):
                self.declare((name, str(number)), kind)
        self._values = {place: unknown(place, kind) for place, kind in self._types.items()}

    def declare(self, place: Place, kind: str) -> None:
        """
        Make room for a variable of the type *kind*, a structure or an integer.
        """
        scalar = integer(kind)
        if scalar is not None:
            self._types[place] = scalar
            return
        for name, inner in self._structs[
            kind.removeprefix("const ").removeprefix("struct ")
        ].items():
            self.declare((*place, name), inner)

    def type_at(self, place: Place) -> Integer | None:
        """
        Return the type of the integer at *place*, None if there is a structure.
        """
        return self._types.get(place)

    def within(self, place: Place) -> Iterator[Place]:
        """
        Yield what follows *place* in the places of its parts, () if it is an integer.
        """
        size = len(place)
        return (found[size:] for found in self._types if found[:size] == place)

    def read(self, place: Place) -> Any:  # noqa: ANN401 - z3 has no types
        """
        Return the integer at *place*.
        """
        return self._values[place]

    def write(self, place: Place, value: Any) -> None:  # noqa: ANN401
        """
        Put the integer *value* at *place*.
        """
        self._values[place] = value

    def size(self, place: Place) -> int:
        """
        Return how many elements the array at *place* has.
        """
        return sum(1 for _ in self.within(place))

    def element(self, place: Place, index: Any) -> Any:  # noqa: ANN401
        """
        Return element *index* of the array at *place*.
        """
        value = self.read((*place, "0"))
        for number in range(1, self.size(place)):
            value = z3.If(index == number, self.read((*place, str(number))), value)
        return value

    def put(self, place: Place, index: Any, value: Any) -> None:  # noqa: ANN401
        """
        Make *value* element *index* of the array at *place*.
        """
        for number in range(self.size(place)):
            one = (*place, str(number))
            self.write(one, z3.If(index == number, value, self.read(one)))

    def forget(self, moment: str) -> None:
        """
        Let all values be unknown again, with names of their own.
        """
        for place, kind in self._types.items():
            self._values[place] = unknown((*place, moment), kind)

    def snapshot(self) -> dict[Place, Any]:
        """
        Return all values as they are now.
        """
        return dict(self._values)


def unknown(place: Place, kind: Integer) -> Any:  # noqa: ANN401
    """
    Return the unknown that *place* holds at first.
    """
    return z3.BitVec(".".join(place), kind.bits)

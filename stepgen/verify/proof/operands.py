"""
What the names and the addresses in a statement of the intermediate form stand for.
"""

import re
from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from itertools import count
from typing import Any

import z3

from stepgen.verify.proof.gimple import Function
from stepgen.verify.proof.integers import U16, Integer, integer
from stepgen.verify.proof.memory import GENERAL_PURPOSE, Memory, Place
from stepgen.verify.proof.source import Source

NUMBER = re.compile(r"-?\d+$")
CALL = re.compile(r"([\w:~<>]+) \((.*)\)$")
CAST = re.compile(r"\(([\w ]+)\) (\S+)$")
_ADDRESS = re.compile(r"(\d+)B$")
_ELEMENT = re.compile(r"&?(\w+)\[(\S+)\]$")


@dataclass(frozen=True)
class Pointer:
    """
    Where a pointer points: a variable, a register, or an element of a table.
    """

    place: Place
    element: Any = None


@dataclass
class Frame:
    """
    One call of a function: its local variables, and the structures among them in memory.
    """

    function: Function
    place: Place
    values: dict[str, Any] = field(default_factory=dict)
    line: int = 0


class Operands(ABC):
    """
    The variables of a library, as the statements of its functions name them.
    """

    def __init__(self, source: Source) -> None:
        self.memory = Memory(source)
        self._source = source
        self._reads = count()

    @abstractmethod
    def called(self, text: str, frame: Frame) -> Any:  # noqa: ANN401 - z3 has no types
        """
        Execute the call *text* and return its result.
        """

    @abstractmethod
    def within(self, pointer: Pointer, frame: Frame) -> None:
        """
        Demand that *pointer* points to an element that its array has.
        """

    def type_of(self, text: str, frame: Frame) -> Integer | None:
        """
        Return the type of *text*, None if it is no integer.
        """
        if text in frame.function.types:
            return scalar(frame.function.types[text])
        place = self.place(text, frame)
        if place is None:
            return None
        if place.place[0] == "register":
            return scalar(frame.function.types[text[1:]].rstrip(" *"))
        if place.element is not None:
            return self.memory.type_at((*place.place, "0"))
        return self.memory.type_at(place.place)

    def value(self, text: str, frame: Frame, wanted: Integer) -> Any:  # noqa: ANN401
        """
        Return the integer *text*, of the type *wanted* if it is a number.
        """
        if NUMBER.match(text):
            return z3.BitVecVal(int(text), wanted.bits)
        if text == "0B":
            return z3.BitVecVal(0, wanted.bits)
        place = self.place(text, frame)
        if place is None:
            return frame.values[text]
        kind = self.type_of(text, frame)
        if kind is not None and place.place[0] == "register":
            return z3.BitVec(f"register {place.place[1]}, read {next(self._reads)}", kind.bits)
        if place.element is not None:
            self.within(place, frame)
            return self.memory.element(place.place, place.element)
        return self.memory.read(place.place)

    def pointer(self, text: str, frame: Frame) -> Any:  # noqa: ANN401, PLR0911 - one for each form
        """
        Return the `Pointer` that *text* is.
        """
        if found := _ADDRESS.match(text):
            address = int(found[1])
            name = GENERAL_PURPOSE.get(address)
            return Pointer((name,) if name else ("register", f"0x{address:02X}"))
        if found := CAST.match(text):
            return self.pointer(found[2], frame)
        if found := _ELEMENT.match(text):
            return Pointer((found[1],), self.value(found[2], frame, U16))
        if " + " in text:
            base, _, offset = text.partition(" + ")
            pointer, more = self.pointer(base, frame), self.value(offset, frame, U16)
            at = more if pointer.element is None else pointer.element + more
            return Pointer(pointer.place, at)
        if CALL.match(text):
            return self.called(text, frame)
        if text in frame.values:
            return frame.values[text]
        if text.startswith("&") and text[1:] in self._source.tables:
            return Pointer((text[1:],))
        return self.variable(text.removeprefix("&"), frame)

    def variable(self, text: str, frame: Frame) -> Pointer:
        """
        Return where *text* is, which is no integer among the local variables.
        """
        place: Pointer | None = self.place(text, frame)
        if place is None:
            raise ValueError(f"line {frame.line}: {text} has no place")
        return place

    def place(self, text: str, frame: Frame) -> Any:  # noqa: ANN401
        """
        Return the `Pointer` to where *text* is; None if it is an integer among the local variables.
        """
        if text.startswith("*"):
            return frame.values[text[1:]]
        base, arrow, fields = text.partition("->")
        if arrow:
            pointer = frame.values[base]
            return Pointer((*pointer.place, *fields.split(".")), pointer.element)
        if (found := _ELEMENT.match(text)) and found[1] in self._source.arrays:
            return Pointer((found[1],), self.value(found[2], frame, U16))
        parts = text.split(".")
        for size in range(len(parts), 0, -1):
            name = ".".join(parts[:size])
            if name in frame.function.types:
                local = (*frame.place, name, *parts[size:])
                known = parts[size:] or any(True for _ in self.memory.within(local))
                return Pointer(local) if known else None
        return Pointer(tuple(parts))


def is_pointer(kind: str) -> bool:
    """
    Tell whether the type *kind* is that of a pointer or a reference to a variable.
    """
    return kind.endswith(("*", "&"))


def scalar(kind: str) -> Integer | None:
    """
    Return the integer type *kind*, as which a pointer to a function counts too; None if it is none.
    """
    return U16 if "(*" in kind else integer(kind)

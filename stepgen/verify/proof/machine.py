"""
Executes the intermediate form with unknown values and checks each operation.
"""

import re
from collections.abc import Callable
from itertools import count
from typing import Any

import z3

from stepgen.verify.proof.gimple import Function
from stepgen.verify.proof.integers import BOOL, I16, U16, U32, Integer, converted, integer, keeps
from stepgen.verify.proof.meant import is_meant
from stepgen.verify.proof.memory import CLOCK, Place
from stepgen.verify.proof.operands import (
    CALL,
    CAST,
    NUMBER,
    Frame,
    Operands,
    Pointer,
    is_pointer,
    scalar,
)
from stepgen.verify.proof.operations import COMPARISONS, operation
from stepgen.verify.proof.paths import Paths
from stepgen.verify.proof.source import Source

_EXTREME = re.compile(r"(MAX|MIN)_EXPR <(\S+), (\S+)>$")
_GOTO = re.compile(r"goto <bb (\d+)>$")
_IF = re.compile(r"if \((.*)\) goto <bb (\d+)>; else goto <bb (\d+)>$")
_LOAD = re.compile(r'__asm__ __volatile__\("lpm .*?" : "=r" (\w+).*"z?1?" (\w+)\)', re.DOTALL)


class Machine(Operands):
    """
    A library whose functions can be called; its variables are unknown at first.

    Args:
        source: What the library declares.
        functions: Its functions.
        paths: Who decides at forks and proves.
    """

    def __init__(self, source: Source, functions: dict[str, Function], paths: Paths) -> None:
        super().__init__(source)
        self.written: list[tuple[str, Any]] = []
        self.calls: list[str] = []
        self.used: set[str] = set()
        self.known: dict[str, Callable[..., Any]] = {}
        self.rows: dict[str, Callable[[str, Any], Any]] = {}
        self.masked: Callable[[], object] = lambda: None
        self.unmasked: Callable[[], object] = lambda: None
        self.named: Callable[[Any], Any] = lambda value: value
        self._functions = functions
        self._paths = paths
        self._frames = count()

    def call(self, name: str, *arguments: Any) -> Any:  # noqa: ANN401 - z3 has no types
        """
        Call the function *name*, and return what it returns.
        """
        self.calls.append(name)
        function = self._functions[name]
        frame = Frame(function, (f"{name}#{next(self._frames)}",))
        for local, kind in function.types.items():
            if local in function.referred or (scalar(kind) is None and not is_pointer(kind)):
                self.memory.declare((*frame.place, local), kind)
        frame.values.update(zip(function.parameters, arguments, strict=True))
        return self._run(frame)

    def _run(self, frame: Frame) -> Any:  # noqa: ANN401
        block = min(frame.function.blocks)
        while True:
            following = 0
            for statement in frame.function.blocks[block]:
                frame.line = statement.line or frame.line
                text = statement.text
                if text == "return":
                    return None
                if text.startswith("return "):
                    return self._returned(text.removeprefix("return "), frame)
                following = self._jump(text, frame)
                if not following:
                    self._execute(text, frame)
            block = following or frame.function.after(block)

    def _returned(self, text: str, frame: Frame) -> Any:  # noqa: ANN401
        place = self.place(text, frame)
        if isinstance(place, Pointer) and self.memory.type_at(place.place) is None:
            return self._parts(place.place)
        return self.value(text, frame, I16)

    def _parts(self, place: Place) -> dict[Place, Any]:
        return {part: self.memory.read((*place, *part)) for part in self.memory.within(place)}

    def _jump(self, text: str, frame: Frame) -> int:
        if found := _GOTO.match(text):
            return int(found[1])
        if found := _IF.match(text):
            taken = self._paths.decide(self._right(found[1], frame, BOOL) == 1)
            return int(found[2] if taken else found[3])
        return 0

    def _execute(self, text: str, frame: Frame) -> None:
        left, equals, right = text.partition(" = ")
        if text.startswith("__asm__"):
            self._assembly(text, frame)
        elif not equals:
            self.called(text, frame)
        elif right != "{CLOBBER}":
            self._assign(left, right, frame)

    def _assembly(self, text: str, frame: Frame) -> None:
        found = _LOAD.match(text)
        if found:
            frame.values[found[1]] = self.entry(frame.values[found[2]], frame)
        elif not re.match(r'__asm__ __volatile__\("(cli)?" :  :  : "memory"', text):
            raise ValueError(f"line {frame.line}: {text}")

    def entry(self, pointer: Pointer, frame: Frame) -> Any:  # noqa: ANN401
        """
        Return what a table in flash has where *pointer* points.
        """
        table, *field = pointer.place
        kind, entries = self._source.tables[table]
        index = z3.BitVecVal(0, 32)
        if pointer.element is not None:
            index = z3.ZeroExt(16, pointer.element)
        if field:
            kind, entries, size = self._column(kind, field[0], entries)
            self._prove(z3.URem(index, size) == 0, "the beginning of a row", frame)
            index = z3.simplify(z3.UDiv(index, z3.BitVecVal(size, 32)))
        self._prove(z3.ULT(index, len(entries)), "an element that the table has", frame)
        if table in self.rows:
            return self.rows[table](field[0], index)
        bits = 16 if kind == "uint16_t" else 8
        if z3.is_bv_value(known := z3.simplify(index)):
            return z3.BitVecVal(entries[min(known.as_long(), len(entries) - 1)], bits)
        value = z3.BitVecVal(entries[0], bits)
        for number, entry in enumerate(entries):
            value = z3.If(index == number, z3.BitVecVal(entry, bits), value)
        return value

    def _column(self, row: str, name: str, entries: list[int]) -> tuple[str, list[int], int]:
        """
        Return the type of the field *name* of a table of rows, its *entries*, and a row's bytes.
        """
        fields = self._source.structs[row]
        number = list(fields).index(name)
        size = sum((integer(kind) or U16).bits // 8 for kind in fields.values())
        return fields[name], entries[number :: len(fields)], size

    def within(self, pointer: Pointer, frame: Frame) -> None:
        """
        Demand that *pointer* points to an element that its array has.
        """
        inside = z3.ULT(pointer.element, self.memory.size(pointer.place))
        self._prove(inside, "an element that the array has", frame)

    def called(self, text: str, frame: Frame) -> Any:  # noqa: ANN401
        """
        Execute the call *text* and return its result.
        """
        found = CALL.match(text)
        if found is None:
            raise ValueError(f"line {frame.line}: {text}")
        name, arguments = found[1], [part for part in found[2].split(", ") if part]
        if name.startswith("near<"):
            return self.pointer(arguments[0], frame)
        if name.startswith("Masked::"):
            (self.unmasked if "~" in name else self.masked)()
            return None
        if name == "millisCount":
            return converted(self.memory.read(CLOCK), U32, U16)
        # A callback comes last, and what it calls has its own proof.
        if name == "__builtin_avr_delay_cycles" or name in frame.values:
            return None
        function = self._functions[name]
        wanted = [function.types[parameter] for parameter in function.parameters]
        values = [
            self.pointer(part, frame)
            if is_pointer(kind)
            else self.value(part, frame, integer(kind) or U16)
            for part, kind in zip(arguments, wanted, strict=True)
        ]
        if name in self.known:
            return self.known[name](*values)
        return self.call(name, *values)

    def _assign(self, left: str, right: str, frame: Frame) -> None:
        kind = frame.function.types.get(left, "")
        if is_pointer(kind) or isinstance(self._loaded_address(right, frame), Pointer):
            frame.values[left] = self.pointer(right, frame)
            return
        wanted = self.type_of(left, frame)
        if wanted is None:
            self._copy(self.variable(left, frame).place, right, frame)
            return
        self._store(left, self._right(right, frame, wanted), frame)

    def _copy(self, place: Place, right: str, frame: Frame) -> None:
        """
        Put the structure *right* at *place*.
        """
        if CALL.match(right):
            parts = self.called(right, frame)
        else:
            parts = self._parts(self.variable(right, frame).place)
        for part, value in parts.items():
            self.memory.write((*place, *part), value)

    def _loaded_address(self, right: str, frame: Frame) -> Any:  # noqa: ANN401
        found = CAST.match(right)
        return frame.values.get(found[2]) if found else None

    def _store(self, left: str, value: Any, frame: Frame) -> None:  # noqa: ANN401
        place = self.place(left, frame)
        if place is None:
            frame.values[left] = value
        elif place.place[0] == "register":
            self.written.append((place.place[1], value))
        elif place.element is not None:
            self.within(place, frame)
            self.memory.put(place.place, place.element, value)
        else:
            self.memory.write(place.place, value)

    def _right(  # noqa: PLR0911 - one for each form of a right side
        self, text: str, frame: Frame, wanted: Integer
    ) -> Any:  # noqa: ANN401
        """
        Return what stands on the right of an assignment to something of the type *wanted*.
        """
        if found := CAST.match(text):
            return self._cast(found[2], frame, wanted)
        if found := _EXTREME.match(text):
            one, other = (self.value(part, frame, wanted) for part in found.groups()[1:])
            first = one >= other if wanted.signed else z3.UGE(one, other)
            return z3.If(first if found[1] == "MAX" else z3.Not(first), one, other)
        parts = text.split(" ")
        if len(parts) == 3 and not CALL.match(text):  # noqa: PLR2004 - a, operator, b
            return self._binary(parts[0], parts[1], parts[2], frame, wanted)
        if CALL.match(text):
            return self.called(text, frame)
        if text[0] == "~":
            return ~self.value(text[1:], frame, wanted)
        if text[0] == "-" and not NUMBER.match(text):
            return self._binary("0", "-", text[1:], frame, wanted)
        return self.value(text, frame, wanted)

    def _cast(self, text: str, frame: Frame, wanted: Integer) -> Any:  # noqa: ANN401
        given = self.type_of(text, frame) or wanted
        value = self.value(text, frame, given)
        # As signed char the compiler combines bits; it means no numbers by it.
        bits_only = given.bits == wanted.bits == 8  # noqa: PLR2004
        if not bits_only:
            self._prove(keeps(value, given, wanted), "a conversion that keeps the value", frame)
        return converted(value, given, wanted)

    def _binary(self, one: str, sign: str, other: str, frame: Frame, wanted: Integer) -> Any:  # noqa: ANN401
        if isinstance(frame.values.get(one), Pointer):
            ends = (frame.values[name].element for name in (one, other))
            first, last = (z3.BitVecVal(0, 16) if end is None else end for end in ends)
            return self._checked(sign, first, last, U16, frame)
        kind = self.type_of(one, frame) or self.type_of(other, frame) or wanted
        if sign in {"<<", ">>"}:
            kind = self.type_of(one, frame) or wanted
            amount = self.value(other, frame, I16)
            by = converted(amount, Integer(amount.size()), kind)
            self._prove(z3.ULT(amount, kind.bits), "a shift by less than the width", frame)
            return self._checked(sign, self.value(one, frame, kind), by, kind, frame)
        if sign in COMPARISONS and not kind:
            kind = U16
        return self._checked(
            sign, self.value(one, frame, kind), self.value(other, frame, kind), kind, frame
        )

    def _checked(
        self,
        sign: str,
        one: Any,  # noqa: ANN401
        other: Any,  # noqa: ANN401
        kind: Integer,
        frame: Frame,
    ) -> Any:  # noqa: ANN401
        if sign == "+" and self._subtracts(one, kind, frame):
            one, other = other, one
        if sign == "+" and self._subtracts(other, kind, frame):
            sign, other = "-", -other
        value, exact = operation(sign, one, other, kind)
        if exact is not None:
            self._prove(exact, f"a result of {sign} that fits", frame)
        return self.named(value) if sign in {"+", "-", "*"} else value

    def _subtracts(self, other: Any, kind: Integer, frame: Frame) -> bool:  # noqa: ANN401
        """
        Tell whether adding *other* stands for a subtraction.

        The compiler writes ``x - 1`` of 16 bits as ``x + 65535``. So a constant of the upper half
        that the source does not have is one that it subtracts.
        """
        if kind.signed or not z3.is_bv_value(other) or other.as_long() >> (kind.bits - 1) == 0:
            return False
        return str(other.as_long()) not in re.findall(r"\w+", self._source.statement(frame.line))

    def _prove(self, claim: Any, says: str, frame: Frame) -> None:  # noqa: ANN401
        text = self._source.statement(frame.line)
        if is_meant(text, self._source.motors, self.used):
            return
        self._paths.prove(claim, says, f"{frame.function.name}, line {frame.line}: {text}")

"""
A linked program as instructions: what avr-objdump says, with the source line of each.
"""

import re
from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from stepgen.errors import StepgenError
from stepgen.verify.compilers import Compiler, run

_FUNCTION = re.compile(r"([0-9a-f]+) <(.+)>:")
_SOURCE = re.compile(r"(?:.*/)?([^/:]+:\d+)(?: \(discriminator \d+\))?")
_SCOPE = re.compile(r"(\S.*)\(\):")
_INSTRUCTION = re.compile(r"\s*([0-9a-f]+):\t((?:[0-9a-f]{2} )+)\s*\t(\S+)\s*([^;]*)")
_SKIPS = frozenset({"cpse", "sbrc", "sbrs", "sbic", "sbis"})


@dataclass(frozen=True)
class Line:
    """
    One instruction.

    Args:
        address: Its byte address in flash.
        size: Its length in bytes, 2 or 4.
        name: Its mnemonic, as objdump writes it: ``brne``, ``ldd``.
        operands: ``("r24", "0x3f")``.
        source: The line that it was compiled from, ``Pan.cpp:120``; "" where that is unknown.
        scope: The function that it was written in, as the linker names it, inlined or not.
    """

    address: int
    size: int
    name: str
    operands: tuple[str, ...]
    source: str = ""
    scope: str = ""

    @property
    def following(self) -> int:
        """
        Return the address of the next instruction in flash.
        """
        return self.address + self.size

    @property
    def target(self) -> int:
        """
        Return where this jump, call or branch goes when it is taken.

        Raises:
            ValueError: It is none of these.
        """
        place = self.operands[-1]
        if place.startswith("."):
            return self.following + int(place[1:])
        return int(place, 0)

    @property
    def is_branch(self) -> bool:
        """
        Tell whether it is a conditional branch.
        """
        return self.name.startswith("br") and self.name != "break"

    @property
    def is_skip(self) -> bool:
        """
        Tell whether it may skip the instruction after it.
        """
        return self.name in _SKIPS

    @property
    def is_call(self) -> bool:
        """
        Tell whether it calls a function at a known address; ``rcall .+0`` only makes room.
        """
        return self.name in {"call", "rcall"} and self.target != self.following

    @property
    def is_jump(self) -> bool:
        """
        Tell whether it always goes to another known address.
        """
        return self.name in {"jmp", "rjmp"}

    @property
    def is_return(self) -> bool:
        """
        Tell whether it is RET or RETI.
        """
        return self.name in {"ret", "reti"}


@dataclass(frozen=True)
class Program:
    """
    The instructions of a program by address, and the functions, by where they begin.
    """

    lines: dict[int, Line]
    functions: dict[int, str]

    def at(self, address: int) -> Line:
        """
        Return the instruction at *address*.

        Raises:
            StepgenError: There is none.
        """
        line = self.lines.get(address)
        if line is None:
            raise StepgenError.of(f"no instruction begins at {address:#x}; is this code?")
        return line

    def after(self, line: Line) -> tuple[int, ...]:
        """
        Return where *line* may go on, a call's own function left out: it comes back.

        Raises:
            StepgenError: It goes where only the running program knows.
        """
        if line.is_return:
            return ()
        if line.is_jump:
            return (line.target,)
        if line.is_branch:
            return (line.following, line.target)
        if line.is_skip:
            return (line.following, self.at(line.following).following)
        if line.name in {"ijmp", "eijmp", "icall", "eicall"}:
            raise self.refuse(line, "goes where only the running program knows")
        return (line.following,)

    def function_at(self, address: int) -> str:
        """
        Return the name of the function that *address* lies in, without its arguments.
        """
        return self.functions[self.entry_of(address)] if self.functions else ""

    def entry_of(self, address: int) -> int:
        """
        Return where the function that *address* lies in begins.
        """
        return self._entries[max(0, bisect_right(self._entries, address) - 1)]

    @cached_property
    def _entries(self) -> list[int]:
        return sorted(self.functions)

    def describe(self, line: Line) -> str:
        """
        Return *line* for people: its function, source and instruction.
        """
        source = f" ({line.source})" if line.source else ""
        text = f"{line.name} {', '.join(line.operands)}".strip()
        return f"{self.function_at(line.address)}{source}, `{text}` at {line.address:#x}"

    def refuse(self, line: Line, why: str) -> StepgenError:
        """
        Return the error that *line* cannot be bounded, and why.
        """
        return StepgenError.of(f"{self.describe(line)} {why}: its cycles have no bound")


def disassemble(elf: Path, compiler: Compiler) -> Program:
    """
    Return the program in *elf*, as objdump of *compiler* reads it.

    Raises:
        StepgenError: It is no program for AVR.
    """
    objdump = str(compiler.bin_dir / "avr-objdump")
    text = run([objdump, "-d", "-l", "-C", "-w", str(elf)], place=str(elf))
    return parse(text)


def parse(listing: str) -> Program:
    """
    Return the program of which ``avr-objdump -d -l -C -w`` printed *listing*.
    """
    functions: dict[int, str] = {}
    lines = {line.address: line for line in _read(listing, functions)}
    return Program(lines, functions)


def _read(listing: str, functions: dict[int, str]) -> Iterator[Line]:
    source = scope = ""
    for text in listing.splitlines():
        if found := _INSTRUCTION.match(text):
            address, code, name, operands = found.groups()
            words = tuple(part.strip() for part in operands.split(",") if part.strip())
            yield Line(int(address, 16), len(code.split()), name, words, source, scope)
        elif found := _FUNCTION.fullmatch(text):
            functions[int(found[1], 16)] = found[2].partition("(")[0]
            source = scope = ""
        elif found := _SCOPE.fullmatch(text):
            scope = found[1]
        elif found := _SOURCE.fullmatch(text):
            source = found[1]

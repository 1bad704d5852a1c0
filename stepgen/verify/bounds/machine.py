"""
A chip as one way through a program knows it: registers, memory, stack and flags, bit by bit.
"""

from dataclasses import dataclass, field

from stepgen.devices import Mcu
from stepgen.verify.bounds.cycles import Core
from stepgen.verify.bounds.disassembly import Line
from stepgen.verify.bounds.knowledge import (
    Byte,
    Condition,
    Facts,
    all_equal,
    both,
    byte,
    number,
    unknown,
    unknown_byte,
)

IO_START = 0x20
"""What to add to an address of IN and OUT for that in data memory."""

_POINTERS = {"X": 26, "Y": 28, "Z": 30}

# Branch -> the flag that decides, and what it must be.
_FLAG_BRANCHES = {
    "breq": ("zero", True),
    "brne": ("zero", False),
    "brcs": ("carry", True),
    "brcc": ("carry", False),
    "brmi": ("negative", True),
    "brpl": ("negative", False),
    "brlt": ("sign", True),
    "brge": ("sign", False),
    "brts": ("stored", True),
    "brtc": ("stored", False),
}


@dataclass(frozen=True)
class Memory:
    """
    Which data addresses keep what was written to them, as RAM does.
    """

    ram_start: int
    kept: frozenset[int]
    pc_bytes: int

    @classmethod
    def of(cls, mcu: Mcu) -> "Memory":
        """
        Return the memory of *mcu*: its RAM, and the registers that are there to keep a byte.
        """
        kept = frozenset(register.address for register in mcu.gpiors)
        return cls(mcu.ram_start, kept, Core.of(mcu).pc_bytes)

    def keeps(self, address: int) -> bool:
        """
        Tell whether a read of *address* gives what was written there last.
        """
        return address >= self.ram_start or address in self.kept


@dataclass
class Machine:
    """
    Registers, data memory, stack and flags, as far as they are known.

    Args:
        memory: Which addresses keep their contents.
        registers: r0 to r31.
        data: What was read from or written to data memory, by address.
        stack: What was pushed; a number stands for the return address of a call.
        facts: What tests found out.
        zero: When the flag Z is set.
        borrows: Whether Z of the last result implies that there was no borrow, as a compare of
            several bytes needs it.
        carry: The flag C; likewise negative, sign (S) and stored (T).
    """

    memory: Memory
    registers: list[Byte] = field(default_factory=lambda: [unknown_byte() for _ in range(32)])
    data: dict[int, Byte] = field(default_factory=dict)
    stack: list[Byte | int] = field(default_factory=list)
    facts: Facts = field(default_factory=Facts)
    zero: Condition = field(default_factory=lambda: frozenset({(unknown(), 1)}))
    borrows: bool = False
    carry: int = field(default_factory=unknown)
    negative: int = field(default_factory=unknown)
    sign: int = field(default_factory=unknown)
    stored: int = field(default_factory=unknown)

    def copy(self) -> "Machine":
        """
        Return a copy that can go its own way.
        """
        return Machine(
            self.memory,
            list(self.registers),
            dict(self.data),
            list(self.stack),
            self.facts.copy(),
            self.zero,
            self.borrows,
            self.carry,
            self.negative,
            self.sign,
            self.stored,
        )

    def condition(self, line: Line) -> tuple[Condition, bool]:
        """
        Return what decides whether the branch or skip *line* goes, and what it must be.
        """
        name = line.name
        if name in _FLAG_BRANCHES:
            flag, wanted = _FLAG_BRANCHES[name]
            return self._flag(flag), wanted
        if name == "cpse":
            return all_equal(self.get(line, 0), self.get(line, 1)), True
        if name in {"sbrc", "sbrs"}:
            return _is_set(self.get(line, 0)[int(line.operands[1], 0)]), name == "sbrs"
        if name in {"sbic", "sbis"}:
            held = self.read(int(line.operands[0], 0) + IO_START)
            return _is_set(held[int(line.operands[1], 0)]), name == "sbis"
        return _is_set(unknown()), True

    def _flag(self, name: str) -> Condition:
        if name == "zero":
            return self.zero
        bit: int = getattr(self, name)
        return _is_set(self.facts.bits.get(bit, bit))

    def get(self, line: Line, place: int) -> Byte:
        """
        Return the register that operand number *place* names.
        """
        return self.facts.resolve(self.registers[register(line.operands[place])])

    def put(self, line: Line, value: Byte, place: int = 0) -> None:
        """
        Set the register that operand number *place* names.
        """
        self.registers[register(line.operands[place])] = value

    def read(self, address: int | None) -> Byte:
        """
        Return the byte at *address*; the same bits each time, where memory keeps them.
        """
        if address is None or not self.memory.keeps(address):
            return unknown_byte()
        return self.facts.resolve(self.data.setdefault(address, unknown_byte()))

    def write(self, address: int | None, value: Byte) -> None:
        """
        Note what is written to *address*; if nobody knows where that is, it may be anywhere.
        """
        if address is None:
            self.data.clear()
        elif self.memory.keeps(address):
            self.data[address] = value

    def pointer(self, name: str) -> int | None:
        """
        Return the address in the pointer X, Y or Z, or None.
        """
        first = _POINTERS[name]
        low, high = (number(self.facts.resolve(self.registers[first + i])) for i in (0, 1))
        return None if low is None or high is None else low | high << 8

    def set_pointer(self, name: str, address: int | None) -> None:
        """
        Set the pointer X, Y or Z.
        """
        first = _POINTERS[name]
        for i in (0, 1):
            known = address is not None
            self.registers[first + i] = byte((address or 0) >> 8 * i) if known else unknown_byte()

    def forget_flags(self) -> None:
        """
        Make all flags unknown.
        """
        self.zero, self.borrows = frozenset({(unknown(), 1)}), False
        self.carry, self.negative, self.sign = unknown(), unknown(), unknown()
        self.stored = unknown()

    def result(self, value: Byte, *, chained: bool = False, zero: Condition = frozenset()) -> Byte:
        """
        Set Z, N and S after *value*, of which Z is *zero*; *chained* goes on with an earlier Z.
        """
        self.zero = both(self.zero, zero) if chained else zero
        self.negative, self.sign = value[7], unknown()
        return value


def _is_set(bit: int) -> Condition:
    if bit == 0:
        return None
    return frozenset() if bit == 1 else frozenset({(bit, 1)})


def register(name: str) -> int:
    """
    Return the number of the register that an operand names.
    """
    return int(name.removeprefix("r"))

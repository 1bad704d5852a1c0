"""
The cycles of each instruction of an AVRe+ core.

Source: AVR Instruction Set Manual (DS40002198), column AVRe, for internal RAM; the chips'
datasheets, "Instruction Set Summary", say the same. What is not listed there as longer takes one.
"""

from dataclasses import dataclass
from typing import Self

from stepgen.devices import Mcu
from stepgen.verify.bounds.disassembly import Line

_WIDE_FLASH_BYTES = 128 * 1024  # beyond it a program counter of 16 bits does not reach

_CYCLES = {
    **dict.fromkeys(("adiw", "sbiw", "mul", "muls", "mulsu", "fmul", "fmuls", "fmulsu"), 2),
    **dict.fromkeys(("ld", "ldd", "st", "std", "lds", "sts", "push", "pop", "sbi", "cbi"), 2),
    **dict.fromkeys(("rjmp", "ijmp", "eijmp"), 2),
    **dict.fromkeys(("jmp", "lpm", "elpm"), 3),
}
# What pushes or pops the program counter: with two bytes, one more with three.
_WITH_PC = {"rcall": 3, "icall": 3, "eicall": 3, "call": 4, "ret": 4, "reti": 4}
_WITHOUT_BOUND = frozenset({"sleep", "spm", "break"})


@dataclass(frozen=True)
class Core:
    """
    What of a core decides how long its instructions take.

    Args:
        pc_bytes: Bytes of the program counter on the stack: 3 where the flash is over 128 KiB.
        response_cycles: From an interrupt's flag to the first instruction of its vector.
    """

    pc_bytes: int
    response_cycles: int

    @classmethod
    def of(cls, mcu: Mcu) -> Self:
        """
        Return the core of *mcu*.
        """
        return cls(3 if mcu.flash_bytes > _WIDE_FLASH_BYTES else 2, mcu.response_cycles)

    def cycles(self, line: Line) -> int | None:
        """
        Return how long *line* takes when it falls through; None if that has no bound.
        """
        if line.name.startswith(".") or line.name in _WITHOUT_BOUND:
            return None
        if line.name in _WITH_PC:
            return _WITH_PC[line.name] + self.pc_bytes - 2
        return _CYCLES.get(line.name, 1)


def extra_cycles(line: Line, goes_to: int) -> int:
    """
    Return how much longer *line* takes when it goes on at *goes_to*.

    A branch that is taken takes one more, a skip one for each word that it skips.
    """
    if line.is_branch:
        return int(goes_to == line.target)
    if line.is_skip:
        return (goes_to - line.following) // 2
    return 0

"""
What the machine has to know of an instruction before it runs.
"""

from enum import IntEnum


class Effect(IntEnum):
    """
    What an instruction may do beside computing; the access is the cycle of its I/O access.
    """

    PLAIN = 0
    STORE_1 = 1
    """OUT: the access is in its one cycle."""
    STORE_2 = 2
    """STS, ST, STD, CBI: the access is in the second of their cycles."""
    LOAD_2 = 3
    """LDS, LD, LDD: they read what is there at the start of their second cycle."""
    FLAGS = 4
    """SEI, CLI and OUT to SREG: may change the I flag."""
    RETURN = 5
    """RETI."""
    SLEEP = 6
    SHORT_CALL = 7
    """RCALL."""
    SET_BIT = 8
    """SBI: of a register of strobes it writes its one bit only."""


FIRST_RAM_ADDRESS = 0x100
_LONG_MASK, _LONG = 0xFC0F, 0x9000  # lds and sts
_LDD_MASK, _LDD = 0xD000, 0x8000  # and std
_LD_MASK, _LD = 0xFC00, 0x9000  # and st
_X, _Y, _Z = 26, 28, 30
# By the last four bits: X, X+, -X, Z+, -Z, Y+, -Y.
_POINTERS = {
    0xC: (_X, 0),
    0xD: (_X, 0),
    0xE: (_X, -1),
    0x1: (_Z, 0),
    0x2: (_Z, -1),
    0x9: (_Y, 0),
    0xA: (_Y, -1),
}
_SEI, _CLI, _RETI, _SLEEP = 0x9478, 0x94F8, 0x9518, 0x9588
# (mask, value, effect), the first that fits counts; AVR instruction set manual.
_PATTERNS = (
    (0xFFFF, _SEI, Effect.FLAGS),
    (0xFFFF, _CLI, Effect.FLAGS),
    (0xFFFF, _RETI, Effect.RETURN),
    (0xFFFF, _SLEEP, Effect.SLEEP),
    (0xFE0F, 0xBE0F, Effect.FLAGS),  # out 0x3F, Rr
    (0xF800, 0xB800, Effect.STORE_1),  # out
    (0xFF00, 0x9A00, Effect.SET_BIT),
    (0xFF00, 0x9800, Effect.STORE_2),  # cbi
    (0xF000, 0xD000, Effect.SHORT_CALL),
    (0xFE0F, 0x920F, Effect.PLAIN),  # push
    (0xFE00, 0x9200, Effect.STORE_2),  # sts, st X, st -X, st X+, ...
    (0xD200, 0x8200, Effect.STORE_2),  # std Y+q, std Z+q
    (0xFE0F, 0x900F, Effect.PLAIN),  # pop
    (0xFE0C, 0x9004, Effect.PLAIN),  # lpm, elpm
    (0xFE00, 0x9000, Effect.LOAD_2),  # lds, ld
    (0xD200, 0x8000, Effect.LOAD_2),  # ldd
)


def classify(image: bytes) -> bytes:
    """
    Return the effect of the instruction at each word of the flash *image*.

    The second word of a long instruction is classified too, but never run. LDS and STS of RAM
    are plain.
    """
    words = [image[at] | image[at + 1] << 8 for at in range(0, len(image) - 1, 2)]
    return bytes(map(_effect, words, [*words[1:], 0]))


def pointer_of(opcode: int) -> tuple[int, int] | None:
    """
    Return the low register of the pointer of an LD or ST, and what is added to it; else None.
    """
    if opcode & _LDD_MASK == _LDD:
        offset = (opcode >> 8 & 0x20) | (opcode >> 7 & 0x18) | (opcode & 7)
        return (_Y if opcode & 8 else _Z), offset
    return _POINTERS.get(opcode & 0xF) if opcode & _LD_MASK == _LD else None


def _effect(opcode: int, following: int) -> int:
    for mask, value, effect in _PATTERNS:
        if opcode & mask == value:
            is_ram = opcode & _LONG_MASK == _LONG and following >= FIRST_RAM_ADDRESS
            return int(Effect.PLAIN if is_ram else effect)
    return int(Effect.PLAIN)

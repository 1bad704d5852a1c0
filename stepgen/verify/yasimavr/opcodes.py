"""
What the machine has to know of an instruction before it runs.
"""

from enum import IntEnum

_STORE_CYCLES = 2


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
    """LDS, LD, LDD: the same, but one cycle earlier: they read what was there at its start."""
    FLAGS = 4
    """SEI, CLI and OUT to SREG: may change the I flag."""
    RETURN = 5
    """RETI."""
    SLEEP = 6
    SHORT_CALL = 7
    """RCALL."""
    SET_BIT = 8
    """SBI: of a register of strobes it writes its one bit only."""


_SEI, _CLI, _RETI, _SLEEP = 0x9478, 0x94F8, 0x9518, 0x9588
# (mask, value, effect), the first that fits counts; AVR instruction set manual.
_PATTERNS = (
    (0xFFFF, _SEI, Effect.FLAGS),
    (0xFFFF, _CLI, Effect.FLAGS),
    (0xFFFF, _RETI, Effect.RETURN),
    (0xFFFF, _SLEEP, Effect.SLEEP),
    (0xFE0F, 0xBE0F, Effect.FLAGS),  # out 0x3F, Rr
    (0xF800, 0xB800, Effect.STORE_1),  # out
    (0xFE0F, 0x920F, Effect.PLAIN),  # push
    (0xFE00, 0x9200, Effect.STORE_2),  # sts, st X, st -X, st X+, ...
    (0xD200, 0x8200, Effect.STORE_2),  # std Y+q, std Z+q
    (0xFF00, 0x9A00, Effect.SET_BIT),
    (0xFF00, 0x9800, Effect.STORE_2),  # cbi
    (0xF000, 0xD000, Effect.SHORT_CALL),
    (0xFE0F, 0x900F, Effect.PLAIN),  # pop
    (0xFE0C, 0x9004, Effect.PLAIN),  # lpm, elpm
    (0xFE00, 0x9000, Effect.LOAD_2),  # lds, ld
    (0xD200, 0x8000, Effect.LOAD_2),  # ldd
)


def classify(image: bytes) -> bytes:
    """
    Return the effect of the instruction at each word of the flash *image*.

    The second word of a long instruction is classified too, but never run.
    """
    known: dict[int, int] = {}
    effects = bytearray()
    for place in range(0, len(image) - 1, 2):
        opcode = image[place] | image[place + 1] << 8
        if opcode not in known:
            known[opcode] = _effect(opcode)
        effects.append(known[opcode])
    return bytes(effects)


def _effect(opcode: int) -> int:
    for mask, value, effect in _PATTERNS:
        if opcode & mask == value:
            return int(effect)
    return int(Effect.PLAIN)

"""
Coil tables from the electrical facts (systems/1-motor-driver.md, "Electrical facts").
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from stepgen.errors import StepgenError

Drive = Literal["four-wire", "motor-shield"]

WIRE_COUNT = 4
MINIMUM_PATTERNS = 2
MAXIMUM_PATTERNS = 64

_FOUR_WIRE_COILS = {
    "full": ("AB", "BC", "CD", "DA"),
    "wave": ("A", "B", "C", "D"),
    "half": ("A", "AB", "B", "BC", "C", "CD", "D", "DA"),
}
# Signs of the current in coil A and in coil B; 0 is a coil that is switched off.
_SHIELD_SIGNS = {
    "full": ("--", "+-", "++", "-+"),
    "wave": ("0-", "+0", "0+", "-0"),
    "half": ("--", "0-", "+-", "+0", "++", "0+", "-+", "-0"),
}


@dataclass(frozen=True)
class Pattern:
    """
    What the wires of a drive show, and which of them matter.

    A wire without care may show either level: the direction of a coil that is off moves
    nothing. Its entry in *driven* is False.

    Args:
        driven: One entry for each wire, True where it is driven (HIGH at the pin).
        care: One entry for each wire, True where *driven* is binding.
    """

    driven: tuple[bool, ...]
    care: tuple[bool, ...]

    def __str__(self) -> str:
        """
        Return the pattern as text, one of 0, 1 and x (either) for each wire.
        """
        return "".join(
            str(int(driven)) if care else "x"
            for driven, care in zip(self.driven, self.care, strict=True)
        )

    def allows(self, observed: Sequence[bool]) -> bool:
        """
        Tell whether wires that show *observed* show this pattern.

        That is asked for each step of each run, and a generator takes three times as long.
        """
        for driven, care, seen in zip(self.driven, self.care, observed, strict=True):
            if care and driven != seen:
                return False
        return True


def phases(drive: Drive, sequence: str | Sequence[str]) -> tuple[Pattern, ...]:
    """
    Return the patterns of one electrical turn, phase 0 first; backwards is the other direction.

    Wires of ``four-wire``: coils A, B, C, D. Wires of ``motor-shield``: PWM A and PWM B (the
    enables), DIR A, DIR B.

    Args:
        drive: The kind of drive.
        sequence: ``full``, ``wave`` or ``half``; for ``four-wire`` also an own table, 2 to 64
            texts of four characters 0 or 1, one for each wire.

    Raises:
        StepgenError: An unknown drive or sequence, or a table that is none.
    """
    if not isinstance(sequence, str):
        return _own_table(drive, sequence)
    if drive == "four-wire" and sequence in _FOUR_WIRE_COILS:
        return tuple(_coils(coils) for coils in _FOUR_WIRE_COILS[sequence])
    if drive == "motor-shield" and sequence in _SHIELD_SIGNS:
        return tuple(_signs(*signs) for signs in _SHIELD_SIGNS[sequence])
    raise StepgenError.of(
        f"the drive {drive} has no sequence of this name; take full, wave or half", text=sequence
    )


def coils_off(drive: Drive) -> Pattern:
    """
    Return the pattern that lets no current through any coil.
    """
    return _coils("") if drive == "four-wire" else _signs("0", "0")


def _coils(coils: str) -> Pattern:
    return _binding(tuple(coil in coils for coil in "ABCD"))


def _binding(driven: tuple[bool, ...]) -> Pattern:
    return Pattern(driven, (True,) * len(driven))


def _signs(sign_a: str, sign_b: str) -> Pattern:
    enabled = (sign_a != "0", sign_b != "0")
    positive = (sign_a == "+", sign_b == "+")
    return Pattern(enabled + positive, (True, True, *enabled))


def _own_table(drive: str, table: Sequence[str]) -> tuple[Pattern, ...]:
    if drive != "four-wire":
        raise StepgenError.of(f"the drive {drive} takes no table of its own", text=str(table))
    if not MINIMUM_PATTERNS <= len(table) <= MAXIMUM_PATTERNS:
        raise StepgenError.of(
            f"{len(table)} patterns; a table has {MINIMUM_PATTERNS} to {MAXIMUM_PATTERNS}"
        )
    for text in table:
        if len(text) != WIRE_COUNT or not set(text) <= {"0", "1"}:
            raise StepgenError.of("no pattern; write four characters 0 or 1", text=text)
    return tuple(_binding(tuple(wire == "1" for wire in text)) for text in table)

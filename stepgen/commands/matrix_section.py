"""
What a part of ``stepgen matrix`` has to show.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from stepgen.verify.junit import Case

Table = tuple[str, Sequence[str], Sequence[Sequence[str]]]
"""Title, heading, rows."""


@dataclass(frozen=True)
class Section:
    """
    A part of the matrix.

    Args:
        title: Its name.
        tables: For the terminal.
        notes: What failed or was left out, a line each.
        cases: For a JUnit report; one with a failure fails the command.
    """

    title: str
    tables: tuple[Table, ...]
    notes: tuple[str, ...]
    cases: "tuple[Case, ...]"

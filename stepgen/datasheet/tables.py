"""
Tables as finished text, and what makes them short: what several motors share is told once.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace

NONE = "-"
"""A cell of a motor that has no such thing."""

Row = tuple[str, ...]


@dataclass(frozen=True)
class Table:
    """
    A table: its heading, and rows whose first cell names them.

    Args:
        note: What holds of all rows, or "".
        kind: Its class in the style.
    """

    caption: str
    heading: Row
    rows: tuple[Row, ...]
    note: str = ""
    kind: str = "plain"

    @property
    def is_wide(self) -> bool:
        """
        Return whether it needs the whole width of a page: more letters than half of it has.
        """
        columns = zip(self.heading, *self.rows, strict=True)
        return sum(_letters(*column) + _AIR for column in columns) > _HALF


_HALF = 60  # letters, at the size of print
_AIR = 1.4  # letters between two columns
_LONGEST = 28  # a cell beyond it goes on in another line


def _letters(heading: str, *cells: str) -> int:
    """
    Return how wide a column is: the longest cell, or the longest word of its heading.
    """
    words = heading.split() or [""]
    return max(min(max(map(len, (*cells, ""))), _LONGEST), *map(len, words))


def told_once(table: Table) -> Table:
    """
    Return *table* without the columns that say the same in each of several rows: its note does.

    A column of which no row has anything is left out. If only one differs, that is told there too,
    and no row is left.
    """
    columns = list(zip(table.heading, *table.rows, strict=True))
    if len(table.rows) < 2:  # noqa: PLR2004 - one row is not several
        return table
    first, *others = columns
    same = [column for column in others if len(set(column[1:])) == 1 and column[1] != NONE]
    kept = [column for column in others if len(set(column[1:])) > 1]
    told = [f"{name}: {value}" for name, value, *_ in same]
    if len(kept) == 1:
        ((name, *values),) = kept
        each = (f"{row} {value}" for row, value in zip(first[1:], values, strict=True))
        told.append(f"{name}: {', '.join(each)}")
        kept = []
    heading, *rows = zip(first, *kept, strict=True) if kept else [()]
    note = "; ".join(filter(None, (table.note, *told)))
    return replace(table, heading=heading, rows=tuple(rows), note=note)


@dataclass(frozen=True)
class Tables:
    """
    Tables that belong together: first those that need the whole width, then those of half of it.
    """

    wide: tuple[Table, ...]
    narrow: tuple[Table, ...]


def by_width(tables: Iterable[Table]) -> Tables:
    """
    Return *tables*, sorted by whether they need the whole width of a page.
    """
    every = tuple(tables)
    return Tables(
        tuple(table for table in every if table.is_wide),
        tuple(table for table in every if not table.is_wide),
    )

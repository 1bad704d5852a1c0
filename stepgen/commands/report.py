"""
What the commands print: faults like a good compiler's, tables that also fit a pipe.
"""

import os
import re
import unicodedata
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path
from typing import Any

import typer

from stepgen.errors import Fault, StepgenError
from stepgen.spec.document import LINE_END, read_bytes

WRONG = 2  # exit code of wrong use and of an invalid spec
FAILED = 1  # exit code of a failed comparison, lint or freshness check

_PLACE = re.compile(r"(?P<path>.+):(?P<line>\d+):(?P<column>\d+)", re.DOTALL)
_LONGEST_LINE = 100
_LEAD = 30


def say(text: str) -> None:
    """
    Print *text* on stdout.
    """
    typer.echo(text, color=_color())


def complain(text: str) -> None:
    """
    Print *text* on stderr.
    """
    typer.echo(text, err=True, color=_color())


def report_faults(faults: Iterable[Fault]) -> None:
    """
    Print each fault on stderr, with its line of the spec and a caret under the column.
    """
    for fault in faults:
        head, _, rest = printable(str(fault)).partition("error: ")
        complain(typer.style(head, bold=True) + typer.style("error: ", fg="red", bold=True) + rest)
        for line in source_lines(fault):
            complain(line)


def source_lines(fault: Fault) -> tuple[str, ...]:
    """
    Return the line that *fault* is about and the line with the caret; nothing without a place.
    """
    match = _PLACE.fullmatch(fault.place)
    lines = _read_lines(match["path"]) if match else ()
    if not match or not 1 <= int(match["line"]) <= len(lines):
        return ()
    line = lines[int(match["line"]) - 1]
    at = min(int(match["column"]) - 1, len(line))
    if not line.strip():
        return ()
    cut = max(0, at - _LEAD) if len(line) > _LONGEST_LINE else 0
    shown = line[cut : cut + _LONGEST_LINE]
    marked = len(fault.text) if line.startswith(fault.text, at) else 1
    tail = "~" * (_width(shown[at - cut : at - cut + marked]) - 1)
    lead = "".join("\t" if c == "\t" else " " * _width(c) for c in shown[: at - cut])
    return (f"    {printable(shown)}", f"    {lead}^{tail}")


def printable(text: str) -> str:
    """
    Return *text* with what cannot be seen shown as ``?``: a spec must not steer a terminal.

    Bytes of a path that are no text stay: the streams escape them.
    """
    return "".join(
        c if c.isprintable() or c in "\t\n" or "\udc80" <= c <= "\udcff" else "?" for c in text
    )


def _width(text: str) -> int:
    """
    Return the columns that *text* takes in a terminal.
    """
    marks = sum(unicodedata.combining(c) != 0 for c in text)
    return len(text) - marks + sum(unicodedata.east_asian_width(c) in "WF" for c in text)


@lru_cache(maxsize=4)
def _read_lines(path: str) -> tuple[str, ...]:
    try:
        text = read_bytes(Path(path)).decode("utf-8-sig", errors="replace")
    except StepgenError:
        return ()
    return tuple(LINE_END.split(text))


def require_svg(path: Path | None) -> None:
    """
    Refuse a file for ``--plot`` whose name does not end in ``.svg``.

    Raises:
        StepgenError: It does not.
    """
    if path is not None and path.suffix.lower() != ".svg":
        raise StepgenError.of("--plot draws SVG; give a name that ends in .svg", text=str(path))


def _color() -> bool | None:
    """
    Return False where the user wants no colour; None leaves it to what the output is.
    """
    return False if os.environ.get("NO_COLOR") else None


def print_tables(parts: Sequence[tuple[str, Sequence[str], Iterable[Sequence[str]]]]) -> None:
    """
    Print tables of title, heading and rows; 80 columns wide where the output is no terminal.

    A title may be "" and a heading (). A row of one cell is a heading of the rows below it, and
    takes the whole width.
    """
    from rich.console import Console  # noqa: PLC0415 - rich takes as long to import as a spec

    console = Console(markup=False, highlight=False, emoji=False)
    for index, (title, heading, rows) in enumerate(parts):
        cells = [tuple(row) for row in rows]
        if index:
            console.print()
        if title:
            console.print(title, style="bold")
        table = _table(heading, cells, shows_heading=bool(heading))
        for row in cells:
            if len(row) > 1:
                table.add_row(*row)
                continue
            if table.rows or table.show_header:
                console.print(table)
            console.print(*row)
            table = _table(heading, cells, shows_heading=False)
        console.print(table)


def _table(heading: Sequence[str], cells: Sequence[Sequence[str]], *, shows_heading: bool) -> Any:  # noqa: ANN401 - rich is slow to import
    """
    Return a table without rows; where one of *cells* is a heading, all such tables are as wide.
    """
    from rich import box  # noqa: PLC0415 - rich takes as long to import as a spec to generate
    from rich.table import Table  # noqa: PLC0415 - the same

    table = Table(*heading, box=box.SIMPLE, show_header=shows_heading)
    table.show_edge = table.pad_edge = False
    for column in table.columns[:1]:
        column.no_wrap = True  # it names the row, and must be readable as a whole
    if any(len(row) == 1 for row in cells):
        whole = (heading, *(row for row in cells if len(row) > 1))
        for column, texts in zip(table.columns, zip(*whole, strict=True), strict=True):
            column.width, column.no_wrap = max(map(len, texts)), True
    return table


def track(paths: Sequence[Path]) -> Iterable[Path]:
    """
    Pass *paths* on, with a progress bar on stderr when there are several and it is a terminal.
    """
    if len(paths) == 1:
        return iter(paths)
    return _bar(paths, "Generating")


@contextmanager
def progress(title: str) -> Iterator[Callable[[Any], Iterable[Any]]]:
    """
    Lend a function that passes items on with a progress bar called *title*.
    """
    yield lambda items: _bar(items, title)


def _bar(items: Any, title: str) -> Iterable[Any]:  # noqa: ANN401 - passes anything on
    from rich.console import Console  # noqa: PLC0415 - rich is slow to import
    from rich.progress import track as rich_track  # noqa: PLC0415 - the same

    console = Console(stderr=True)
    shown = console.is_terminal
    return rich_track(items, title, console=console, transient=True, disable=not shown)

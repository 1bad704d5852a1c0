"""
The intermediate form of a source as avr-gcc prints it: functions of blocks of simple statements.

``-fdump-tree-cfg-lineno`` writes it after the front end, before any optimisation. Types are those
of the chip (int has 16 bits, ``__uint24`` is one of them) and conversions are explicit.
"""

import re
import subprocess
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

_HEADING = re.compile(r"^;; Function .*$", re.MULTILINE)
_WHERE = re.compile(r"\[(?:([^\]\s\[]*):)?(\d+):\d+\] ")
_BLOCK = re.compile(r"<bb (\d+)>:$")
_DECLARATION = re.compile(r"^(?P<type>.*?[\s*&])(?P<name>[\w.]+)$")


@dataclass(frozen=True)
class Statement:
    """
    One statement, as text, and the line of the source that it comes from (0: none, or a header's).
    """

    text: str
    line: int


@dataclass
class Function:
    """
    A function: its parameters in order, the type of each local name and of its result, its blocks.
    """

    name: str
    parameters: tuple[str, ...]
    types: dict[str, str]
    result: str = ""
    blocks: dict[int, list[Statement]] = field(default_factory=dict)

    @cached_property
    def referred(self) -> set[str]:
        """
        Return the local names of which a call takes the address.
        """
        found = re.compile(r"&(\w+)\b(?!->)")
        texts = (statement.text for block in self.blocks.values() for statement in block)
        return {name for text in texts for name in found.findall(text) if name in self.types}

    def after(self, block: int) -> int:
        """
        Return the block that *block* falls through to.
        """
        return min(number for number in self.blocks if number > block)


def functions(source: Path, compiler: Path | str, flags: Sequence[str]) -> dict[str, Function]:
    """
    Return the functions of *source* by name, as *compiler* understands it with *flags*.

    Raises:
        subprocess.CalledProcessError: The compiler refuses the source.
    """
    with tempfile.TemporaryDirectory() as folder:
        options = ("-std=gnu++11", "-Os", "-fdump-tree-cfg-lineno", "-o", "out.o", "-c")
        subprocess.run(
            [compiler, *flags, *options, source],
            cwd=folder,
            check=True,
            capture_output=True,
        )
        (dump,) = Path(folder).glob("*.cfg")
        text = dump.read_text(encoding="utf-8")
    parsed = (_function(part) for part in _HEADING.split(text)[1:])
    return {function.name: function for function in parsed}


def _function(text: str) -> Function:
    head, _, body = text.partition("\n{\n")
    signature = [line for line in head.splitlines() if line and not line.startswith(";;")][-1]
    heading, _, listed = signature.rpartition(" (")
    *result, name = re.sub(r"\(.*", "", heading).split()
    name = name.lstrip("*&")
    types: dict[str, str] = {}
    parameters = [part for part in listed.rstrip(")").split(", ") if part]
    names = tuple(_declare(part, types) for part in parameters)
    function = Function(name, names, types, " ".join(result))
    _read(body.rpartition("\n}")[0], function)
    return function


def _declare(text: str, types: dict[str, str]) -> str:
    found = _DECLARATION.match(text)
    if found is None:
        raise ValueError(f"no declaration: {text}")
    types[found["name"]] = found["type"].strip()
    return found["name"]


def _read(body: str, function: Function) -> None:
    block: list[Statement] | None = None
    waiting = ""
    for line in body.splitlines():
        if block is None and line.startswith("  ") and line.endswith(";"):
            if not line.startswith("  static "):  # a text in flash, which computes nothing
                _declare(line.strip().rstrip(";"), function.types)
        elif found := _BLOCK.search(line):
            block = function.blocks.setdefault(int(found[1]), [])
        elif block is not None and line.strip():
            waiting = f"{waiting} {line.strip()}".strip()
            if _complete(waiting):
                block.append(_statement(waiting))
                waiting = ""


def _complete(text: str) -> bool:
    bare = _WHERE.sub("", text)
    if bare.startswith("if "):
        return bare.count("goto") == 2  # noqa: PLR2004 - both ways of it
    return bare.endswith(";")


def _statement(text: str) -> Statement:
    lines = [int(line) for file, line in _WHERE.findall(text) if not file.endswith(".h")]
    return Statement(_WHERE.sub("", text).rstrip(";"), lines[0] if lines else 0)

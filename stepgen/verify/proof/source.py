"""
What a generated source declares: structures, tables in flash, variables, and where a motor's are.
"""

import re
from dataclasses import dataclass
from pathlib import Path

_COMMENT = re.compile(r"//.*$", re.MULTILINE)
_STRUCT = re.compile(r"^struct (\w+) \{\n(.*?)^\};", re.MULTILINE | re.DOTALL)
_FIELD = re.compile(r"^  (\w+) (\w+);", re.MULTILINE)
_CALLBACK = re.compile(r"^  void \(\*(\w+)\)\(\);", re.MULTILINE)
_TABLE = re.compile(
    r"^static const (\w+) (\w+)\[\] PROGMEM.*?= \{(.*?)\};", re.MULTILINE | re.DOTALL
)
_VARIABLE = re.compile(r"^static (\w+) (\w+);", re.MULTILINE)
_ARRAY = re.compile(r"^static (\w+) (\w+)\[(\d+)\];", re.MULTILINE)
_MOTOR = re.compile(r"^int8_t (\w+)SetSpeed\(", re.MULTILINE)
_ENDS = ";{}:"
_OPERANDS = re.compile(r"^\s+:\n\s+:\n(.*?)^\s+: \"memory\"\);", re.MULTILINE | re.DOTALL)
_OPERAND = re.compile(r'\[(\w+)\] "\w"\(&?(?:_SFR_IO_ADDR\()?([\w.]+)\)?\)')


@dataclass(frozen=True)
class Source:
    """
    A generated source, with its text by lines and what it declares.

    Args:
        lines: The text, line 1 first.
        structs: The fields of each structure with their types, in order.
        tables: The type and the entries of each table in flash.
        variables: The type of each variable.
        arrays: The type and the size of each variable that is an array.
        motors: The names of the motors.
        operands: For each motor the operands of its step interrupt's assembly, such as ``count``.
    """

    lines: tuple[str, ...]
    structs: dict[str, dict[str, str]]
    tables: dict[str, tuple[str, list[int]]]
    variables: dict[str, str]
    arrays: dict[str, tuple[str, int]]
    motors: tuple[str, ...]
    operands: dict[str, dict[str, str]]

    def statement(self, line: int) -> str:
        """
        Return the statement that *line* is part of, on one line and without comments; of line 0 "".
        """
        if not line:
            return ""
        code = [_COMMENT.sub("", text).strip() for text in self.lines]
        first = last = line - 1
        while first and code[first - 1] and code[first - 1][-1] not in _ENDS:
            first -= 1
        while code[last] and code[last][-1] not in _ENDS:
            last += 1
        return " ".join(code[first : last + 1])


def read_source(path: Path) -> Source:
    """
    Return what the generated source at *path* declares.
    """
    text = path.read_text(encoding="utf-8")
    bare = _COMMENT.sub("", text)
    motors = tuple(_MOTOR.findall(bare))
    listed = [dict(_OPERAND.findall(part)) for part in _OPERANDS.findall(bare)]
    return Source(
        lines=tuple(text.splitlines()),
        structs={name: _fields(body) for name, body in _STRUCT.findall(bare)},
        tables={
            name: (kind, [int(entry, 0) for entry in re.findall(r"\w+", body)])
            for kind, name, body in _TABLE.findall(bare)
        },
        variables={name: kind for kind, name in _VARIABLE.findall(bare)},
        arrays={name: (kind, int(size)) for kind, name, size in _ARRAY.findall(bare)},
        motors=motors,
        operands={
            motor: operands
            for motor in motors
            for operands in listed
            if any(place.startswith(f"{motor}Motion.") for place in operands.values())
        },
    )


def _fields(body: str) -> dict[str, str]:
    fields = {name: kind for kind, name in _FIELD.findall(body)}
    return fields | dict.fromkeys(_CALLBACK.findall(body), "uint16_t")

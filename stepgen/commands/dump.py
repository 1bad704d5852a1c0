"""
Plans as plain data, for JSON: the keys are the names of the dataclasses' fields.
"""

from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass
from fractions import Fraction
from typing import Any

from pydantic import BaseModel

from stepgen.devices import Board, PortBit

_BOARD_KEYS = ("name", "title", "f_cpu_hz", "fqbn")


def plain(value: Any) -> Any:  # noqa: ANN401 - a plan is any data
    """
    Return *value* as dicts, lists and scalars.

    A fraction is ``{"numerator", "denominator"}``, a port bit its name, and a board what tells
    it from others (`stepgen boards` shows the rest). A kernel begins with its ``kind``.
    """
    for kind, convert in _CONVERTERS.items():
        if isinstance(value, kind):
            return convert(value)
    if is_dataclass(value):
        kind_only = {"kind": value.kind} if hasattr(value, "kind") else {}
        return kind_only | {part.name: plain(getattr(value, part.name)) for part in fields(value)}
    return value


_CONVERTERS: Mapping[type, Callable[[Any], Any]] = {
    Board: lambda board: {
        **{key: getattr(board, key) for key in _BOARD_KEYS},
        "mcu": board.mcu.name,
    },
    PortBit: lambda bit: bit.name,
    Fraction: lambda exact: {"numerator": exact.numerator, "denominator": exact.denominator},
    BaseModel: lambda model: model.model_dump(mode="json"),
    dict: lambda mapping: {str(key): plain(inner) for key, inner in mapping.items()},
    tuple: lambda several: [plain(inner) for inner in several],
    list: lambda several: [plain(inner) for inner in several],
}

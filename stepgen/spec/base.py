"""
What all parts of a spec have in common: strict models, and kinds found by their module.
"""

import pkgutil
from collections.abc import Sequence
from importlib import import_module
from typing import Any

from pydantic import BaseModel, ConfigDict


class SpecModel(BaseModel):
    """
    A part of a spec: unknown fields are refused and nothing changes after loading.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)


class KindModel(SpecModel):
    """
    One kind of drive, timing or motion; subclasses pin ``kind`` to their own name.
    """

    kind: str


def kinds_in(package: str, path: Sequence[str]) -> tuple[type[KindModel], ...]:
    """
    Return the ``SPEC`` class of each module in *package*, in the order of their names.

    A new kind is a new module: nothing lists them.
    """
    names = sorted(module.name for module in pkgutil.iter_modules(list(path)))
    return tuple(import_module(f"{package}.{name}").SPEC for name in names)


def kind_names(kinds: Sequence[type[KindModel]]) -> tuple[str, ...]:
    """
    Return the value of ``kind`` that selects each of *kinds*.
    """
    return tuple(str(kind.model_fields["kind"].default) for kind in kinds)


def as_kind(value: Any) -> Any:  # noqa: ANN401 - whatever the YAML held
    """
    Return ``{kind: value}`` for the short form, in which a kind is just its name.
    """
    return {"kind": value} if isinstance(value, str) else value

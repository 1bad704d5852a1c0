"""
What all parts of a spec have in common: strict models, and kinds found by their module.
"""

import pkgutil
from collections.abc import Callable, Mapping, Sequence
from importlib import import_module
from types import MappingProxyType
from typing import Any, ClassVar, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict


class SpecModel(BaseModel):
    """
    A part of a spec: unknown fields are refused and nothing changes after loading.

    The text below each field is what `stepgen schema` says of it.
    """

    model_config = ConfigDict(
        extra="forbid", frozen=True, strict=True, use_attribute_docstrings=True
    )


class KindModel(SpecModel):
    """
    One kind of drive, timing or motion; subclasses pin ``kind`` to their own name.

    *asked* are fields of which some are needed though each has a default: a first spec asks for
    them too. *first* is what a first spec has in fields that need a value, to be changed.
    """

    asked: ClassVar[tuple[str, ...]] = ()
    first: ClassVar[Mapping[str, int]] = MappingProxyType({})
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


def short_form(wrap: Callable[[Any], Any], accepted: Any) -> BeforeValidator:  # noqa: ANN401 - a type
    """
    Return the annotation of a field that may be written shorter; *wrap* makes it long.

    *accepted* is the type of what may be written, for the JSON Schema.
    """
    return BeforeValidator(wrap, json_schema_input_type=accepted)


def kind_in_short(union: Any, kinds: Sequence[type[KindModel]]) -> BeforeValidator:  # noqa: ANN401 - a type
    """
    Return the annotation of a field of *union*, where one of *kinds* may be just its name.
    """
    return short_form(_as_kind, union | Literal[kind_names(kinds)])


def _as_kind(value: Any) -> Any:  # noqa: ANN401 - whatever the YAML held
    return {"kind": value} if isinstance(value, str) else value

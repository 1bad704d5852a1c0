"""
From a YAML file to a Spec, with every fault at its line.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeGuard, TypeVar

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from stepgen.errors import Fault, StepgenError
from stepgen.spec.document import Document, Location, read_document
from stepgen.spec.model import SHORT_FORMS, Spec

# What pydantic finds -> what is wrong and what to do. Of an entry of a list:
_ENTRY_REASONS = {"missing": "has too few entries; give one for each wire"}
# Of a certain field:
_FIELD_REASONS = {
    ("too_short", "pins"): "has too few entries; give one for each wire",
    ("missing[]", "range"): "has too few entries; write the lowest and the highest position",
    ("too_long", "range"): "has too many entries; write the lowest and the highest position",
    ("too_long", "pins"): "has too many entries; give one for each wire",
    (
        "too_short",
        "motors",
    ): "motors is empty; add a motor, such as `motor: {{drive: motor-shield}}`",
    ("string_pattern_mismatch", "version"): (
        "is no version; write three numbers in quotes, such as 1.0.0"
    ),
    ("string_type", "version"): "is no version; write three numbers in quotes, such as 1.0.0",
    ("string_type", "[key]"): "is no name; write one that begins with a letter, such as pan",
    ("missing", "pins"): "pins is missing; add `pins: [...]`, those of the coils A, B, C and D",
    ("greater_than_equal", "isr_cycles"): (
        "is too few for any interrupt; write the most CPU cycles that a step may take, such as 200"
    ),
    ("string_pattern_mismatch", "url"): (
        "is no address of a page; write one that begins with https:// or http://, without blanks"
    ),
    ("model_type", "steps_per_turn"): (
        "is no number of steps; write a whole number such as 200, or full_steps and gear"
    ),
}
# Of any field:
_REASONS = {
    "missing": "{field} is missing; add `{field}: ...`",
    "extra_forbidden": "{field} is no field of this part of a spec; remove it or correct its name",
    "value_error": "{error}",
    "model_type": "{field} needs fields of its own; write them indented below it",
    "dict_type": "{field} needs fields of its own; write them indented below it",
    "string_type": "{field} must be text; put it in quotes",
    "string_unicode": "{field} must be text of whole characters; write it without escapes",
    "string_too_long": "{field} is too long; write at most {max_length} characters",
    "int_type": "{field} must be a whole number; write it in digits, without quotes",
    "bool_type": "{field} is either; write true or false",
    "tuple_type": "{field} must be a list; write it in brackets, [..]",
    "too_long": "{field} has too many entries; write at most {max_length}",
    "greater_than_equal": "{field} is too small; write {ge} or more",
    "less_than_equal": "{field} is too large; write {le} or less",
    "invalid_key": "is no name of a field; remove it, or put it in quotes",
    "model_attributes_type": "{field} needs fields of its own; write them indented below it",
    "literal_error": "is not possible for {field}; write {expected}",
    "union_tag_invalid": '"{tag}" is unknown; choose one of {expected_tags}',
    "union_tag_not_found": "has no kind; add `kind: ...`",
    "string_pattern_mismatch": (
        "{field} must be one line of text without control characters; write it in one line"
    ),
}

Model = TypeVar("Model", bound=BaseModel)


@dataclass(frozen=True)
class LoadedSpec:
    """
    A valid spec and the document that it came from.
    """

    spec: Spec
    document: Document

    def fault(self, location: Location, reason: str) -> Fault:
        """
        Return a fault at the place of *location*, such as ``("motors", "pan", "drive")``.
        """
        place, text = self.document.place(_in_yaml(location, self.document))
        return Fault(place, text, reason)


def load_spec(path: Path) -> LoadedSpec:
    """
    Load the spec in *path*: its shape and its local rules; the planner finds the rest.

    Raises:
        StepgenError: All faults of the spec, each with its place and a way out.
    """
    document, spec = load_model(path, Spec)
    return LoadedSpec(spec, document)


def load_model(path: Path, model: type[Model]) -> tuple[Document, Model]:
    """
    Load the YAML file *path* as a *model*.

    Raises:
        StepgenError: All faults of the file, each with its place and a way out.
    """
    document = read_document(path)
    try:
        return document, model.model_validate(dict(document.data))
    except ValidationError as error:
        faults = {_fault(document, details) for details in error.errors(include_url=False)}
        raise StepgenError(sorted(faults, key=lambda fault: (fault.position, fault))) from None


def _in_yaml(location: Location, document: Document) -> Location:
    """
    Return *location* without the parts that a short form leaves out.

    ``motors.pan.timing.timer`` stands in the YAML as ``motors.pan.timer`` when the user took
    the short form; the part in between is dropped when the YAML has no such mapping.
    """
    node: object = document.data
    kept: list[str | int] = []
    for index, step in enumerate(location):
        if not _has(node, step):
            continue
        following = node[step]
        short = [name for name in location[index + 1 :] if name in SHORT_FORMS]
        if any(_has(node, name) and not _has(following, name) for name in short):
            continue
        kept.append(step)
        node = following
    return kept


def _has(node: object, step: str | int) -> TypeGuard[Any]:
    if isinstance(node, list):
        return isinstance(step, int) and step < len(node)
    return isinstance(node, dict) and step in node


def _fault(document: Document, details: ErrorDetails) -> Fault:
    place, text = document.place(_in_yaml(details["loc"], document))
    return Fault(place, text, _reason(details))


def _reason(details: ErrorDetails) -> str:
    """
    Return what is wrong and the way out, from the table for the kind of fault and its field.
    """
    kind = details["type"]
    names = [part for part in details["loc"] if isinstance(part, str)]
    field = names[-1] if names else "the spec"
    is_entry = names != list(details["loc"])
    message = details["msg"][:1].lower() + details["msg"][1:]
    reason = None
    if is_entry:
        reason = _FIELD_REASONS.get((f"{kind}[]", field)) or _ENTRY_REASONS.get(kind)
    reason = reason or _FIELD_REASONS.get((kind, field)) or _REASONS.get(kind, "{field}: {message}")
    text = reason.format(field=field, message=message, **details.get("ctx", {}))
    return " ".join(text.split())  # a name may hold line ends, and a fault is one line

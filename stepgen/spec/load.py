"""
From a YAML file to a Spec, with every fault at its line.
"""

from dataclasses import dataclass
from pathlib import Path

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from stepgen.errors import Fault, StepgenError
from stepgen.spec.document import Document, Location, read_document
from stepgen.spec.model import Spec


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
    document = read_document(path)
    try:
        spec = Spec.model_validate(dict(document.data))
    except ValidationError as error:
        faults = {_fault(document, details) for details in error.errors(include_url=False)}
        raise StepgenError(sorted(faults, key=lambda fault: fault.position)) from None
    return LoadedSpec(spec, document)


def _in_yaml(location: Location, document: Document) -> Location:
    """
    Return *location* without the parts that a short form leaves out.

    ``motors.pan.timing.timer`` stands in the YAML as ``motors.pan.timer`` when the user took
    the short form; the part in between is dropped when the YAML has no such mapping.
    """
    node: object = document.data
    kept: list[str | int] = []
    for step in location:
        if isinstance(node, dict) and step not in node:
            continue
        if isinstance(node, dict) or (
            isinstance(node, list) and isinstance(step, int) and step < len(node)
        ):
            following = node[step]
        else:
            continue
        is_short = isinstance(following, str) and step != location[-1] and isinstance(node, dict)
        if is_short and location[-1] in node:
            continue
        kept.append(step)
        node = following
    return kept


def _fault(document: Document, details: ErrorDetails) -> Fault:
    place, text = document.place(_in_yaml(details["loc"], document))
    return Fault(place, text, _reason(details))


def _reason(details: ErrorDetails) -> str:
    field = details["loc"][-1] if details["loc"] else "the spec"
    context = details.get("ctx", {})
    match details["type"]:
        case "missing" | "too_short" if isinstance(field, int) or field == "pins":
            return "has too few entries; give one for each wire"
        case "too_long":
            return "has too many entries; give one for each wire"
        case "missing":
            return f"{field} is missing; add `{field}: ...`"
        case "extra_forbidden":
            return f"{field} is no field of this part of a spec; remove it or correct its name"
        case "value_error":
            return str(context["error"])
        case "literal_error" | "enum":
            return f"is not possible for {field}; write {context['expected']}"
        case "union_tag_invalid":
            return f'"{context["tag"]}" is unknown; choose one of {context["expected_tags"]}'
        case "union_tag_not_found":
            return "has no kind; add `kind: ...`"
        case "string_pattern_mismatch" if field == "version":
            return "is no version; write three numbers in quotes, such as 1.0.0"
        case "string_pattern_mismatch":
            return f"{field} must be one line of text without control characters"
        case _:
            return f"{field}: {details['msg'][0].lower()}{details['msg'][1:]}"

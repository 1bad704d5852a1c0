"""
The JSON Schema of a spec, with which editors complete and check what is written.
"""

from fractions import Fraction
from typing import Any

from pydantic.json_schema import GenerateJsonSchema

from stepgen.devices import SKETCH_LIBRARIES, boards
from stepgen.spec import Spec
from stepgen.spec.model import SHORT_FORMS
from stepgen.spec.quantities import Quantity

DRAFT = "https://json-schema.org/draft/2020-12/schema"


def json_schema() -> dict[str, Any]:
    """
    Return the schema of a spec as a user may write it, short forms included.

    It tells shape and names: every valid spec fits it. Whether a pin is free and a timer
    exists, only `stepgen check` says.
    """
    schema = _untitled(Spec.model_json_schema(schema_generator=_Schema))
    _allow_short_forms(schema["$defs"])
    fields = schema["properties"]
    fields["board"] |= {"enum": [board.name for board in boards()]}
    libraries = (*SKETCH_LIBRARIES, "analogWrite")
    fields["uses"]["items"] |= {
        "examples": [*SKETCH_LIBRARIES, "analogWrite D5"],
        "pattern": f"^({'|'.join(libraries)})( .+)?$",
    }
    return {"$schema": DRAFT, "title": "stepgen spec", **schema}


def _allow_short_forms(parts: dict[str, Any]) -> None:
    """
    Let each field of `SHORT_FORMS` stand in the motor too, and be missing where it belongs.
    """
    motor = parts["Motor"]["properties"]
    for part in parts.values():
        for name in part["properties"].keys() & SHORT_FORMS.keys():
            motor.setdefault(name, part["properties"][name])
        part["required"] = [name for name in part.get("required", ()) if name not in SHORT_FORMS]


class _Schema(GenerateJsonSchema):
    """
    Writes a default that is a fraction or a quantity as users do: as text.
    """

    def encode_default(self, dft: Any) -> Any:  # noqa: ANN401 - any default
        return super().encode_default(str(dft) if isinstance(dft, Fraction | Quantity) else dft)


def _untitled(node: Any) -> Any:  # noqa: ANN401 - any JSON
    """
    Return *node* without the titles that pydantic makes of the fields' names.
    """
    if isinstance(node, list):
        return [_untitled(one) for one in node]
    if not isinstance(node, dict):
        return node
    named = isinstance(node.get("title"), str)
    return {key: _untitled(one) for key, one in node.items() if key != "title" or not named}

"""
The JSON Schema: what a user may write fits it, and what it is for stands beside each field.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator
from ruamel.yaml import YAML

from stepgen import api
from stepgen.spec import Spec
from stepgen.spec.base import SpecModel

ROOT = Path(__file__).resolve().parents[2]
SPECS = sorted((ROOT / "specs").glob("*.yaml"))
# Refused for their shape, which is what a schema tells.
MISSHAPEN = (
    "field_unknown",
    "drive_missing",
    "drive_unknown",
    "board_unknown",
    "library_unknown",
    "motors_empty",
    "pins_too_few",
    "pins_too_many",
    "sequence_unknown",
    "timer_is_a_word",
    "list",
    "version_bad",
    "url_of_a_file",
)


def data_of(path: Path) -> Any:  # noqa: ANN401 - any YAML
    """
    Return what the YAML file *path* holds.
    """
    return YAML(typ="safe", pure=True).load(path.read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def validator() -> Draft202012Validator:
    """
    Return what judges by the schema, which must be one itself.
    """
    schema = api.schema()
    Draft202012Validator.check_schema(schema)
    return Draft202012Validator(schema)


@pytest.mark.parametrize("path", SPECS, ids=lambda path: path.stem)
def test_every_valid_spec_fits(path: Path, validator: Draft202012Validator) -> None:
    """
    An editor underlines nothing in a spec that is fine.
    """
    assert [error.message for error in validator.iter_errors(data_of(path))] == []


@pytest.mark.parametrize("name", MISSHAPEN)
def test_a_misshapen_spec_does_not_fit(name: str, validator: Draft202012Validator) -> None:
    """
    An editor underlines what `stepgen check` would refuse for its shape.
    """
    data = data_of(ROOT / "specs" / "refused" / f"{name}.yaml")

    assert not validator.is_valid(data)


def test_the_short_form_may_leave_the_kind_in_the_drive(validator: Draft202012Validator) -> None:
    """
    Pins right in the motor, and the rest of the drive in a mapping.
    """
    drive = {"kind": "four-wire", "sequence": "half"}
    motor = {"drive": drive, "pins": [4, "D5", "D6", "D7"], "timer": 1}

    assert validator.is_valid({"library": "Fan", "board": "uno", "motors": {"fan": motor}})


def _models(model: type[SpecModel]) -> set[type[SpecModel]]:
    below = {model}
    for one in model.__subclasses__():
        below |= _models(one)
    return below


def test_every_field_says_what_it_is_for() -> None:
    """
    The text below each field of a model is its description, for the editor and the schema.
    """
    silent = [
        f"{model.__name__}.{name}"
        for model in _models(SpecModel)
        if model.__module__.startswith(Spec.__module__.rpartition(".")[0])
        for name, field in model.model_fields.items()
        if name != "kind" and not field.description
    ]

    assert silent == []


def _with_defaults(schema: Any) -> Iterator[dict[str, Any]]:  # noqa: ANN401 - any JSON
    for part in schema.values() if isinstance(schema, dict) else schema:
        if isinstance(part, dict | list):
            yield from _with_defaults(part)
    if isinstance(schema, dict) and "default" in schema:
        yield schema


def test_every_default_may_be_written() -> None:
    """
    What the schema names as the default of a field fits that field: an editor may fill it in.
    """
    schema = api.schema()
    found = list(_with_defaults(schema))

    assert len(found) > 20
    for part in found:
        validator = Draft202012Validator(part | {"$defs": schema["$defs"]})
        assert validator.is_valid(part["default"]), part

"""
Step sequences as the user writes them: a name, or an own table of patterns.
"""

import re
from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, Discriminator, Field, Tag, model_validator

from stepgen.spec.base import SpecModel, short_form

NamedSequence = Literal["full", "wave", "half"]
MINIMUM_PATTERNS = 3  # with two, a step forward and a step back are the same
MAXIMUM_PATTERNS = 32
_PATTERN = re.compile(r"[01]{4}")


def _wire_pattern(value: Any) -> str:  # noqa: ANN401 - whatever the YAML held
    if not isinstance(value, str) or not _PATTERN.fullmatch(value):
        raise ValueError(
            "is no pattern; write four characters 0 or 1 in quotes, one for each pin, "
            'such as "1010"'
        )
    return value


WirePattern = Annotated[str, BeforeValidator(_wire_pattern)]
"""What four wires show, as text such as ``1010``."""


class PatternTable(SpecModel):
    """
    An own table: what the wires show in each phase, as text such as ``1010``.

    The characters stand for the wires in the order of the drive's pins; 1 is HIGH.
    """

    patterns: Annotated[tuple[WirePattern, ...], Field(strict=False)]
    """What the wires show in each phase, such as "1010"."""

    @model_validator(mode="after")
    def _patterns_are_wires(self) -> Self:
        count = len(self.patterns)
        if not MINIMUM_PATTERNS <= count <= MAXIMUM_PATTERNS:
            raise ValueError(
                f"has {count} patterns; write a table of {MINIMUM_PATTERNS} to {MAXIMUM_PATTERNS}"
            )
        following = (*self.patterns[1:], self.patterns[0])
        if any(one == two for one, two in zip(self.patterns, following, strict=True)):
            raise ValueError(
                "two neighbouring patterns are equal (the last one's neighbour is the first), "
                "so that step would not move the motor; remove one of them"
            )
        return self


def _as_table(value: Any) -> Any:  # noqa: ANN401 - whatever the YAML held
    return {"patterns": value} if isinstance(value, list) else value


def _form(value: Any) -> str:  # noqa: ANN401 - whatever the YAML held
    return "patterns" if isinstance(value, list | dict | PatternTable) else "sequence"


Sequence = Annotated[
    Annotated[NamedSequence, Tag("sequence")]
    | Annotated[PatternTable, short_form(_as_table, PatternTable | list[str]), Tag("patterns")],
    Discriminator(_form),
]

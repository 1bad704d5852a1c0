"""
Step sequences as the user writes them: a name, or an own table of patterns.
"""

from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, model_validator

from stepgen.spec.base import SpecModel

NamedSequence = Literal["full", "wave", "half"]
MINIMUM_PATTERNS = 3  # with two, a step forward and a step back are the same
MAXIMUM_PATTERNS = 32


class PatternTable(SpecModel):
    """
    An own table: what the wires show in each phase, as text such as ``1010``.

    The characters stand for the wires in the order of the drive's pins; 1 is HIGH.
    """

    patterns: tuple[str, ...]

    @model_validator(mode="after")
    def _patterns_are_wires(self) -> Self:
        count = len(self.patterns)
        if not MINIMUM_PATTERNS <= count <= MAXIMUM_PATTERNS:
            raise ValueError(
                f"{count} patterns; a table has {MINIMUM_PATTERNS} to {MAXIMUM_PATTERNS}"
            )
        wrong = [text for text in self.patterns if not _is_pattern(text)]
        if wrong:
            raise ValueError(
                f'"{wrong[0]}" is no pattern; write four characters 0 or 1 in quotes, '
                'one for each pin, such as "1010"'
            )
        following = (*self.patterns[1:], self.patterns[0])
        if any(one == two for one, two in zip(self.patterns, following, strict=True)):
            raise ValueError(
                "two neighbouring patterns are equal (the last one's neighbour is the first), "
                "so that step would not move the motor; remove one of them"
            )
        return self


def _is_pattern(text: str) -> bool:
    return len(text) == 4 and set(text) <= {"0", "1"}  # noqa: PLR2004 - four wires


def _as_table(value: Any) -> Any:  # noqa: ANN401 - whatever the YAML held
    return {"patterns": tuple(value)} if isinstance(value, list) else value


Sequence = NamedSequence | Annotated[PatternTable, BeforeValidator(_as_table)]

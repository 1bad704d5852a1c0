"""
Pins as people know them: D12, 12, A8 or PB4.
"""

import re
from typing import Annotated, Any

from stepgen.spec.base import short_form

_PIN = re.compile(r"D?\d{1,3}|A\d{1,2}|P[A-L][0-7]", re.IGNORECASE | re.ASCII)


def _pin_name(value: Any) -> str:  # noqa: ANN401 - whatever the YAML held
    if isinstance(value, bool) or not isinstance(value, int | str):
        raise ValueError("is no pin; write it as D12, A8 or PB4")  # noqa: TRY004 - for pydantic
    text = str(value)
    if not _PIN.fullmatch(text):
        raise ValueError("is no pin; write it as D12, A8 or PB4")
    return f"D{text}" if text.isdigit() else text.upper()


PinName = Annotated[str, short_form(_pin_name, str | int)]
"""A pin's name, upper-case, with D before a bare number. Whether it exists, the board says."""

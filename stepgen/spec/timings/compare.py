"""
Compare: the 8-bit timer 2 runs through, and a compare channel counts its laps between two steps.
"""

from typing import Literal

from stepgen.spec.base import KindModel


class Compare(KindModel):
    """
    Timing ``compare``: the 8-bit timer 2 for one motor; ``timer`` may say so.
    """

    kind: Literal["compare"] = "compare"
    timer: int | None = None
    """2, the only 8-bit timer that there is."""


SPEC = Compare

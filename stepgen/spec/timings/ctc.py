"""
CTC, mode 4: a 16-bit timer that starts again at OCRnA, and whose compare match makes the steps.
"""

from typing import Literal

from stepgen.spec.base import KindModel


class Ctc(KindModel):
    """
    Timing ``ctc``: one 16-bit timer for one motor; without ``timer`` a free one is taken.
    """

    kind: Literal["ctc"] = "ctc"
    timer: int | None = None
    """The number of a 16-bit timer; without it the first free one is taken."""


SPEC = Ctc

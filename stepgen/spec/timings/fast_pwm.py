"""
Fast PWM, mode 15: a 16-bit timer whose TOP is OCRnA and whose overflow makes the steps.
"""

from typing import Literal

from stepgen.spec.base import KindModel


class FastPwm(KindModel):
    """
    Timing ``fast-pwm``: one 16-bit timer for one motor; without ``timer`` a free one is taken.
    """

    kind: Literal["fast-pwm"] = "fast-pwm"
    timer: int | None = None
    """The number of a 16-bit timer; without it the first free one is taken."""


SPEC = FastPwm

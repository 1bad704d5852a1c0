"""
Constant speed: each call of the speed function sets one speed until the next.
"""

from typing import Literal

from stepgen.spec.base import KindModel


class Constant(KindModel):
    """
    Motion ``constant``: one speed, an end point in steps or milliseconds or none.
    """

    kind: Literal["constant"] = "constant"


SPEC = Constant

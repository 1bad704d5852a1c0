"""
The Arduino Motor Shield (R3): an L298 on fixed pins.
"""

from typing import Literal

from stepgen.spec.base import KindModel
from stepgen.spec.sequence import NamedSequence


class MotorShield(KindModel):
    """
    Drive ``motor-shield``: PWM A D3, PWM B D11, DIR A D12, DIR B D13, brakes D9 and D8.
    """

    kind: Literal["motor-shield"] = "motor-shield"
    sequence: NamedSequence = "full"


SPEC = MotorShield

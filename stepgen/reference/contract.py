"""
The bits and codes of the contract (systems/1-motor-driver.md), and which motion has which.
"""

from enum import IntEnum, IntFlag
from typing import Literal

MotionKind = Literal["constant", "update-events", "trapezoid"]
TimingKind = Literal["fast-pwm", "ctc", "compare", "wide-compare"]


class Control(IntFlag):
    """
    The control bits; `CONTROL_BITS` says which of them the library of a motion has.
    """

    DRV_EN = 0x80
    SPEED_VARIABLE = 0x40
    VARIABLE_PWR = 0x20
    IRQ_TIMING = 0x10
    UPDATE_STEPS = 0x08
    ENDPOINT_MILLIS = 0x04
    FASTER = 0x02
    DIRECTION = 0x01


ALL_CONTROL_BITS = 0xFF
CONTROL_BITS: dict[MotionKind, int] = {
    "constant": Control.DRV_EN | Control.ENDPOINT_MILLIS | Control.DIRECTION,
    "update-events": ALL_CONTROL_BITS,
    "trapezoid": 0,
}


class Status(IntFlag):
    """
    The status bits; without a registered callback those with CALLED are never set.
    """

    FAULT = 0x01
    FAULT_CALLED = 0x02
    TIMER_DIV_ERROR = 0x04
    TIMER_DIV_CALLED = 0x08
    REACHED = 0x10
    REACH_CALLED = 0x20
    SPIN_FIXED = 0x40
    MISSED = 0x80


class Code(IntEnum):
    """
    What a call returns: below 0 refused, above 0 a warning.
    """

    FINE = 0
    NOT_DRIVEN = 1
    TOO_FAST = -1
    TOO_SLOW = -2
    CONTROL = -3
    UPDATE = -4
    RUNNING = -5
    QUEUE_FULL = -6
    RANGE = -7
    HOMING = -8
    FAULT = -9

"""
What a point of the conformance suite is.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from stepgen.verify.conformance.lab import Lab

Judge = Callable[[Lab], Iterator[str]]
"""Yields what differs from the chip; nothing where the point is met."""

UNO_CHIP, USB_CHIP = "atmega328p", "atmega32u4"
MEGA_1280_CHIP, MEGA_CHIP = "atmega1280", "atmega2560"


@dataclass(frozen=True)
class Point:
    """
    One demand.

    Args:
        name: How `needs` and the corrections of a simulator call it.
        demand: What the chip does, in a few words.
        source: Section of the datasheet of the ATmega328P (DS40002061), of the ATmega2560's
            (DS40002211) where *mcu* is that or its sister, or what else it names.
        mcu: The chip it is tried on.
        judge: Tries it.
    """

    name: str
    demand: str
    source: str
    mcu: str
    judge: Judge


def point(name: str, demand: str, source: str, mcu: str = UNO_CHIP) -> Callable[[Judge], Point]:
    """
    Make the function below it the judge of a point.
    """
    return lambda judge: Point(name, demand, source, mcu, judge)

"""
The one error type of stepgen: where in the spec, what is wrong, what to do about it.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Self


@dataclass(frozen=True, order=True)
class Fault:
    """
    One thing that is wrong, with its place and a way out.

    Args:
        place: ``file:line:column`` of the offending text, or just a file, or "".
        text: The offending text as the user wrote it, or "".
        reason: What is wrong and how to mend it, one sentence or two.
    """

    place: str
    text: str
    reason: str

    @property
    def position(self) -> tuple[int, ...]:
        """
        Return line and column, for reports in the order of the file; empty without a place.
        """
        return tuple(int(part) for part in self.place.split(":")[-2:] if part.isdigit())

    def __str__(self) -> str:
        """
        Return the fault as one line of a compiler-like report.
        """
        shown = f"{self.text}: " if self.text else ""
        where = f"{self.place}: " if self.place else ""
        return f"{where}error: {shown}{self.reason}"


class StepgenError(Exception):
    """
    Everything a user can mend: carries all the faults that were found, not just the first.
    """

    def __init__(self, faults: Iterable[Fault]) -> None:
        self.faults = tuple(faults)
        super().__init__("\n".join(str(fault) for fault in self.faults))

    @classmethod
    def of(cls, reason: str, *, place: str = "", text: str = "") -> Self:
        """
        Return an error with a single fault.
        """
        return cls([Fault(place, text, reason)])

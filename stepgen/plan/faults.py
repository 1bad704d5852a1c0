"""
Collecting the faults that the planner finds, so that all are reported together.
"""

from dataclasses import dataclass, field

from stepgen.errors import Fault, StepgenError
from stepgen.spec import LoadedSpec
from stepgen.spec.document import Location


@dataclass(frozen=True)
class Faults:
    """
    A list of faults to which every part of the planner adds, relative to its own place.
    """

    loaded: LoadedSpec
    location: Location = ()
    found: list[Fault] = field(default_factory=list)

    def at(self, *steps: str | int) -> "Faults":
        """
        Return the same list, with *steps* added to the place of what is reported.
        """
        return Faults(self.loaded, (*self.location, *steps), self.found)

    def report(self, reason: str) -> None:
        """
        Add a fault at this place.
        """
        self.found.append(self.loaded.fault(self.location, reason))

    def raise_if_any(self) -> None:
        """
        Raise all faults found so far, in the order of the spec's lines.

        Raises:
            StepgenError: There is at least one.
        """
        if self.found:
            raise StepgenError(sorted(set(self.found), key=lambda fault: (fault.position, fault)))

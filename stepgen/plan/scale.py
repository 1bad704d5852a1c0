"""
From the units of a spec to steps.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

from stepgen.plan.faults import Faults
from stepgen.spec.quantities import Quantity


@dataclass(frozen=True)
class Scale:
    """
    How many steps each unit is that the spec of a motor allows.
    """

    per_unit: Mapping[str, Fraction]

    def steps(self, quantity: Quantity, faults: Faults) -> Fraction | None:
        """
        Return *quantity* in steps; None after reporting that nothing says how many that is.
        """
        if quantity.unit in self.per_unit:
            return quantity.number * self.per_unit[quantity.unit]
        needed = "steps_per_mm" if quantity.unit == "mm" else "steps_per_turn"
        faults.report(
            f"how many steps that is, nothing says; add `{needed}` to the motor, or write steps"
        )
        return None

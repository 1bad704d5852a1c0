"""
One way through a function, and what is asked of many of them.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import z3

from stepgen.reference.contract import MotionKind
from stepgen.reference.facts import MotorFacts
from stepgen.reference.sequences import Pattern
from stepgen.reference.timer import SLOWEST_CYCLES, TimerSetting
from stepgen.verify.proof.library import Chosen, Library
from stepgen.verify.proof.machine import Machine
from stepgen.verify.proof.memory import CLOCK
from stepgen.verify.proof.numbers import Number, wide
from stepgen.verify.proof.paths import Paths
from stepgen.verify.proof.state import (
    REVERSE,
    State,
)

NO_STEP = z3.BitVecVal(0, 32)


@dataclass(frozen=True)
class Way:
    """
    One way through a function: what was before, what is after, and what it returns.
    """

    library: Library
    paths: Paths
    machine: Machine
    chosen: Chosen
    before: State
    after: State
    arguments: list[Any]
    result: Any

    def number(self, value: Any) -> Any:  # noqa: ANN401 - z3 has no types; mypy takes it for an int
        """
        Return the unsigned *value* for the model.
        """
        return Number(wide(value), self.paths)

    @property
    def facts(self) -> MotorFacts:
        """
        Return what the model is told; the choice of a setting is proven by itself.
        """
        motion: MotionKind = "update-events" if self.before.has("eventAt") else "constant"
        slowest = max(SLOWEST_CYCLES, self.library.max_top)
        return _Unset(
            (), Pattern((), ()), self.library.min_top, "hold", motion, slowest_cycles=slowest
        )

    @property
    def next_is_chosen(self) -> Any:  # noqa: ANN401
        """
        Tell whether the next interval is what is chosen for the virtual TOP of a call or an event.
        """
        top = self.after.of("top") if self.after.has("top") else self.arguments[1]
        same = [
            self.after.of("next", *part) == value for part, value in self.chosen.of(top).items()
        ]
        taken_over = (
            [self.after.of("next", "select") == 0] if self.after.has("next", "select") else []
        )
        return z3.Or(z3.And(*same), *taken_over)


class _Unset(MotorFacts):
    def setting(self, virtual_cycles: int) -> TimerSetting:
        del virtual_cycles
        return TimerSetting(1, 1)


def millis_left(state: State) -> Any:  # noqa: ANN401 - z3 has no types
    """
    Return the milliseconds until the limit of a variable motion, 0 or less after it.
    """
    elapsed = wide(state.values[CLOCK] - state.of("start"))  # the model's: modulo 2**32
    return wide(state.of("limit")) - elapsed


def position(way: Way, made: Any) -> Iterator[tuple[str, Any]]:  # noqa: ANN401
    """
    Yield that the position and what is left say that the steps *made*, 32 bits, were made.
    """
    before, after = way.before, way.after
    goes = z3.If(before.is_in(REVERSE), -made, made)
    yield (
        "the position changes by the steps that are made",
        after.position == before.position + goes,
    )
    fits = z3.And(before.steps_counted, after.steps_counted)
    yield "what is left is as much less", z3.Implies(fits, after.left == before.left - wide(made))


def same_but_status(way: Way) -> Any:  # noqa: ANN401
    """
    Tell whether all of the motor is as it was, but its status bits.
    """
    own = f"{way.before.motor}Motion"
    places = [place for place in way.before.values if place[0] == own and place[1] != "status"]
    same = [way.after.values[place] == way.before.values[place] for place in places]
    return z3.And(*same, way.after.count == way.before.count)


def low_millis(state: State) -> Any:  # noqa: ANN401
    """
    Return the lower 16 bits of the milliseconds.
    """
    return z3.Extract(15, 0, state.values[CLOCK])

"""
Following all ways through code whose values are unknown, one after the other.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import z3

_TACTICS = (
    *("simplify", "propagate-values", "solve-eqs", "elim-uncnstr", "simplify"),
    *("ackermannize_bv", "simplify", "bit-blast", "sat"),
)


_AT_ONCE = 8
"""So many claims are asked about at once: faster than one by one, and than all together."""


@dataclass(frozen=True)
class Violation:
    """
    A claim that does not hold, where, and values of the inputs with which it does not.
    """

    claim: str
    where: str
    example: str

    def __str__(self) -> str:
        return f"{self.where}: {self.claim}; for {self.example}"


class Paths:
    """
    The ways through a piece of code; each run of it takes one.

    The code is run again for each way, and asks `decide` at each fork. It must do the same each
    time it decides the same. What it claims on a way is proven at the end of the way. Where it
    `learns`, some of that is asked at once, and what is proven is known to the proofs after it:
    that helps where each follows from the one before.
    """

    def __init__(self) -> None:
        self.violations: list[Violation] = []
        self.inputs: dict[str, Any] = {}
        self.proven = 0
        self.possible = False
        self.learns = False
        self._solver = z3.Solver()
        self._claims: list[tuple[Any, str, str]] = []
        self._taken: list[bool] = []
        self._prefix: list[bool] = []
        self._waiting: list[list[bool]] = []

    def runs(self, body: Callable[[], None]) -> Iterator[None]:
        """
        Run *body* once for each way through it, and yield after each.
        """
        self._waiting = [[]]
        while self._waiting:
            self._prefix, self._taken, self._claims = self._waiting.pop(), [], []
            self._solver = z3.Solver()
            body()
            self._prove()
            yield

    @property
    def taken(self) -> tuple[bool, ...]:
        """
        Return what was decided on this way so far.
        """
        return tuple(self._taken)

    def assume(self, condition: Any) -> None:  # noqa: ANN401 - z3 has no types
        """
        Take *condition* for granted from here on.
        """
        self._solver.add(condition)

    def decide(self, condition: Any) -> bool:  # noqa: ANN401
        """
        Return whether *condition* holds on this way; where both can be, each has its run.
        """
        condition = z3.simplify(condition)
        if z3.is_true(condition) or z3.is_false(condition):
            return bool(z3.is_true(condition))
        if len(self._taken) < len(self._prefix):
            answer = self._prefix[len(self._taken)]
        elif not self._possible(condition):
            answer = False
        else:
            answer = True
            if self._possible(z3.Not(condition)):
                self._waiting.append([*self._taken, False])
        self._taken.append(answer)
        self._solver.add(condition if answer else z3.Not(condition))
        return answer

    def prove(self, claim: Any, says: str, where: str) -> None:  # noqa: ANN401
        """
        Demand that *claim* holds on this way.
        """
        self._claims.append((z3.simplify(claim), says, where))

    def _prove(self) -> None:
        """
        Show that all claims of this way hold, or note those that do not as violations.
        """
        self.proven += len(self._claims)
        self.possible = self.possible or self._possible_anew(z3.BoolVal(val=True))
        claims = [one for one in self._claims if not z3.is_true(one[0])]
        size = _AT_ONCE if self.learns else 1
        for first in range(0, len(claims), size):
            self._prove_some(claims[first : first + size])

    def _prove_some(self, claims: list[tuple[Any, str, str]]) -> None:
        if not self._possible_anew(z3.Not(z3.And(*(claim for claim, _, _ in claims)))):
            self._learn(*(claim for claim, _, _ in claims))
            return
        for claim, says, where in claims:
            if self._possible_anew(z3.Not(claim)):
                self.violations.append(Violation(says, where, self._example(z3.Not(claim))))
            else:
                self._learn(claim)

    def _learn(self, *claims: Any) -> None:  # noqa: ANN401
        if self.learns:
            self._solver.add(*claims)

    def _example(self, condition: Any) -> str:  # noqa: ANN401
        self._solver.push()
        self._solver.add(condition)
        self._solver.check()
        model = self._solver.model()
        self._solver.pop()
        values = {name: model[value.decl()] for name, value in self.inputs.items()}
        return ", ".join(f"{name} = {value}" for name, value in values.items() if value is not None)

    def _possible_anew(self, condition: Any) -> bool:  # noqa: ANN401
        """
        Tell whether *condition* can hold; where it `learns`, by a solver that knows nothing yet.

        All that z3 does beforehand for one question alone is worth far more there than what it
        remembers of the questions before.
        """
        if not self.learns:
            return self._possible(condition)
        solver = z3.Then(*_TACTICS).solver()
        solver.add(*self._solver.assertions(), condition)
        answer = solver.check()
        if answer == z3.unknown:
            raise RuntimeError("z3 cannot tell")
        return bool(answer == z3.sat)

    def _possible(self, condition: Any) -> bool:  # noqa: ANN401
        self._solver.push()
        self._solver.add(condition)
        answer = self._solver.check()
        self._solver.pop()
        if answer == z3.unknown:
            raise RuntimeError("z3 cannot tell")
        return bool(answer == z3.sat)

"""
Proves the arithmetic of a library: every function that a sketch or an interrupt can call.
"""

import time
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import Any

import z3

from stepgen.verify.proof.axis_run import AxisRun, axis_entries
from stepgen.verify.proof.claims import CLAIMS, POSITION_READ, choice, is_way, steps_of
from stepgen.verify.proof.integers import U16, integer
from stepgen.verify.proof.library import Chosen, Library
from stepgen.verify.proof.machine import Machine
from stepgen.verify.proof.memory import GENERAL_PURPOSE, Place
from stepgen.verify.proof.paths import Paths, Violation
from stepgen.verify.proof.state import CLOCKED, COAST, RUNNING, State, assumed, invariant
from stepgen.verify.proof.way import Way

_PENDING = ("Update", "UntilEvent")  # only called while events are left


@dataclass
class Proof:
    """
    What was proven of one function, and what could not be.

    Args:
        function: Its name.
        ways: The ways through it.
        proven: The claims that were proven on them, those of single operations included.
        seconds: CPU time.
        violations: The claims that do not hold.
        meant: The lines that lost bits and may.
    """

    function: str
    ways: int = 0
    proven: int = 0
    seconds: float = 0
    violations: list[Violation] = field(default_factory=list)
    meant: set[str] = field(default_factory=set)


def prove_library(library: Library, only: Iterable[str] = ()) -> list[Proof]:
    """
    Return the proofs of all functions of *library*, or of those that are named *only*.
    """
    wanted = set(only)
    pairs = [(name, motor) for motor in library.source.motors for name in entries(library, motor)]
    pairs += [(name, "") for name in shared(library)]
    return [_prove(library, name, motor) for name, motor in pairs if not wanted or name in wanted]


def entries(library: Library, motor: str) -> list[str]:
    """
    Return the functions by which a sketch or an interrupt gets at *motor*, and parts of them.
    """
    if motor in library.axes:
        return axis_entries(library, motor)
    names = [f"__vector_{motor}_{name}" if name == "boundary" else motor + name for name in CLAIMS]
    return [name for name in names if name in library.functions]


def shared(library: Library) -> list[str]:
    """
    Return the functions that have no motor's state.
    """
    speeds = [
        name
        for motor in library.steps_per_mm
        for kind in ("TimerCalc", "IntervalFor")
        if (name := f"{motor}{kind}NanometresPerSecond") in library.functions
    ]
    steps = [f"proof{name}" for name in library.units]
    rates = [name for name in ("motorTimerCalcPerSecond",) if name in library.functions]
    return [*library.chooses, *rates, *speeds, *steps]


def _prove(library: Library, name: str, motor: str) -> Proof:
    proof, paths = Proof(name), Paths()
    started = time.process_time()
    kind = AxisRun if motor in library.axes else _Run
    run = kind(library, name, motor, paths, proof.meant)
    proof.ways = sum(1 for _ in paths.runs(run.once))
    proof.seconds = time.process_time() - started
    proof.proven, proof.violations = paths.proven, paths.violations
    if not paths.possible:
        proof.violations.append(Violation("what is assumed can be", name, "nothing"))
    return proof


class _KnownFromHereError(Exception):
    """
    What follows was proven on another way.
    """


@dataclass
class _Run:
    library: Library
    name: str
    motor: str
    paths: Paths
    meant: set[str]
    _onward: tuple[bool, ...] | None = None

    def once(self) -> None:
        """
        Take one way through the function.
        """
        function = self.library.functions[self.name]
        self._machine = Machine(self.library.source, self.library.functions, self.paths)
        self._machine.used = self.meant
        arguments = [
            z3.BitVec(name, (integer(function.types[name]) or U16).bits)
            for name in function.parameters
        ]
        known = self._machine.memory.snapshot()
        self.paths.inputs = {".".join(place): value for place, value in known.items()}
        self.paths.inputs |= {str(argument): argument for argument in arguments}
        if self.motor:
            self._with_motor(arguments)
        else:
            self._alone(arguments)

    def _alone(self, arguments: list[Any]) -> None:
        choose = self.name in self.library.chooses
        if choose:
            (period,) = arguments
            self.paths.assume(z3.UGE(period, self.library.min_top))
            self.paths.assume(z3.ULE(period, self.library.max_top))
        motor = self.name.removeprefix("proof").removesuffix("StepsForMicrometres")
        per_mm, signed = self.library.steps_per_mm.get(motor), motor in self.library.axes
        if per_mm is not None:
            self.paths.assume(is_way(arguments[0], per_mm, signed=signed))
        result = self._machine.call(self.name, *arguments)
        if per_mm is not None:
            rounded = steps_of(arguments[0], result, per_mm, signed=signed)
            self._show("the steps are the way's, rounded", rounded)
        if choose:
            for says, claim in choice(self.library, self.paths, arguments[0], result):
                self._show(says, claim)

    def _with_motor(self, arguments: list[Any]) -> None:
        machine, kind = self._machine, self.name.removeprefix(self.motor).rpartition("_")[2]
        choose = self.library.chooses_for(self.motor)
        chosen = Chosen(self.library, choose, self.paths)
        machine.known = {choose: chosen}
        machine.masked, machine.unmasked = self._masked, self._keeps
        if kind != "Update":
            machine.known[f"{self.motor}Update"] = self._updated
        if kind == "ReadNanometres":
            machine.known[f"{self.motor}ReadPosition"] = lambda: POSITION_READ
        self._sections = 0
        self._before = self._state()
        if kind == "boundary":
            self._before = self._interrupted(self._before)
        if kind.endswith("Init"):
            self._from_reset()
        else:
            self._assume(self._before)
        if kind in _PENDING:
            pending = z3.And(self._before.is_in(RUNNING), self._before.of("updates") != 0)
            self.paths.assume(pending)
        if kind == "Update":
            self.paths.assume(self._before.to_event <= 0)
        try:
            result = machine.call(self.name, *arguments)
        except _KnownFromHereError:
            return
        after = self._keeps()
        way = Way(self.library, self.paths, machine, chosen, self._before, after, arguments, result)
        for says, claim in CLAIMS[kind](way):
            self._show(says, claim)

    def _state(self) -> State:
        library, values = self.library, self._machine.memory.snapshot()
        return State(values, library.source, self.motor, library.min_top, library.max_top)

    def _assume(self, state: State) -> None:
        for claim in [*invariant(state).values(), *assumed(state).values()]:
            self.paths.assume(claim)

    def _interrupted(self, entered: State) -> State:
        """
        Return what was before the step interrupt that goes on to its rare ways as *entered*.
        """
        count, place = entered.count, entered.count_place
        looks = z3.And(entered.is_in(CLOCKED), _by_the_clock(entered))
        self.paths.assume(z3.Or(count == 0, looks))
        self.paths.assume(z3.Or(entered.is_in(RUNNING), entered.is_in(COAST)))
        if entered.is_timed:  # each step has looked, and what it looks for is proven to be no later
            runs = z3.And(entered.is_in(RUNNING), count == 0)
            self.paths.assume(z3.Implies(runs, entered.patience > 0))
        values = {**entered.values, place: z3.If(count == 0, z3.BitVecVal(1, 8), count)}
        return replace(entered, values=values, entered_count=count)

    def _from_reset(self) -> None:
        """
        Show that the invariant holds after reset, where RAM is 0; of registers nothing is known.
        """
        before, registers = self._before, set(GENERAL_PURPOSE.values())
        zeros = {place: value & 0 for place, value in before.values.items()}
        for says, claim in invariant(replace(before, values=zeros)).items():
            self.paths.prove(claim, says, "after reset")
        others = {
            place: z3.BitVec("at reset", 8) if place[0] in registers else value
            for place, value in before.values.items()
        }
        self._assume(replace(before, values=others))

    def _updated(self) -> None:
        """
        Stand for ``...Update``, proven by itself: show what it needs, assume what it keeps.
        """
        before, memory = self._state(), self._machine.memory
        needs = z3.And(before.is_in(RUNNING), before.of("updates") != 0, before.to_event <= 0)
        self._show("an update event is due when it is applied", needs)
        self._keeps()
        own = f"{self.motor}Motion"
        fields = ("eventAt", "top", "modification", "updates", "rest")
        changed: set[Place] = {(own, name) for name in fields}
        changed |= {place for place in before.values if place[:2] == (own, "next")}
        changed |= {(own, "status"), before.count_place}
        for place in sorted(changed):
            memory.write(place, z3.BitVec(f"{place} after the event", before.values[place].size()))
        after = self._state()
        for claim in invariant(after).values():
            self.paths.assume(claim)
        self.paths.assume(after.position == before.position)
        self.paths.assume(z3.Implies(before.steps_counted, after.left == before.left))

    def _masked(self) -> None:
        """
        Let anything have happened before interrupts are off for a second time.

        Since all is unknown then, one way up to there is followed further, and no other.
        """
        self._sections += 1
        if self._sections > 1:
            self._onward = self._onward or self.paths.taken
            if self.paths.taken[: len(self._onward)] != self._onward:
                raise _KnownFromHereError
            self._machine.memory.forget(f"in section {self._sections}")
            self._before = self._state()
            self._assume(self._before)

    def _keeps(self) -> State:
        after = self._state()
        for says, claim in invariant(after).items():
            self._show(says, claim)
        return after

    def _show(self, says: str, claim: Any) -> None:  # noqa: ANN401 - z3 has no types
        self.paths.prove(claim, says, self.name)


def _by_the_clock(entered: State) -> Any:  # noqa: ANN401 - z3 has no types
    """
    Tell whether the step interrupt can go on in its rare ways because of the clock.
    """
    if entered.has("eventAt"):
        return z3.BoolVal(val=True)
    return entered.patience <= 0 if entered.is_timed else z3.BoolVal(val=False)

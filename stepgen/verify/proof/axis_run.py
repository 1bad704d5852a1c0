"""
One way after the other through a function of an axis, or through a part of one.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import Any

import z3

from stepgen.verify.proof.axis_claims import AXIS_CLAIMS, AxisWay
from stepgen.verify.proof.axis_parts import PARTS, Call, Part, goes_on
from stepgen.verify.proof.axis_state import (
    CLIMB,
    COAST,
    DESCEND,
    RUNNING,
    AxisState,
    facts,
    invariant,
)
from stepgen.verify.proof.claims import POSITION_READ
from stepgen.verify.proof.integers import U16, integer
from stepgen.verify.proof.library import Library
from stepgen.verify.proof.machine import Machine
from stepgen.verify.proof.memory import GENERAL_PURPOSE, Place
from stepgen.verify.proof.operands import Frame, Pointer, is_pointer
from stepgen.verify.proof.paths import Paths
from stepgen.verify.proof.ramp import LENGTHS, Ramp

_BY_ITSELF = "the step interrupt by itself"
_VECTOR = "__vector_"
_ROW_BYTES = 4
_MOVES = {
    *("MoveTo", "Move", "QueueMoveTo", "RunForward", "RunBackward", "Stop", "SetSpeed", "Home"),
    "boundary",
    "limit",
}
"""What changes a way while the axis is on it: too much for z3 unless each mode has its ways."""

_HANDLERS = {"boundary", "limit"}
"""Where the step interrupt goes on."""

_CUTS = {"SetSpeed"}
"""Of those what changes the present level by itself: each length of one has its ways, too."""

_OTHERS = ("heightFor", "slopeOf", "levelsIn")
_DECIDES = re.compile(r"\bdecide \(\w+, &(\w+)\)")


def axis_entries(library: Library, motor: str) -> list[str]:
    """
    Return the functions by which a sketch or an interrupt gets at the axis *motor*, and its parts.
    """
    names = [
        f"{_VECTOR}{motor}_{name}" if name in _HANDLERS else motor + name for name in AXIS_CLAIMS
    ]
    found = (name for name in (*names, *PARTS, *_OTHERS) if name in library.functions)
    return [*found, _BY_ITSELF]


@dataclass
class AxisRun:
    """
    The proof of the function *name* of the axis *motor*, way by way.
    """

    library: Library
    name: str
    motor: str
    paths: Paths
    meant: set[str]
    _calls: int = 0
    _names: dict[int, tuple[Any, Any]] = field(default_factory=dict)
    _ramp: Ramp = field(init=False)
    _table: str = field(init=False)
    _machine: Machine = field(init=False)

    def __post_init__(self) -> None:
        """
        Take the ramp from the reference model, and show what is said of it.
        """
        axis = self.library.axes[self.motor]
        ladder, self._cruise_256, self._stops = axis.ladder, axis.cruise_256, axis.stops
        self._releases = axis.releases
        self._ramp = Ramp(ladder)
        self._goal = ladder.levels[ladder.goal(self._cruise_256)].height
        handler = self.library.functions[f"{_VECTOR}{self.motor}_boundary"]
        texts = (statement.text for block in handler.blocks.values() for statement in block)
        (self._table,) = {found[1] for text in texts if (found := _DECIDES.search(text))}

    def once(self) -> None:
        """
        Take one way through the function.
        """
        self._calls, self._names = 0, {}
        kind = self.name.removeprefix(_VECTOR).removeprefix(self.motor).removeprefix("_")
        machine = Machine(self.library.source, self.library.functions, self.paths)
        machine.used, self._machine, self.paths.learns = self.meant, machine, True
        if kind in _MOVES or kind in PARTS:
            machine.named = self._named
        known = machine.memory.snapshot()
        self.paths.inputs = {".".join(place): value for place, value in known.items()}
        for says in self._ramp.check():
            self._show(says, z3.BoolVal(val=False))
        others = {
            _BY_ITSELF: self._by_itself,
            "heightFor": self._height_for,
            "slopeOf": self._slope_of,
            "levelsIn": self._levels_in,
        }
        if self.name in others:
            others[self.name]()
            return
        self._stand_in()
        if kind in PARTS:
            self._part(PARTS[kind])
        else:
            self._whole(kind)

    def _stand_in(self) -> None:
        """
        Let the parts that are proven by themselves stand for what is known of them.
        """
        known = self._machine.known
        for name, part in PARTS.items():
            if name != self.name:
                known[name] = lambda *values, name=name, part=part: self._known(name, part, values)
        self._machine.rows[self._table] = self._of_row
        known["slopeOf"] = self._slope
        if self.name != f"{self.motor}Passed":
            known[f"{self.motor}Passed"] = lambda: z3.BitVec("the moment has passed", 1)
        if self.name == f"{self.motor}ReadNanometres":
            known[f"{self.motor}CurrentPosition"] = lambda: POSITION_READ
        self._height = z3.BitVec("the height for the interval", 16)
        known["heightFor"] = lambda *_: self._height

    def _whole(self, kind: str) -> None:
        machine = self._machine
        function = self.library.functions[self.name]
        arguments = [
            z3.BitVec(name, (integer(function.types[name]) or U16).bits)
            for name in function.parameters
        ]
        self.paths.inputs |= {str(argument): argument for argument in arguments}
        machine.unmasked = self._keeps
        before = self._state()
        self.paths.assume(self._ramp.is_level(self._height))
        self._assume_levels()
        if kind == "boundary":
            before = self._interrupted(before)
        if kind == "limit":
            before = self._before_step(before)
        if kind == "Init":
            self._from_reset(before)
        else:
            self._assume(before)
            if kind in _MOVES:
                before = self._split(before, lengths=kind in _CUTS)
        result = machine.call(self.name, *arguments)
        after = self._keeps()
        spec = (self._cruise_256, self._goal)
        per_mm = self.library.steps_per_mm.get(self.motor)
        way = AxisWay(before, after, arguments, result, spec, self._height, per_mm)
        self._show_all(AXIS_CLAIMS[kind](way))

    def _assume_levels(self) -> None:
        """
        Say that the levels up to which the source has the motor climb are levels.
        """
        heights = [0, self._goal]
        homing = self._stops and self._stops.homing
        if homing:
            heights += [homing.fast.height, homing.slow.height]
        levels = {level.height for level in self._ramp.ladder.levels}
        self._show("homing's speeds are levels", z3.BoolVal(val=levels.issuperset(heights)))
        for height in heights:
            self.paths.assume(self._ramp.is_level(z3.BitVecVal(height, 16)))

    def _split(self, before: AxisState, *, lengths: bool) -> AxisState:
        """
        Let each way have a known mode, and with *lengths* levels of a known length.

        That is far easier to prove.
        """
        memory, own = self._machine.memory, f"{self.motor}Motion"
        known = [before.of("mode") & bit != 0 for bit in (RUNNING, CLIMB, DESCEND)]
        bits = [self.paths.decide(one) for one in known]
        split: dict[Place, Any] = {(own, "mode"): _with_bits(before.of("mode"), *bits)}
        if bits[0] and lengths:
            split[own, "length"] = self._one_of(before.of("length"))
        for place, value in split.items():
            memory.write(place, value)
        return replace(before, values={**before.values, **split})

    def _before_step(self, entered: AxisState) -> AxisState:
        """
        Return what was before the step interrupt that has met a switch, and *entered* its handler.

        It has counted the step, and done nothing else.
        """
        before = entered.counting(entered.count + 1)
        self.paths.assume(z3.And(before.is_in(RUNNING), before.of("lapsLeft") == 0))
        return before

    def _interrupted(self, entered: AxisState) -> AxisState:
        """
        Return what was before the step interrupt that goes on to its rare ways as *entered*.
        """
        self.paths.assume(entered.count == 0)
        self.paths.assume(entered.is_in(RUNNING | COAST))
        self.paths.assume(z3.Or(entered.of("lapsLeft") != 0, entered.of("levels") == 0))
        return entered.counting(z3.BitVecVal(1, 8))

    def _from_reset(self, before: AxisState) -> None:
        """
        Show that the invariant holds after reset, where RAM is 0; of registers nothing is known.
        """
        zeros = {place: value & 0 for place, value in before.values.items()}
        for says, claim in invariant(replace(before, values=zeros)).items():
            self.paths.prove(claim, says, "after reset")
        registers = set(GENERAL_PURPOSE.values())
        others = {
            place: z3.BitVec("at reset", 8) if place[0] in registers else value
            for place, value in before.values.items()
        }
        self._assume(replace(before, values=others))

    def _part(self, part: Part) -> None:
        before = self._state()
        arguments = self._arguments()
        if "count" in arguments:
            before = before.counting(arguments["count"])
        for _, claim in part.needs(before, arguments):
            self.paths.assume(claim)
        for fact in facts(before):
            self.paths.assume(fact)
        if part.splits:
            before = self._split(before, lengths=True)
        result = self._machine.call(self.name, *arguments.values())
        after = self._state()
        if part.counts:
            after = after.counting(result)
        here, there = (before.of("row"), before.of("rung")), after.of("row")
        for level in (after.level, after.of("rung")):
            for pair in ((here, (there, level)), ((there, level), here)):
                for fact in self._ramp.facts_of_two(*pair):
                    self.paths.assume(fact)
        for fact in facts(after):
            self.paths.assume(fact)
        self._show_all(part.gives(Call(before, after, arguments, result)))

    def _arguments(self) -> dict[str, Any]:
        """
        Return the arguments of a part: the motion and the ramp of this motor, all others unknown.
        """
        function = self.library.functions[self.name]
        places = {"axis": f"{self.motor}Motion", "ramp": self._table}
        arguments = {}
        for name in function.parameters:
            kind = function.types[name]
            if is_pointer(kind):
                arguments[name] = Pointer((places[name],))
            else:
                arguments[name] = z3.BitVec(name, (integer(kind) or U16).bits)
                self.paths.inputs[name] = arguments[name]
        return arguments

    def _known(self, name: str, part: Part, values: tuple[Any, ...]) -> Any:  # noqa: ANN401
        """
        Stand for *part*: show what it needs, and assume what it gives.
        """
        function = self.library.functions[name]
        arguments = dict(zip(function.parameters, values, strict=True))
        before, memory = self._state(), self._machine.memory
        if "count" in arguments:
            before = before.counting(arguments["count"])
        for fact in facts(before):
            self.paths.assume(fact)
        self._show_all(part.needs(before, arguments))
        self._calls += 1
        for one in part.changes:
            place = (f"{self.motor}Motion", one)
            unknown = z3.BitVec(f"{one} after {name} {self._calls}", before.values[place].size())
            memory.write(place, unknown)
        kind = integer(function.result) or U16
        result = z3.BitVec(f"{name} {self._calls}", kind.bits)
        after = self._state()
        if part.counts:
            after = after.counting(result)
        for _, claim in part.gives(Call(before, after, arguments, result)):
            self.paths.assume(claim)
        if "mode" in part.changes:
            self._split(self._state(), lengths=False)
        return result

    def _of_row(self, name: str, number: Any) -> Any:  # noqa: ANN401 - z3 has no types
        """
        Return the field *name* of row *number*, as the table has it; its length is then known.
        """
        row = z3.simplify(z3.Extract(7, 0, number))
        for fact in self._ramp.facts_of_row(row):
            self.paths.assume(fact)
        if name == "levels":
            return self._ramp.levels(row)
        length = self._one_of(self._ramp.steps(row)).as_long()
        more = z3.Extract(7, 3, self._ramp.shifts(row))
        return z3.Concat(more, z3.BitVecVal(length.bit_length() - 1, 3))

    def _slope(self, pointer: Pointer, shifts: Any) -> Any:  # noqa: ANN401
        at = z3.BitVecVal(0, 16) if pointer.element is None else pointer.element
        number = z3.simplify(z3.UDiv(at, z3.BitVecVal(_ROW_BYTES, 16)))
        self._show("the beginning of a row", z3.URem(at, _ROW_BYTES) == 0)
        self._show("a row of the ramp", z3.ULT(number, self._ramp.rows))
        row = z3.simplify(z3.Extract(7, 0, number))
        self._show("the shifts of that row", shifts == self._ramp.shifts(row))
        return self._ramp.slope(row)

    def _one_of(self, length: Any) -> Any:  # noqa: ANN401
        """
        Return *length* as a number: each way goes on with one of those that a level can have.
        """
        for known in LENGTHS[:-1]:
            if self.paths.decide(length == known):
                return z3.BitVecVal(known, 8)
        return z3.BitVecVal(LENGTHS[-1], 8)

    def _slope_of(self) -> None:
        """
        Show that what is read of each row is what the reference model has there.
        """
        number = z3.BitVec("row", 16)
        self.paths.inputs = {"row": number}
        self.paths.assume(z3.ULT(number, self._ramp.rows))
        machine, at = self._machine, number * _ROW_BYTES
        frame = Frame(self.library.functions[self.name], ())
        fields = {
            name: machine.entry(Pointer((self._table, name), at), frame)
            for name in ("levels", "shifts")
        }
        shifts = fields["shifts"]
        read = {
            "levels": fields["levels"],
            "stepsOf": machine.call("stepsOf", shifts),
            "slopeOf": machine.call("slopeOf", Pointer((self._table,), at), shifts),
        }
        for name, value in self._ramp.entries(z3.Extract(7, 0, number)):
            self._show(f"{name} as the model has it", read[name] == value)

    def _levels_in(self) -> None:
        """
        Show that no other number of whole levels is in so many steps, for each length of a level.
        """
        steps, shifts = z3.BitVec("steps", 16), z3.BitVec("shifts", 8)
        self.paths.inputs = {"steps": steps, "shifts": shifts}
        result = self._machine.call("levelsIn", steps, shifts)
        length = self._machine.call("stepsOf", shifts)
        length = z3.ZeroExt(24, self._one_of(length))
        parts, whole = z3.ZeroExt(16, result) * length, z3.ZeroExt(16, steps)
        fills = z3.And(z3.ULE(parts, whole), z3.ULT(whole - parts, length))
        self._show("so many whole levels fit, and no more", fills)

    def _height_for(self) -> None:
        """
        Show that the height is that of the last level whose interval is as long.
        """
        interval = z3.BitVec("interval", 32)
        self.paths.inputs = {"interval": interval}
        self.paths.assume(z3.UGE(interval, self._cruise_256))
        ladder = self._ramp.ladder
        rows = z3.BitVecVal(self._ramp.rows, 8)
        first = z3.BitVecVal(ladder.first_interval_256, 32)
        call = self._machine.call(self.name, Pointer((self._table,)), rows, first, interval)
        result, levels = z3.simplify(call), ladder.levels
        at = {level.height: number for number, level in enumerate(levels)}
        number = at.get(result.as_long()) if z3.is_bv_value(result) else None
        self._show("the height is that of a level", z3.BoolVal(number is not None))
        if number is not None:
            self._show_all(_is_goal(levels, number, interval))

    def _by_itself(self) -> None:
        self._assume(self._state())
        before = self._split(self._state(), lengths=True)
        for after, when in goes_on(before):
            for fact in facts(after):
                self.paths.assume(fact)
            for says, claim in invariant(after).items():
                self._show(says, z3.Implies(when, claim))
            step = after.left == before.left - 1
            self._show("a step less is left", z3.Implies(when, step))

    def _named(self, value: Any) -> Any:  # noqa: ANN401 - z3 has no types
        """
        Return a name for *value*, unless it is known: what is said of names is short, and z3 fast.
        """
        value = z3.simplify(value)
        if z3.is_bv_value(value) or z3.is_const(value):
            return value
        known = self._names.get(value.get_id())
        if known:
            return known[1]
        self._calls += 1
        name = z3.BitVec(f"result {self._calls}", value.size())
        self.paths.assume(name == value)
        self._names[value.get_id()] = value, name
        return name

    def _state(self) -> AxisState:
        values = self._machine.memory.snapshot()
        ramp, stops, releases = self._ramp, self._stops, self._releases
        source = self.library.source
        return AxisState(values, source, self.motor, ramp, stops, releases, self._named)

    def _assume(self, state: AxisState) -> None:
        for claim in [*invariant(state).values(), *facts(state)]:
            self.paths.assume(claim)

    def _keeps(self) -> AxisState:
        after = self._state()
        for fact in facts(after):
            self.paths.assume(fact)
        self._show_all(iter(invariant(after).items()))
        return after

    def _show_all(self, claims: Iterator[tuple[str, Any]]) -> None:
        for says, claim in claims:
            self._show(says, claim)

    def _show(self, says: str, claim: Any) -> None:  # noqa: ANN401 - z3 has no types
        self.paths.prove(claim, says, self.name)


def _with_bits(mode: Any, *known: bool) -> Any:  # noqa: ANN401 - z3 has no types
    """
    Return *mode* with the bits kRunning, kClimb and kDescend as they are known to be.
    """
    running, climb, descend = (z3.BitVecVal(bit, 1) for bit in known)
    return z3.Concat(z3.Extract(7, 7, mode), descend, climb, running, z3.Extract(3, 0, mode))


def _is_goal(levels: Any, number: int, interval: Any) -> Iterator[tuple[str, Any]]:  # noqa: ANN401
    if number:
        yield "that level is not faster", z3.ULE(interval, levels[number].interval_256)
    if number + 1 < len(levels):
        yield "the next one is", z3.UGT(interval, levels[number + 1].interval_256)

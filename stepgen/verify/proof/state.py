"""
What a motor's variables say, and what holds of them whenever no code of the library runs.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import z3

from stepgen.verify.proof.memory import CLOCK, Place
from stepgen.verify.proof.numbers import wide, wide_signed
from stepgen.verify.proof.source import Source

THINK, COAST, ENDLESS, REVERSE, RUNNING, CLOCKED, LIMITED = (1 << bit for bit in range(7))
"""The bits of ``mode``: kThink and so on."""

LAPS = LIMITED
"""The bit kLaps of a motion at constant speed."""

UPDATE_STEPS, IRQ_TIMING, SPEED_VARIABLE = 0x08, 0x10, 0x40

# The least ticks of a period by clock select: 65536 / 8, 2**19 / 64, 2**22 / 256, 2**24 / 1024.
_LEAST_TICKS = {2: 8192, 3: 8192, 4: 16384, 5: 16384}
_LAP_MILLIS = 0x4000


@dataclass(frozen=True)
class State:
    """
    The variables of *motor* at one moment.

    Args:
        values: The values by place.
        source: What the library declares.
        motor: The motor's name.
        min_top: MOTOR_MIN_TOP.
        max_top: MOTOR_MAX_TOP.
        entered_count: What the step interrupt left of the count when it went on to its rare ways;
            `values` then has the count as it was before the interrupt.
    """

    values: Mapping[Place, Any]
    source: Source
    motor: str
    min_top: int
    max_top: int
    entered_count: Any = None

    def has(self, *names: str) -> bool:
        """
        Tell whether the motor has this field.
        """
        return (f"{self.motor}Motion", *names) in self.values

    def of(self, *names: str) -> Any:  # noqa: ANN401 - z3 has no types
        """
        Return a field as it is.
        """
        return self.values[(f"{self.motor}Motion", *names)]

    def is_in(self, mode: int) -> Any:  # noqa: ANN401
        """
        Tell whether any bit of *mode* is set.
        """
        return self.of("mode") & mode != 0

    @property
    def count_place(self) -> Place:
        """
        Return where the step interrupt counts down.
        """
        return (self.source.operands[self.motor]["count"],)

    @property
    def count(self) -> Any:  # noqa: ANN401
        """
        Return how many steps the interrupt counts down.
        """
        return self.values[self.count_place]

    @property
    def rest(self) -> Any:  # noqa: ANN401
        """
        Return the 32 bits of the steps to make after those.
        """
        rest = self.of("rest")
        return z3.Concat(self.of("restHigh"), rest) if self.has("restHigh") else rest

    @property
    def left(self) -> Any:  # noqa: ANN401
        """
        Return the number of steps that are left, as a whole number.
        """
        return wide(self.rest) + wide(self.count)

    @property
    def position(self) -> Any:  # noqa: ANN401
        """
        Return the position modulo 2**32: the target less what is left to do.
        """
        left = z3.Extract(31, 0, self.left)
        return self.of("target") + z3.If(self.is_in(REVERSE), left, -left)

    @property
    def steps_counted(self) -> Any:  # noqa: ANN401
        """
        Tell whether the motor runs to an end point in steps.
        """
        return z3.And(self.is_in(RUNNING), z3.Not(self.is_in(ENDLESS)))

    @property
    def is_lapping(self) -> Any:  # noqa: ANN401
        """
        Tell whether matches of the present interval come before the one that is a step.
        """
        return self.of("lapsLeft") != 0 if self.has("lapsLeft") else z3.BoolVal(val=False)

    @property
    def may_coast(self) -> bool:
        """
        Tell whether the motor keeps its coils on for an interval after its last step.
        """
        reached = f"{self.motor}Reached("
        return any(reached in line and "kThink | kCoast" in line for line in self.source.lines)

    @property
    def to_millis_end(self) -> Any:  # noqa: ANN401
        """
        Return the milliseconds until the limit at constant speed: to endMillis, and laps.

        With kLaps those are laps + 256 * lapsHigh, where 0 laps stand for 256; else none.
        """
        until = self.of("endMillis") - z3.Extract(15, 0, self.values[CLOCK])
        laps, high = wide(self.of("laps")), wide(self.of("lapsHigh"))
        more = z3.If(laps == 0, laps + 256, laps) + 256 * high
        return wide_signed(until) + z3.If(self.is_in(LAPS), _LAP_MILLIS * more, 0)

    @property
    def is_timed(self) -> bool:
        """
        Tell whether the motor has a command time-out.
        """
        return (f"{self.motor}Deadline",) in self.values

    @property
    def patience(self) -> Any:  # noqa: ANN401
        """
        Return the milliseconds until the command time-out ends, 0 or less after it.
        """
        deadline = self.values[(f"{self.motor}Deadline",)]
        return wide_signed(deadline - z3.Extract(15, 0, self.values[CLOCK]))

    @property
    def left_alone(self) -> Any:  # noqa: ANN401
        """
        Tell whether the command time-out ended the last motion.
        """
        return self.values[(f"{self.motor}LeftAlone",)] != 0

    @property
    def to_event(self) -> Any:  # noqa: ANN401
        """
        Return the steps or milliseconds until the next update event, negative if it is overdue.
        """
        by_steps = self.of("control") & UPDATE_STEPS != 0
        left = z3.Extract(31, 0, self.left)
        return wide_signed(self.of("eventAt") - z3.If(by_steps, ~left, self.values[CLOCK]))


Claims = dict[str, Any]


def invariant(state: State) -> Claims:
    """
    Return what always holds of *state*, by its name.
    """
    claims = {
        "1 to 255 steps are counted down while the motor runs": z3.Implies(
            z3.Or(state.is_in(RUNNING), _coasts(state)), state.count != 0
        ),
        "the steps that are left fit 32 bits": z3.Implies(
            state.steps_counted, state.left < 1 << 32
        ),
    }
    if state.is_timed:
        looks = z3.Implies(state.is_in(RUNNING), state.is_in(CLOCKED))
        claims["a motor with a command time-out looks at the clock while it runs"] = looks
        coasts = z3.Not(z3.And(_coasts(state), state.is_in(CLOCKED)))
        claims["it does not while it coasts"] = coasts
    claims |= _of_ring(state) | _of_coasting(state)
    if state.has("next", "top"):
        claims |= _of_fast_pwm(state)
    else:
        claims |= _of_channel(state) if state.has("lapsLeft") else _of_compare(state)
    return claims | (_of_events(state) if state.has("eventAt") else _of_constant(state))


def assumed(state: State) -> Claims:
    """
    Return what is taken for granted of time: that nobody comes too late by days.
    """
    running = state.is_in(RUNNING)
    if state.has("eventAt"):
        overdue = z3.Implies(
            z3.And(running, state.of("updates") != 0), state.to_event > -(1 << 31) + (1 << 16)
        )
        return {"an update event is overdue by less than 2**31 - 2**16 ms or steps": overdue}
    limited = z3.And(running, state.is_in(THINK))
    until = wide_signed(state.of("endMillis") - z3.Extract(15, 0, state.values[CLOCK]))
    return {"a step is made at least each 16 s": z3.Implies(limited, until > -_LAP_MILLIS)}


def _coasts(state: State) -> Any:  # noqa: ANN401
    return state.is_in(COAST)


def _of_coasting(state: State) -> Claims:
    if not state.may_coast:
        return {"the motor never coasts": z3.Not(_coasts(state))}
    thinks = z3.And(z3.Not(state.is_in(RUNNING)), state.is_in(THINK))
    return {"a motor that coasts thinks, and runs no more": z3.Implies(_coasts(state), thinks)}


def _of_ring(state: State) -> Claims:
    operands = state.source.operands[state.motor]
    if "ring" not in operands:
        return {}
    _, entries = state.source.tables[operands["ring"]]
    row = entries[0] // 2  # the first row leads to that of phase 1, the third
    at = state.values[(operands["state"],)]
    turned = z3.If(state.is_in(REVERSE), z3.BitVecVal(row, 8), z3.BitVecVal(0, 8))
    inside = z3.And(z3.URem(at, 2 * row) == turned, z3.ULT(at, len(entries)))
    return {"the state is a row of the table, of the motion's direction": inside}


def _of_fast_pwm(state: State) -> Claims:
    select, ticks = state.of("next", "select"), wide(state.of("next", "top")) + 1
    waits = select != 0
    least = z3.BitVecVal(state.min_top, ticks.size())
    for at, number in _LEAST_TICKS.items():
        least = z3.If(select == at, z3.BitVecVal(number, ticks.size()), least)
    claims = {
        "a clock select is at most 5": z3.ULE(select, 5),
        "a period that waits has as many ticks as the choice gives": z3.Implies(
            waits, ticks >= least
        ),
    }
    if state.has("elapsed"):
        late = z3.Implies(waits, wide(state.of("elapsed")) < wide(state.of("next", "top")))
        claims["the counter is set to less than TOP"] = late
        _, entries = state.source.tables[f"{state.motor}Elapsed"]
        known = z3.ULE(state.of("elapsed"), max(entries))
        claims["the ticks that have passed are of the table"] = known
    return claims


def _of_compare(state: State) -> Claims:
    running = z3.Or(state.is_in(RUNNING), _coasts(state))
    fits = z3.And(z3.ULE(state.of("next", "lapsHigh"), 127), z3.UGE(state.of("next", "first"), 128))
    return {
        "laps are counted down to below 0, and matches are 128 ticks apart": z3.Implies(
            running, fits
        )
    }


def _of_channel(state: State) -> Claims:
    moves = z3.Or(state.is_in(RUNNING), _coasts(state))
    ticks, laps = state.of("next", "ticks"), state.of("next", "laps")
    fits = z3.And(z3.ULT(ticks, 1 << 15), z3.Implies(laps != 0, z3.UGE(ticks, 1 << 14)))
    alone = z3.And(moves, z3.Or(state.is_lapping, laps != 0))
    return {
        "a match comes before the timer has gone half round": z3.Implies(moves, fits),
        "an interval with laps has a run of its own": z3.Implies(alone, state.count == 1),
    }


def _of_constant(state: State) -> Claims:
    limited = z3.And(state.is_in(RUNNING), state.is_in(THINK))
    claims = {
        "a limit in milliseconds has none in steps": z3.Implies(limited, state.is_in(ENDLESS)),
        "one step is counted down before the clock is looked at": z3.Implies(
            limited, state.count == 1
        ),
    }
    if state.has("next", "select"):
        waits = z3.And(limited, state.of("next", "select") != 0)
        first = z3.Implies(waits, state.of("rest") != 0)
        claims["the first step of a limit in milliseconds takes no borrow"] = first
    return claims


def _of_events(state: State) -> Claims:
    running = state.is_in(RUNNING)
    pending = z3.And(running, state.of("updates") != 0)
    top = wide(state.of("top"))
    return {
        "the virtual TOP is within its range": z3.Implies(
            running, z3.And(top >= state.min_top, top <= state.max_top)
        ),
        "update events have an interval": z3.Implies(pending, state.of("interval") != 0),
        "the next update event is at most an interval away": z3.Implies(
            pending, state.to_event <= wide(state.of("interval"))
        ),
        "only a motor that coasts thinks first": state.is_in(THINK) == state.is_in(COAST),
        "a motor that coasts looks at no clock": z3.Not(
            z3.And(state.is_in(COAST), state.is_in(CLOCKED))
        ),
        "a limit in milliseconds has none in steps": z3.Implies(
            z3.And(running, state.is_in(LIMITED)), state.is_in(ENDLESS)
        ),
    }

"""
The highest safe step rate, and how long interrupts may be off: what `stepgen.plan.waits` decides.
"""

import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace

from stepgen.devices import CORE, INTERRUPTS, Board, LibraryInterrupt
from stepgen.plan.model import HeldOff, MotorPlan, Part, RateLimit
from stepgen.plan.timings import plan_cadence
from stepgen.plan.uses import Use
from stepgen.plan.waits import MainLine, Source, Wait, longest_wait

_SHOWN_RATES = (100, 500, 1000, 2000, 5000, 10_000)


@dataclass(frozen=True)
class Chip:
    """
    Everything of one library that has an interrupt of it wait.

    Args:
        board: The board.
        motors: The motors, all of which run at once.
        beside: Interrupts of the core and of other libraries.
        masked_cycles: The longest stretch with interrupts off.
        unproven: Those of *beside* whose cycles no test proves, by name, and where these come from.
    """

    board: Board
    motors: tuple[MotorPlan, ...]
    beside: tuple[Source, ...]
    masked_cycles: int
    unproven: Mapping[str, str] = field(default_factory=dict)

    @property
    def floor_cycles(self) -> int:
        """
        Return the shortest period that the timings are made for; it holds for the whole library.
        """
        return max(motor.timing.smallest_period_cycles for motor in self.motors)

    @property
    def ceiling_cycles(self) -> int:
        """
        Return the longest period that the timings have.
        """
        return min(motor.timing.largest_period_cycles for motor in self.motors)

    def wait(self, motor: MotorPlan, period_cycles: int) -> Wait | None:
        """
        Return the longest wait of *motor* while all motors make a step each *period_cycles*.

        None if it can lose one.
        """
        sources = {one.name: self._source(one, period_cycles) for one in self.motors}
        # Where no interrupt of it is lost, it has nothing to make good.
        own = replace(
            sources.pop(motor.name),
            cycles=motor.recurring_bound_cycles,
            rare_cycles=motor.punctual_bound_cycles - motor.recurring_bound_cycles,
        )
        patience = plan_cadence(motor.timing, period_cycles).patience_cycles
        # CALL and RET are the longest instructions; they push and pop what the response does.
        main = MainLine(self.masked_cycles, self.board.mcu.response_cycles)
        return longest_wait(own, patience, (*self.beside, *sources.values()), main)

    def _source(self, motor: MotorPlan, period_cycles: int) -> Source:
        return Source(
            f"the step interrupt of {motor.name}",
            self.board.mcu.vector(motor.timing.vector).number,
            motor.recurring_bound_cycles + motor.gate.late_cycles,
            plan_cadence(motor.timing, period_cycles).spacing_cycles,
            rare_cycles=motor.punctual_bound_cycles - motor.recurring_bound_cycles,
        )


def situations(alone: Chip, uses: Collection[Use]) -> Iterator[tuple[str, Chip]]:
    """
    Yield what the motors of *alone* can be beside, in words, and the chip with it: least first.

    Of *uses* those count whose interrupts have a bound; the others get a warning.
    """
    yield "alone", alone
    core = {name: _of_core(name, alone.board) for name in CORE}
    core = {name: sources for name, sources in core.items() if sources}
    of_core = tuple(source for sources in core.values() for source in sources)
    yield _beside(core), replace(alone, beside=of_core)
    named = {
        use.name: tuple(
            source
            for interrupt in INTERRUPTS[use.name]
            for source in _sources(interrupt, use, alone.board)
        )
        for use in uses
        if use.name in INTERRUPTS
    }
    if named:
        others = tuple(source for sources in named.values() for source in sources)
        unproven = {
            name: interrupt.basis
            for name in named
            for interrupt in INTERRUPTS[name]
            if not interrupt.is_proven_on(alone.board.mcu)
        }
        chip = replace(alone, beside=of_core + others, unproven=unproven)
        yield _beside([*core, *named]), chip


def _beside(names: Iterable[str]) -> str:
    *first, last = names
    return f"beside {', '.join(first)} and {last}" if first else f"beside {last}"


def everything(alone: Chip, uses: Collection[Use]) -> Chip:
    """
    Return *alone* with millis and all of *uses* whose interrupts have a bound.
    """
    *_, (_, chip) = situations(alone, uses)
    return chip


def _of_core(name: str, board: Board) -> tuple[Source, ...]:
    return tuple(_sources(CORE[name], Use(name, (), (), ()), board))


def _sources(interrupt: LibraryInterrupt, use: Use, board: Board) -> Iterator[Source]:
    """
    Yield *interrupt* for each vector that it has with the timers and pins of *use*.
    """
    patterns = {interrupt.vector.format(timer=number) for number in use.timers or ("",)}
    is_apart = 0 < len(use.pins) <= interrupt.apart_up_to
    for vector in board.mcu.vectors:
        if any(re.fullmatch(pattern, vector.name) for pattern in patterns):
            yield Source(
                interrupt.cause,
                vector.number,
                interrupt.cycles_on(board.mcu),
                interrupt.spacing_on(board.f_cpu_hz),
                1 if is_apart else interrupt.at_once,
                interrupt.waiting,
            )


def shortest_period(chip: Chip, motor: MotorPlan) -> int | None:
    """
    Return the shortest period in which *motor* loses no step; None if there is none.
    """
    return _first(chip.floor_cycles, chip.ceiling_cycles, lambda p: chip.wait(motor, p) is not None)


def rate_limit(chip: Chip, motor: MotorPlan, beside: str) -> RateLimit | None:
    """
    Return the highest rate of *motor* on *chip*; None if it loses steps at every rate.
    """
    period = shortest_period(chip, motor)
    wait = None if period is None else chip.wait(motor, period)
    if period is None or wait is None:
        return None
    parts = (*wait.parts, Part("its own step interrupt", motor.punctual_bound_cycles))
    return RateLimit(
        beside,
        period,
        chip.board.f_cpu_hz / period,
        _cause(chip, period, parts),
        parts,
        chip.unproven,
    )


def _cause(chip: Chip, period: int, parts: tuple[Part, ...]) -> str:
    if period == chip.floor_cycles:
        slowest = max(chip.motors, key=lambda motor: motor.timing.smallest_period_cycles)
        return f"{period} clocks are the shortest period of timing {slowest.timing.kind}"
    largest = max(parts, key=lambda part: part.cycles)
    total = sum(part.cycles for part in parts)
    return f"a step can take and wait {total} clocks, {largest.cycles} of them for {largest.cause}"


def held_off(chip: Chip, minimum_period_cycles: int) -> tuple[HeldOff, ...]:
    """
    Return how long the sketch may have interrupts off, for a few rates up to the library's highest.

    A rate at which it is the same as at the next higher one is left out.
    """
    f_cpu = chip.board.f_cpu_hz
    periods = [f_cpu // rate for rate in _SHOWN_RATES if f_cpu // rate > minimum_period_cycles]
    every = [_held_off(chip, period) for period in (*periods, minimum_period_cycles)]
    return tuple(
        held
        for held, faster in zip(every, (*every[1:], None), strict=True)
        if faster is None or faster.stretch_cycles != held.stretch_cycles
    )


def _held_off(chip: Chip, period: int) -> HeldOff:
    """
    Return the longest stretch at *period*: the last before the first that loses a step.
    """

    def loses(stretch: int) -> bool:
        held = replace(chip, masked_cycles=stretch)
        return any(held.wait(motor, period) is None for motor in chip.motors)

    patience = max(plan_cadence(motor.timing, period).patience_cycles for motor in chip.motors)
    too_long = _first(1, max(period, patience) + 1, loses) or 1
    held = replace(chip, masked_cycles=too_long - 1)
    waits = [held.wait(motor, period) for motor in chip.motors]
    late = max(wait.cycles for wait in waits if wait)
    return HeldOff(period, chip.board.f_cpu_hz / period, too_long - 1, late)


def _first(low: int, high: int, holds: Callable[[int], bool]) -> int | None:
    """
    Return the first number from *low* to *high* of which *holds*, as of all after it, or None.
    """
    if not holds(high):
        return None
    while low < high:
        middle = (low + high) // 2
        low, high = (low, middle) if holds(middle) else (middle + 1, high)
    return low

"""
From recorded events to what each motor was seen to do.
"""

from bisect import bisect_left, bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from stepgen.devices import Mcu, Register, Timer
from stepgen.reference.core_clock import millis_after
from stepgen.verify.events import Events, Kind

_CLOCK_SELECT = 0b111
_SKETCH_VECTOR = "TIMER0_COMPA_vect"  # where the bench makes the calls of `Context.INTERRUPT`
_COUNTER_STATES = 1 << 16
_FRAME_CYCLES = 2
"""Interrupts are off so long where the compiler moves the stack pointer, and nowhere else."""


class PortState(NamedTuple):
    """
    A port register from a cycle on.
    """

    cycle: int
    port: str
    value: int


class Run(NamedTuple):
    """
    One run of a step interrupt.

    Args:
        raised: Cycle at which the timer set the flag.
        unmasked: Cycle from which the interrupt could be taken; *raised* if that was at once.
        entered: Cycle at which the response began.
        left: Cycle after RETI.
        writes: What it wrote to the ports, in order.
        serves_later: Whether *raised* is that of a later deadline, served in place of its own.
        put_off: Whether the interrupt of that deadline has left the step to this one.
    """

    raised: int
    unmasked: int
    entered: int
    left: int
    writes: tuple[PortState, ...]
    serves_later: bool = False
    put_off: bool = False


@dataclass(frozen=True)
class ClockStart:
    """
    The clock select of a timer was set, with *tcnt* in its counter.
    """

    cycle: int
    prescaler: int
    tcnt: int


class ChannelWrite(NamedTuple):
    """
    A compare register was written, which matches the counter *ahead_cycles* later.
    """

    cycle: int
    ahead_cycles: int
    in_interrupt: bool


def _columns(rows: Events, *names: str) -> Iterator[tuple[int, ...]]:
    """
    Return the fields *names* of each of *rows* as numbers of Python, at once: far faster.
    """
    return zip(*(rows[name].tolist() for name in names), strict=True)


@dataclass
class Trace:
    """
    Everything that a bench run recorded, in the order of cycles.
    """

    events: Events
    mcu: Mcu
    ports: list[PortState] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.events = self.events[np.argsort(self.events["cycle"], kind="stable")]
        self._by_kind: dict[Kind, Events] = {}
        self._starts: dict[int, list[ClockStart]] = {}
        self._sets: dict[int, list[ChannelWrite]] = {}
        letters = {port.port.address: port.letter for port in self.mcu.ports}
        rows = self._of(Kind.PORT)
        self.ports = [
            PortState(cycle, letters[source], value)
            for cycle, source, value in _columns(rows, "cycle", "source", "value")
            if source in letters
        ]
        exits = self._of(Kind.ISR_EXIT)
        self._isr_exits = exits["cycle"].tolist()
        self._isr_entries = exits["since"].tolist()
        sketch = self.mcu.vector(_SKETCH_VECTOR).number
        self._sketch_exits = self._of(Kind.ISR_EXIT, sketch)["cycle"].tolist()
        entries = self._of(Kind.ISR_ENTER, sketch)["cycle"].tolist()
        self._sketch_entries = entries[: len(self._sketch_exits)]
        self._port_cycles = [state.cycle for state in self.ports]
        # For each port from when on it holds what; 0 from reset.
        self._held: dict[str, tuple[list[int], list[int]]] = {
            port.letter: ([0], [0]) for port in self.mcu.ports
        }
        for state in self.ports:
            cycles, values = self._held[state.port]
            cycles.append(state.cycle)
            values.append(state.value)
        self.unmasked: list[int] = self._of(Kind.UNMASKED)["cycle"].tolist()
        self.masked = self._sections(self._of(Kind.MASKED)["cycle"].tolist())

    def _of(self, kind: Kind, source: int | None = None) -> Events:
        if kind not in self._by_kind:
            self._by_kind[kind] = self.events[self.events["kind"] == kind]
        rows = self._by_kind[kind]
        return rows if source is None else rows[rows["source"] == source]

    def runs(self, vector: int) -> list[Run]:
        """
        Return the runs of the interrupt *vector*; one that has not ended is left out.
        """
        enters = self._of(Kind.ISR_ENTER, vector)
        exits = self._of(Kind.ISR_EXIT, vector)
        rows = zip(
            _columns(enters, "since", "masked_until", "cycle"),
            exits["cycle"].tolist(),
            strict=False,
        )
        return [
            Run(since, max(since, until), entered, left, self._writes(entered, left))
            for (since, until, entered), left in rows
        ]

    def _sections(self, masked: Sequence[int]) -> list[int]:
        """
        Return those of *masked*, where interrupts go off, that are no move of the stack pointer.
        """
        places = [bisect_left(self.unmasked, start) for start in masked]
        return [
            start
            for start, place in zip(masked, places, strict=True)
            if place == len(self.unmasked) or self.unmasked[place] - start != _FRAME_CYCLES
        ]

    def _writes(self, first: int, last: int) -> tuple[PortState, ...]:
        low = bisect_right(self._port_cycles, first)
        return tuple(self.ports[low : bisect_right(self._port_cycles, last)])

    def ports_at(self, cycle: int) -> dict[str, int]:
        """
        Return what all ports hold after everything up to and including *cycle*.
        """
        return {
            letter: values[bisect_right(cycles, cycle) - 1]
            for letter, (cycles, values) in self._held.items()
        }

    def clock_starts(self, timer: Timer) -> list[ClockStart]:
        """
        Return when the clock select of *timer* was set after it had been 0.
        """
        address = timer.tccrb.address
        if address not in self._starts:
            self._starts[address] = list(self._clock_starts(timer))
        return self._starts[address]

    def _clock_starts(self, timer: Timer) -> Iterator[ClockStart]:
        counter = {timer.tcnt.address + byte: 0 for byte in range(timer.counter_bytes)}
        running = False
        rows = self._of(Kind.REGISTER)
        for cycle, source, value in _columns(rows, "cycle", "source", "value"):
            if source in counter:
                counter[source] = value
            elif source == timer.tccrb.address:
                select = value & _CLOCK_SELECT
                if select and not running:
                    count = int.from_bytes(counter.values(), "little")
                    yield ClockStart(cycle, timer.prescalers[select - 1], count)
                running = bool(select)

    def channel_sets(self, channel: Register, timer: Timer) -> list[ChannelWrite]:
        """
        Return each write of *channel* of *timer* after that was started.

        It counts each cycle: at the edge s + n a timer started at s with t shows t + n, and at
        the edge at which it leaves the value of the channel it sets its flag (datasheet, timing
        diagram "Setting of OCFnx, no Prescaling"). The high byte, written first, waits in TEMP.
        """
        if channel.address not in self._sets:
            starts = self.clock_starts(timer)
            self._sets[channel.address] = list(self._channel_sets(channel, starts))
        return self._sets[channel.address]

    def _channel_sets(
        self, channel: Register, starts: Sequence[ClockStart]
    ) -> Iterator[ChannelWrite]:
        high = 0
        rows = self._of(Kind.REGISTER)
        low_address, high_address = channel.address, channel.address + 1
        rows = rows[(rows["source"] == low_address) | (rows["source"] == high_address)]
        for cycle, source, value in _columns(rows, "cycle", "source", "value"):
            if source == high_address:
                high = value
                continue
            place = bisect_right(starts, cycle, key=lambda start: start.cycle) - 1
            if place < 0:
                continue
            count = starts[place].tcnt + cycle - starts[place].cycle
            ahead = ((high << 8 | value) - count) % _COUNTER_STATES + 1
            yield ChannelWrite(cycle, ahead, self._is_in_interrupt(cycle))

    def _is_in_interrupt(self, cycle: int) -> bool:
        """
        Tell whether an interrupt runs at *cycle* that is none of the sketch, which makes calls.
        """
        place = bisect_left(self._isr_exits, cycle)
        runs = place < len(self._isr_exits) and self._isr_entries[place] < cycle
        return runs and self._interrupt_of_sketch(cycle) is None

    def millis_ticks(self, vector: int, f_cpu_hz: int) -> list[tuple[int, int]]:
        """
        Return (cycle, millis()) after each run of *vector*, the core's timer 0 interrupt.
        """
        ends = self._of(Kind.ISR_EXIT, vector)["cycle"].tolist()
        return [(cycle, millis_after(count, f_cpu_hz)) for count, cycle in enumerate(ends, 1)]

    def commit(self, begin: int, end: int, which: int = 0) -> tuple[int, int] | None:
        """
        Return first and last cycle of the section with interrupts off, number *which*, of a call.

        For a call within an interrupt of the sketch that is always the whole interrupt.
        """
        if within := self._interrupt_of_sketch(begin):
            return within
        low = bisect_left(self.masked, begin)
        if low + which >= len(self.masked) or self.masked[low + which] > end:
            return None
        start = self.masked[low + which]
        following = bisect_left(self.unmasked, start)
        return (start, self.unmasked[following]) if following < len(self.unmasked) else None

    def masked_section(self, cycle: int) -> tuple[int, int] | None:
        """
        Return first and last cycle of the section with interrupts off around *cycle*, if any.
        """
        if within := self._interrupt_of_sketch(cycle):
            return within
        place = bisect_right(self.masked, cycle) - 1
        if place < 0:
            return None
        section = self.commit(self.masked[place], cycle)
        return section if section and section[1] >= cycle else None

    def _interrupt_of_sketch(self, cycle: int) -> tuple[int, int] | None:
        """
        Return first and last cycle of the sketch's interrupt that runs at *cycle*, if one does.
        """
        place = bisect_right(self._sketch_entries, cycle) - 1
        if place < 0 or cycle > self._sketch_exits[place]:
            return None
        return self._sketch_entries[place], self._sketch_exits[place]

    def served_from(self, cycle: int) -> int:
        """
        Return from when on an interrupt raised at *cycle* can be taken, as far as others let it.

        After each RETI the main program gets one instruction before the next interrupt.
        """
        instruction = self.mcu.response_cycles  # the longest, CALL and RET, take as long
        free = cycle
        place = bisect_left(self._isr_exits, cycle)
        while place < len(self._isr_exits) and self._isr_entries[place] <= free:
            free = self._isr_exits[place] + instruction
            place += 1
        return max(free, cycle + instruction)

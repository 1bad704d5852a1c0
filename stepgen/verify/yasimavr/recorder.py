"""
What a machine of yasimavr records, from the library's own hooks.
"""

from collections.abc import Callable
from functools import partial
from types import ModuleType
from typing import Any, TypeAlias

import numpy as np

from stepgen.devices import Mcu, Timer, Timer16, Vector
from stepgen.verify.events import EVENT, Events, Kind

_EEDR, _UDR0 = 0x40, 0xC6
_IO_OFFSET = 0x20
# InterruptController.State of the library's signal.
_RAISED = {0x01, 0x41}
_CANCELLED, _TAKEN, _RETURNED = 0x10, 0x20, 0x30
_RETI_CYCLES = 4

_Foreign: TypeAlias = Any  # an object of the library, which has no types
Handler = Callable[[int, int, int], None]


class Recorder:
    """
    The events of one machine, and what is pending.

    Args:
        core: The module yasimavr.lib.core.
        device: The device whose hooks it takes.
        probe: To look at its registers.
        chip: Facts of the chip.
        watched: Data addresses whose writes are recorded as REGISTER.
    """

    def __init__(
        self, core: ModuleType, device: _Foreign, probe: _Foreign, chip: Mcu, watched: set[int]
    ) -> None:
        self._core, self._probe, self._watched = core, probe, watched
        self._rows: list[tuple[int, int, int, int, int, int]] = []
        self.now = 0  # the cycle, kept by the machine; edge: that of the access that now happens
        self.edge = 0
        self.mark = -1
        self.raised: set[int] = set()
        self._raised_at: dict[int, int] = {}
        self._enabled_at: dict[int, int] = {}
        self._unmasked_at = 0
        self.taken: int | None = None
        self._frames: list[tuple[int, int]] = []
        self._timer_vectors = {
            vector.number for timer in chip.timers for vector in _vectors(timer).values()
        }
        self._held: dict[int, int] = {}
        self._hooks: list[Any] = []
        self._hook_all(device, chip)

    def _hook_all(self, device: _Foreign, chip: Mcu) -> None:
        handlers: dict[int, Handler] = {_EEDR: self._on_mark, _UDR0: self._on_sent}
        for port in chip.ports:
            output = port.port.address
            handlers[port.pin.address] = partial(self._on_port, output)
            handlers[output] = partial(self._on_port, output)
            handlers[port.ddr.address] = partial(self._on_port, port.ddr.address)
        for timer in chip.timers:
            numbers = {bit: vector.number for bit, vector in _vectors(timer).items()}
            handlers[timer.timsk.address] = partial(self._on_enables, numbers)
        for address in self._watched:
            handlers.setdefault(address, _ignore)
        for address, handler in handlers.items():
            self._hook_writes(device, address, handler)
        self._hook_interrupts(device)

    def _hook_writes(self, device: _Foreign, address: int, handler: Handler) -> None:
        core, watched = self._core, address in self._watched

        class Hook(core.IORegHandler):  # type: ignore[misc, name-defined]  # a class of the library
            def ioreg_read_handler(self, _: object, value: int) -> int:
                return value

            def ioreg_peek_handler(self, _: object, value: int) -> int:
                return value

            def ioreg_write_handler(_, __: object, data: _Foreign) -> None:  # noqa: N805
                handler(address, data.value, data.old)
                if watched:
                    self._record(Kind.REGISTER, self.edge, address, data.value)

        hook = Hook()
        self._hooks.append(hook)
        place = self._place(address)
        device.add_ioreg_handler(place, hook, core.bitmask_t(0), core.IORegister.BitMode.RW)

    def _place(self, address: int) -> _Foreign:
        return self._core.reg_addr_t(address - _IO_OFFSET)

    def _hook_interrupts(self, device: _Foreign) -> None:
        core = self._core
        _, answer = device.ctlreq(core.IOCTL_INTR, core.CTLREQ_GET_SIGNAL)
        hook = core.CallableSignalHook(self._on_interrupt)
        self._hooks.append(hook)
        answer.data.as_ptr(core.Signal).connect(hook)

    def _record(
        self, kind: Kind, cycle: int, source: int, value: int, since: int = 0, until: int = 0
    ) -> None:
        self._rows.append((cycle, since, until, value, source, kind))

    def _on_mark(self, address: int, value: int, _: int) -> None:
        self.mark = value
        self._record(Kind.MARK, self.edge, address, value)

    def _on_sent(self, address: int, value: int, _: int) -> None:
        self._record(Kind.UART, self.edge, address, value)

    def _on_port(self, output: int, *_: int) -> None:
        value = int(self._probe.read_ioreg(self._place(output), False))  # noqa: FBT003 - no CPU
        if value != self._held.get(output, 0):
            self._held[output] = value
            self._record(Kind.PORT, self.edge, output, value)

    def _on_enables(self, vectors: dict[int, int], _: int, value: int, old: int) -> None:
        for bit, vector in vectors.items():
            if value & ~old & 1 << bit:
                self._enabled_at[vector] = self.edge

    def _on_interrupt(self, signal: _Foreign, _: int) -> None:
        state, vector = signal.data.as_uint(), int(signal.index)
        if state in _RAISED:
            self.raised.add(vector)
            self._raised_at[vector] = self.now
            if vector in self._timer_vectors:
                self._record(Kind.RAISE, self.now, vector, 0)
        elif state == _CANCELLED:
            self.raised.discard(vector)
        elif state == _TAKEN:
            self.raised.discard(vector)
            self.taken = vector
        elif state == _RETURNED and self._frames:
            vector, entered = self._frames.pop()
            self._record(Kind.ISR_EXIT, self.now + _RETI_CYCLES, vector, 0, entered)
            self._unmasked_at = self.now + _RETI_CYCLES

    def enter(self, cycle: int, pc: int) -> None:
        """
        Record that the interrupt `taken` is taken at *cycle*.
        """
        vector, self.taken = self.taken, None
        if vector is None:
            return
        since = self._raised_at.get(vector, cycle)
        until = max(since, self._unmasked_at, self._enabled_at.get(vector, 0))
        self._record(Kind.ISR_ENTER, cycle, vector, pc, since, until)
        self._frames.append((vector, cycle))

    def note_masking(self, cycle: int, *, on: bool, fine: bool) -> None:
        """
        Note that the I flag changed at *cycle*; recorded of the main program, if *fine*.
        """
        if on:
            self._unmasked_at = cycle
        if fine and not self._frames:
            self._record(Kind.UNMASKED if on else Kind.MASKED, cycle, 0, 0)

    def clear(self) -> None:
        """
        Forget what was recorded.
        """
        self._rows.clear()

    def events(self) -> Events:
        """
        Return everything that was recorded since `clear`.
        """
        return np.array(self._rows, dtype=EVENT)


def _vectors(timer: Timer) -> dict[int, Vector]:
    """
    Return the vectors of *timer* by their bits in TIMSKn.
    """
    vectors = {0: timer.ovf, 1: timer.compa, 2: timer.compb}
    return vectors | {5: timer.capt} if isinstance(timer, Timer16) else vectors


def _ignore(*_: int) -> None:
    pass

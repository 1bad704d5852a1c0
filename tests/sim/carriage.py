"""
A carriage on the spindle of a motor with STEP and DIR: it presses switches where they stand.
"""

import numpy as np

from stepgen.plan.model import Plan
from stepgen.verify.bench import SWITCH_BITS, drive_switches
from stepgen.verify.events import Kind
from tests.sim.terminal import Terminal

_SLICE_SECONDS = 0.001
"""How often the switches are looked at: at 2400 steps/s the carriage is 3 steps off."""


class Carriage:
    """
    That of the first motor of *plan* on *board*: places are steps from where it stood at reset.

    It presses a switch where that stands and beyond; one at None it never presses.
    """

    def __init__(
        self, board: Terminal, plan: Plan, *, low: int | None = None, high: int | None = None
    ) -> None:
        self.board = board
        self.place = 0
        self.places: list[int] = []  # at each look
        self.low = low
        self.high = high
        self._motor = plan.motors[0]
        step, direction, *_ = (wire.pin.bit for wire in self._motor.drive.every_wire)
        assert step.port == direction.port
        self._step, self._direction = 1 << step.bit, 1 << direction.bit
        self._address = plan.board.mcu.port(step.port).port.address
        self._seen = 0
        self._last = 0
        self._press()

    def wait(self, seconds: float) -> None:
        """
        Let time pass, and the carriage go where the steps take it.
        """
        for _ in range(round(seconds / _SLICE_SECONDS)):
            self.board.wait(_SLICE_SECONDS)
            self._move()
            self._press()
            self.places.append(self.place)

    def _move(self) -> None:
        """
        Count the pulses since the last look: on each rising edge of STEP, DIR LOW is forward.
        """
        events = self.board.machine.events()
        new = events[self._seen :]
        self._seen = len(events)
        writes = new[(new["kind"] == Kind.PORT) & (new["source"] == self._address)]["value"]
        levels = np.concatenate(([self._last], writes.astype(np.int64)))
        self._last = int(levels[-1])
        rises = (levels[1:] & ~levels[:-1] & self._step) != 0
        back = (levels[1:] & self._direction) != 0
        self.place += int(np.sum(rises & ~back)) - int(np.sum(rises & back))

    def _press(self) -> None:
        is_pressed = {
            "low": self.low is not None and self.place <= self.low,
            "high": self.high is not None and self.place >= self.high,
        }
        pressed = sum(SWITCH_BITS[end] for end, is_on in is_pressed.items() if is_on)
        drive_switches(self.board.machine, self._motor, pressed)

"""
A person at the Serial Monitor of a simulated board: reads what comes, and types.
"""

from pathlib import Path

from stepgen.plan.model import Plan
from stepgen.verify.events import Kind
from stepgen.verify.simavr import Machine

_GLANCES_PER_SECOND = 50
_UEDATX = 0xF1  # what a byte over USB comes from; avr-libc's iom32u4.h


class Terminal:
    """
    The program *elf* on the board of *plan*, just out of reset.

    A port over USB is opened as soon as it is there, or with the first line that is typed.
    """

    def __init__(self, elf: Path, plan: Plan, *, opened: bool = True) -> None:
        chip = plan.board.mcu
        self.machine = Machine(elf, mcu=chip.name, f_cpu_hz=plan.board.f_cpu_hz)
        self._f_cpu_hz = plan.board.f_cpu_hz
        self._read = 0
        self._over_usb = chip.has_usb
        self.type = self.machine.send_usb if chip.has_usb else self.machine.send_serial
        if opened:
            self.type(b"")  # opens a port over USB

    @property
    def text(self) -> str:
        """
        Return all that the sketch has printed.
        """
        events = self.machine.events()
        sent = events[events["kind"] == Kind.UART]
        if self._over_usb:
            sent = sent[sent["source"] == _UEDATX]  # what goes to Serial1 is another's
        return bytes(sent["value"].astype("u1")).decode("ascii")

    def wait(self, seconds: float) -> None:
        """
        Let time pass.
        """
        self.machine.run_until(self.machine.cycle + round(seconds * self._f_cpu_hz))

    def until(self, expected: str, *, seconds: float = 0.1) -> str:
        """
        Return what comes up to and including *expected*, from where the last call ended.
        """
        for _ in range(round(seconds * _GLANCES_PER_SECOND) + 1):
            found = self.text.find(expected, self._read)
            if found >= 0:
                begin, self._read = self._read, found + len(expected)
                return self.text[begin : self._read]
            self.wait(1 / _GLANCES_PER_SECOND)
        raise AssertionError(f"{expected!r} never came, but {self.text[self._read :]!r}")

    def enter(self, line: str, expected: str, *, seconds: float = 0.1) -> str:
        """
        Type *line* and Return, and return what comes up to the line *expected*.
        """
        self.type(f"{line}\r\n".encode("ascii"))
        return self.until(f"{expected}\r\n", seconds=seconds)

"""
A person at the Serial Monitor of a simulated board: reads what comes, and types.
"""

from pathlib import Path

from stepgen.plan.model import Plan
from stepgen.verify.events import Kind
from stepgen.verify.simavr import Machine

_GLANCES_PER_SECOND = 50


class Terminal:
    """
    The program *elf* on the board of *plan*, just out of reset.
    """

    def __init__(self, elf: Path, plan: Plan) -> None:
        self.machine = Machine(elf, mcu=plan.board.mcu.name, f_cpu_hz=plan.board.f_cpu_hz)
        self._f_cpu_hz = plan.board.f_cpu_hz
        self._read = 0

    @property
    def text(self) -> str:
        """
        Return all that the sketch has printed.
        """
        events = self.machine.events()
        sent = events[events["kind"] == Kind.UART]
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
        self.machine.send_serial(f"{line}\r\n".encode("ascii"))
        return self.until(f"{expected}\r\n", seconds=seconds)

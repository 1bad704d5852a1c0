"""
What every simulated machine has of its program, whichever simulator runs it.
"""

from abc import ABC, abstractmethod
from pathlib import Path
from types import TracebackType
from typing import Self

from stepgen.errors import StepgenError
from stepgen.verify.elf import read_firmware


class Loaded(ABC):
    """
    A program with its symbols, in something that is closed where a ``with`` ends.

    Args:
        elf: The program, as avr-gcc links it.

    Raises:
        StepgenError: It is no program.
    """

    def __init__(self, elf: Path) -> None:
        firmware = read_firmware(elf)
        self._elf, self._image, self._symbols = elf, firmware.image, firmware.symbols

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    @abstractmethod
    def close(self) -> None:
        """
        Free what is held; more than once does no harm.
        """

    @property
    @abstractmethod
    def cycle(self) -> int:
        """
        Return the CPU clocks since reset.
        """

    @abstractmethod
    def run_until(self, cycle: int) -> None:
        """
        Run to the first instruction boundary at or after *cycle*.
        """

    @abstractmethod
    def read_ram(self, address: int, size: int) -> bytes:
        """
        Return *size* bytes of RAM from data address *address* on.
        """

    def run_until_zero(self, address: int, *, step_cycles: int, limit_cycles: int) -> bool:
        """
        Run until the byte of RAM at *address* is 0; return False after *limit_cycles* more.

        It is looked at each *step_cycles*.
        """
        until = self.cycle + limit_cycles
        while self.read_ram(address, 1)[0]:
            if self.cycle > until:
                return False
            self.run_until(self.cycle + step_cycles)
        return True

    def send_usb(self, data: bytes) -> None:
        """
        Let a program at the computer open the board's port over USB, and send *data* there.

        Raises:
            StepgenError: The simulator has no computer for that; only simavr has one.
        """
        raise StepgenError.of("no computer at its USB is simulated", text=data.decode("latin-1"))

    def symbol(self, name: str) -> int:
        """
        Return the data address of a variable, or the byte address in flash of a function.

        Raises:
            StepgenError: The program has no such symbol.
        """
        if name not in self._symbols:
            raise StepgenError.of("no such symbol", place=str(self._elf), text=name)
        return self._symbols[name]

"""
One simulated chip that runs one program in avr8js.
"""

import base64
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from stepgen.devices import boards
from stepgen.errors import StepgenError
from stepgen.verify.avr8js.config import describe
from stepgen.verify.avr8js.node import Driver
from stepgen.verify.events import EVENT, Events
from stepgen.verify.loaded import Loaded

_NO_MARK = -1


class Machine(Loaded):
    """
    An ATmega328P, 32U4, 1280 or 2560 with a program in its flash, just out of reset.

    Args:
        elf: The program, as avr-gcc links it.
        mcu: The name of a chip of the device tables.
        f_cpu_hz: Clock of the CPU.
        watch: Data addresses of I/O registers whose writes are recorded as REGISTER.
        correct: Whether the driver puts right what avr8js does unlike the chip.

    Raises:
        StepgenError: No such chip, no program, or no avr8js.
    """

    isr_stack: dict[int, int] = {}  # noqa: RUF012 - not measured, and nobody writes to it

    def __init__(
        self,
        elf: Path,
        *,
        mcu: str,
        f_cpu_hz: int,
        watch: Iterable[int] = (),
        correct: bool = True,
    ) -> None:
        chip = next((board.mcu for board in boards() if board.mcu.name == mcu), None)
        if chip is None:
            raise StepgenError.of("no board has this chip", text=mcu)
        super().__init__(elf)
        self._fine = False
        self._ports = {port.pin.address: port.port.address for port in chip.ports}
        self._cycle = 0
        self._driver = Driver()
        self._driver.ask(
            "open",
            **describe(chip),
            f_cpu_hz=f_cpu_hz,
            image=base64.b64encode(self._image).decode(),
            image_bytes=len(self._image),
            watch=list(watch),
            correct=correct,
        )

    def __del__(self) -> None:
        self.close()

    def close(self) -> None:
        """
        End the simulation.
        """
        driver: Driver | None = getattr(self, "_driver", None)
        if driver:
            driver.close()

    @property
    def cycle(self) -> int:
        """
        CPU clocks since reset.
        """
        return self._cycle

    @property
    def fine(self) -> bool:
        """
        Whether MASKED and UNMASKED are recorded.
        """
        return self._fine

    @fine.setter
    def fine(self, on: bool) -> None:
        self._fine = on
        self._driver.ask("fine", on=on)

    def run_until(self, cycle: int) -> None:
        """
        Run to the first instruction boundary at or after *cycle*.

        Raises:
            StepgenError: The program crashed.
        """
        self._run(cycle, _NO_MARK)

    def run_until_mark(self, value: int, *, limit_cycles: int) -> bool:
        """
        Run until the program writes *value* to EEDR; return False after *limit_cycles* more.

        Raises:
            StepgenError: As of `run_until`.
        """
        return self._run(self.cycle + limit_cycles, value)

    def _run(self, until: int, mark: int) -> bool:
        done = self._driver.ask("run", until=until, mark=mark)
        self._cycle = int(done["cycle"])
        if done["error"]:
            where = f"cycle {self.cycle}, PC {done['pc']:#x}"
            reason = done["error"]
            raise StepgenError.of(f"the program crashed at {where}: {reason}", place=str(self._elf))
        return bool(done["marked"])

    def read_ram(self, address: int, size: int) -> bytes:
        """
        Return *size* bytes of RAM from data address *address* on.
        """
        return bytes(self._driver.ask("read", address=address, size=size)["bytes"])

    def write_ram(self, address: int, data: bytes) -> None:
        """
        Put *data* into RAM from data address *address* on, between two instructions.
        """
        self._driver.ask("write", address=address, bytes=list(data))

    def register(self, address: int) -> int:
        """
        Return what an I/O register (data address) holds now; reading disturbs nothing.
        """
        return int(self._driver.ask("register", address=address)["value"])

    def send_serial(self, data: bytes) -> None:
        """
        Let *data* arrive at the first USART, one byte after the other.
        """
        self._driver.ask("send", bytes=list(data))

    def drive_pin(self, pin_address: int, bit: int, *, high: bool) -> None:
        """
        Pull the pin *bit* of the port whose PINx is at *pin_address* high or low from outside.
        """
        self._driver.ask("drive", port=self._ports[pin_address], bit=bit, high=high)

    def events(self) -> Events:
        """
        Return everything that was recorded since `clear_events`, dtype EVENT.
        """
        answer = self._driver.ask("events")
        rows = np.frombuffer(base64.b64decode(answer["rows"]), dtype="<f8")
        columns = rows.reshape(-1, answer["fields"]).T
        events = np.empty(len(rows) // answer["fields"], dtype=EVENT)
        for name, column in zip(EVENT.names or (), columns, strict=True):
            events[name] = column
        return events

    def clear_events(self) -> None:
        """
        Forget what was recorded.
        """
        self._driver.ask("clear")

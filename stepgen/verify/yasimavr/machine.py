"""
One simulated ATmega328P that runs one program in yasimavr.
"""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from stepgen.devices import boards
from stepgen.errors import StepgenError
from stepgen.verify.events import Events
from stepgen.verify.loaded import Loaded
from stepgen.verify.yasimavr import library
from stepgen.verify.yasimavr.cpu import Cpu


class Machine(Loaded):
    """
    An ATmega328P with a program in its flash, just out of reset.

    Args:
        elf: The program, as avr-gcc links it.
        mcu: `atmega328p`; yasimavr has no ATmega2560.
        f_cpu_hz: Clock of the CPU.
        watch: Data addresses of I/O registers whose writes are recorded as REGISTER.
        correct: Whether what yasimavr does unlike the chip is put right.

    Raises:
        StepgenError: No such chip, no program, or no yasimavr.
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
        self._core, devices = library.load()
        chip = next((board.mcu for board in boards() if board.mcu.name == mcu), None)
        if chip is None or mcu not in devices.model_list():
            raise StepgenError.of("yasimavr has no such chip", text=mcu)
        super().__init__(elf)
        self._chip = chip
        self._device: Any = devices.load_device(mcu)
        self._cpu = Cpu(
            self._core,
            self._device,
            chip,
            elf=elf,
            image=self._image,
            f_cpu_hz=f_cpu_hz,
            watched=set(watch),
            correct=correct,
        )

    def close(self) -> None:
        """
        Let go of the device.
        """
        self._cpu.probe.detach()

    @property
    def cycle(self) -> int:
        """
        CPU clocks since reset.
        """
        return self._cpu.cycle

    @property
    def fine(self) -> bool:
        """
        Whether MASKED and UNMASKED are recorded.
        """
        return self._cpu.fine

    @fine.setter
    def fine(self, on: bool) -> None:
        self._cpu.fine = on

    def run_until(self, cycle: int) -> None:
        """
        Run to the first instruction boundary at or after *cycle*.

        Raises:
            StepgenError: The program crashed.
        """
        self._cpu.run(cycle)

    def run_until_mark(self, value: int, *, limit_cycles: int) -> bool:
        """
        Run until the program writes *value* to EEDR; return False after *limit_cycles* more.

        Raises:
            StepgenError: As of `run_until`.
        """
        return self._cpu.run(self.cycle + limit_cycles, value)

    def read_ram(self, address: int, size: int) -> bytes:
        """
        Return *size* bytes of RAM from data address *address* on.
        """
        return bytes(self._cpu.probe.read_data(address, size))

    def write_ram(self, address: int, data: bytes) -> None:
        """
        Put *data* into RAM from data address *address* on, between two instructions.
        """
        self._cpu.probe.write_data(address, data)

    def register(self, address: int) -> int:
        """
        Return what an I/O register (data address) holds now; reading disturbs nothing.
        """
        return self._cpu.register(address)

    def send_serial(self, data: bytes) -> None:
        """
        Let *data* arrive at USART0.
        """
        request = self._core.ctlreq_data_t()
        request.data = self._core.vardata_t(data)
        core = self._core
        self._device.ctlreq(core.IOCTL_UART("0"), core.CTLREQ_USART_BYTES, request)

    def drive_pin(self, pin_address: int, bit: int, *, high: bool) -> None:
        """
        Pull the pin *bit* of the port whose PINx is at *pin_address* high or low from outside.
        """
        letter = next(port.letter for port in self._chip.ports if port.pin.address == pin_address)
        pin = self._device.find_pin(f"P{letter}{bit}")
        pin.set_external_state("H" if high else "L")

    def events(self) -> Events:
        """
        Return everything that was recorded since `clear_events`, dtype EVENT.
        """
        return self._cpu.recorder.events()

    def clear_events(self) -> None:
        """
        Forget what was recorded.
        """
        self._cpu.recorder.clear()

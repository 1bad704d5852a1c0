"""
One simulated chip that runs one program.
"""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from stepgen.errors import StepgenError
from stepgen.verify.events import EVENT, Events
from stepgen.verify.loaded import Loaded
from stepgen.verify.simavr import build

_NO_MARK = -1
_FIRST_RAM_ADDRESS = 0x100
_VECTORS = 64


class Machine(Loaded):
    """
    An ATmega328P, 32U4, 1280 or 2560 with a program in its flash, just out of reset.

    Args:
        elf: The program, as avr-gcc links it.
        mcu: `atmega328p`, `atmega32u4`, `atmega1280` or `atmega2560`.
        f_cpu_hz: Clock of the CPU; only simavr's own peripherals (UART, ADC) look at it.
        watch: Data addresses of I/O registers whose writes are recorded as REGISTER.

    Raises:
        StepgenError: No such chip, no such register, no program, or no simulator.
    """

    def __init__(self, elf: Path, *, mcu: str, f_cpu_hz: int, watch: Iterable[int] = ()) -> None:
        module = build.load()
        self._ffi: Any = module.ffi
        self._lib: Any = module.lib
        super().__init__(elf)
        self._fine = False
        image = self._image
        self._machine: Any = self._lib.machine_new(mcu.encode(), f_cpu_hz, image, len(image))
        if not self._machine:
            raise StepgenError.of(
                "this chip cannot be simulated; the harness knows atmega328p, atmega32u4, "
                "atmega1280 and atmega2560",
                text=mcu,
            )
        # The events outlive the machine as long as someone looks at them.
        region = self._lib.events_map(self._machine)
        if not region:
            raise StepgenError.of("no address space left for recording: close other machines")
        self._region: Any = self._ffi.gc(region, self._lib.events_unmap)
        for address in watch:
            if not self._lib.machine_watch(self._machine, address):
                raise StepgenError.of("only I/O registers can be watched", text=f"{address:#x}")

    def __del__(self) -> None:
        self.close()

    def close(self) -> None:
        """
        Free the machine; arrays of events that are still in use stay valid.
        """
        machine = getattr(self, "_machine", None)
        self._machine = None
        if machine:
            self._lib.machine_free(machine)

    @property
    def _open(self) -> Any:  # noqa: ANN401  # a cffi pointer has no type of its own
        if not self._machine:
            raise StepgenError.of("the machine is closed", place=str(self._elf))
        return self._machine

    @property
    def cycle(self) -> int:
        """
        CPU clocks since reset.
        """
        return int(self._lib.machine_cycle(self._open))

    @property
    def fine(self) -> bool:
        """
        Whether each instruction is looked at alone, to record MASKED and UNMASKED; slower.
        """
        return self._fine

    @fine.setter
    def fine(self, on: bool) -> None:
        self._fine = on
        self._lib.machine_set_fine(self._open, on)

    def record(self, *, on: bool) -> None:
        """
        Record events, as from the start, or none: a benchmark wants to know what that costs.
        """
        self._lib.machine_set_recording(self._open, on)

    def run_until(self, cycle: int) -> None:
        """
        Run to the first instruction boundary at or after *cycle*.

        Raises:
            StepgenError: The program crashed: bad opcode, wild write, sleep without interrupts.
        """
        self._run(cycle, _NO_MARK)

    def run_until_mark(self, value: int, *, limit_cycles: int) -> bool:
        """
        Run until the program writes *value* to EEDR; return False after *limit_cycles* more.

        Raises:
            StepgenError: As of `run_until`.
        """
        return self._run(self.cycle + limit_cycles, value)

    def reset(self, cause: int) -> None:
        """
        Reset the chip now, with RAM as it is; *cause* is the bit that MCUSR gets.
        """
        self._lib.machine_reset(self._open, cause)

    def run_until_zero(self, address: int, *, step_cycles: int, limit_cycles: int) -> bool:
        """
        Run until the byte of RAM at *address* is 0, as `Loaded` does, but far faster.

        Raises:
            StepgenError: As of `run_until`.
        """
        until = self.cycle + limit_cycles
        return self._judge(self._lib.machine_run_to_zero(self._open, address, step_cycles, until))

    def _run(self, until: int, mark: int) -> bool:
        return self._judge(self._lib.machine_run(self._open, until, mark))

    def _judge(self, result: int) -> bool:
        if result == self._lib.RUN_FAILED:
            reason = self._ffi.string(self._lib.machine_error(self._machine)).decode().strip()
            where = f"cycle {self.cycle}, PC {self._lib.machine_pc(self._machine):#x}"
            raise StepgenError.of(f"the program crashed at {where}: {reason}", place=str(self._elf))
        return bool(result == self._lib.RUN_MARKED)

    def _ram(self, address: int, size: int) -> Any:  # noqa: ANN401  # a cffi buffer
        end = int(self._lib.machine_ram_end(self._open))
        if address < _FIRST_RAM_ADDRESS or size < 0 or address + size > end + 1:
            raise StepgenError.of(
                f"no RAM there: it goes from {_FIRST_RAM_ADDRESS:#x} to {end:#x}",
                text=f"{size} bytes at {address:#x}",
            )
        return self._ffi.buffer(self._lib.machine_data(self._machine) + address, size)

    def read_ram(self, address: int, size: int) -> bytes:
        """
        Return *size* bytes of RAM from data address *address* on.
        """
        return bytes(self._ram(address, size))

    def write_ram(self, address: int, data: bytes) -> None:
        """
        Put *data* into RAM from data address *address* on, between two instructions.
        """
        self._ram(address, len(data))[:] = data

    def register(self, address: int) -> int:
        """
        Return what an I/O register (data address) holds now; reading disturbs nothing.
        """
        if not 0 <= address <= self._lib.machine_ram_end(self._open):
            raise StepgenError.of("not in the data space", text=f"{address:#x}")
        return int(self._lib.machine_register(self._machine, address))

    def send_serial(self, data: bytes) -> None:
        """
        Let *data* arrive at the first USART, one byte per byte time, from when its receiver is on.
        """
        self._lib.machine_send_serial(self._open, data, len(data))

    @property
    def serial_waiting(self) -> int:
        """
        How many bytes of `send_serial` have not arrived yet.
        """
        return int(self._lib.machine_serial_waiting(self._open))

    @property
    def serial_lost(self) -> int:
        """
        How many bytes of `send_serial` came while three were still unread.
        """
        return int(self._lib.machine_serial_lost(self._open))

    def send_usb(self, data: bytes) -> None:
        """
        Let a program at the computer open the board's port over USB, once, and send *data* there.

        What it takes from the board is recorded as UART.
        """
        self._lib.machine_send_usb(self._open, data, len(data))

    @property
    def usb_waiting(self) -> int:
        """
        How many bytes of `send_usb` the board has not taken yet.
        """
        return int(self._lib.machine_usb_waiting(self._open))

    def drive_pin(self, pin_address: int, bit: int, *, high: bool) -> None:
        """
        Pull the pin *bit* of the port whose PINx is at *pin_address* high or low from outside.
        """
        if not self._lib.machine_drive_pin(self._open, pin_address, bit, high):
            raise StepgenError.of("no PINx register there", text=f"{pin_address:#x}")

    def events(self) -> Events:
        """
        Return what was recorded since `clear_events`: a read-only view, dtype EVENT, no copy.

        Valid until the next `clear_events`, after which new events overwrite it.
        """
        count = int(self._lib.events_count(self._open))
        view = np.frombuffer(self._ffi.buffer(self._region, count * EVENT.itemsize), dtype=EVENT)
        view.flags.writeable = False
        return view

    def clear_events(self) -> None:
        """
        Forget what was recorded; views handed out before must no longer be used.
        """
        self._lib.events_clear(self._open)

    @property
    def isr_stack(self) -> dict[int, int]:
        """
        Most stack bytes that each vector ever took, from its return address down.
        """
        used = {v: int(self._lib.machine_isr_stack(self._open, v)) for v in range(_VECTORS)}
        return {vector: size for vector, size in used.items() if size}

    @property
    def stack_deepest(self) -> int:
        """
        Most stack bytes that the whole program ever took.
        """
        return int(self._lib.machine_stack_deepest(self._open))

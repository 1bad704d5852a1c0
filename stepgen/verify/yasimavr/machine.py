"""
One simulated ATmega328P that runs one program in yasimavr, instruction by instruction.

What yasimavr leaves out or does unlike the chip is put right here: the interrupt response of 4
cycles and the 4 of waking up; the instruction that runs between SEI and an interrupt; RCALL, which
takes 3 cycles; SBI of a register of strobes; the cycle within an instruction at which it reaches a
register (yasimavr takes its first); and a tick at the very edge of an access counts before it.
"""

from collections.abc import Iterable
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from stepgen.devices import Mcu, boards
from stepgen.errors import StepgenError
from stepgen.verify.elf import read_firmware
from stepgen.verify.events import Events
from stepgen.verify.yasimavr import library
from stepgen.verify.yasimavr.opcodes import FIRST_RAM_ADDRESS, Effect, classify, pointer_of
from stepgen.verify.yasimavr.recorder import Recorder

_NO_MARK = -1
_WAKE_CYCLES = 4
_INTERRUPTS_ON = 0x80
_IO_OFFSET = 0x20
_TIMER_REGISTERS = 14  # TCCRnA to OCRnC, or to what would be it
_LONG_MASK, _LONG = 0xFC0F, 0x9000  # lds and sts
_IN_SREG_MASK, _IN_SREG = 0xFE0F, 0xB60F  # in Rd, SREG
# Cycles into an instruction at which it reaches the register.
_ACCESS_CYCLES: dict[int, int] = {
    Effect.STORE_1: 1,
    Effect.STORE_2: 2,
    Effect.SET_BIT: 2,
    Effect.LOAD_2: 1,
}
_CORRECTED = {*_ACCESS_CYCLES, Effect.SHORT_CALL}


class Machine:
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
        self._core, self._devices = library.load()
        self._elf, self._correct = elf, correct
        self._chip = self._chip_called(mcu)
        firmware = read_firmware(elf)
        self._symbols = firmware.symbols
        self._image = firmware.image
        self._effects = classify(firmware.image)
        self._strobes = {port.pin.address for port in self._chip.ports} | {
            timer.tifr.address for timer in self._chip.timers16
        }
        self._timer_registers = {
            timer.tccra.address + offset
            for timer in self._chip.timers16
            for offset in range(_TIMER_REGISTERS)
        }
        self.cycle = 0
        self.fine = False
        self._waking = 0
        self._interrupts_on = self._just_changed = self._asleep = False
        self._start(mcu, f_cpu_hz)
        self._recorder = Recorder(self._core, self._device, self._probe, self._chip, set(watch))

    def _chip_called(self, mcu: str) -> Mcu:
        chip = next((board.mcu for board in boards() if board.mcu.name == mcu), None)
        if chip is None or mcu not in self._devices.model_list():
            raise StepgenError.of("yasimavr has no such chip", text=mcu)
        return chip

    def _start(self, mcu: str, f_cpu_hz: int) -> None:
        core = self._core
        self._device: Any = self._devices.load_device(mcu)
        loop = core.SimLoop(self._device)
        image = core.Firmware.read_elf(str(self._elf))
        image.frequency = f_cpu_hz
        self._device.load_firmware(image)
        options = core.Device.Option
        self._device.set_option(options.InfiniteLoopDetect, False)
        self._device.set_option(options.DisablePseudoSleep, True)
        self._device.set_option(options.IgnoreBadCpuIO, True)
        self._loop = loop  # it owns the cycle manager
        self._manager: Any = loop.cycle_manager()
        self._probe: Any = core.DeviceDebugProbe(self._device)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        """
        Let go of the device.
        """
        self._probe.detach()

    def run_until(self, cycle: int) -> None:
        """
        Run to the first instruction boundary at or after *cycle*.

        Raises:
            StepgenError: The program crashed.
        """
        self._go(cycle, _NO_MARK)

    def run_until_mark(self, value: int, *, limit_cycles: int) -> bool:
        """
        Run until the program writes *value* to EEDR; return False after *limit_cycles* more.

        Raises:
            StepgenError: As of `run_until`.
        """
        return self._go(self.cycle + limit_cycles, value)

    def _go(self, until: int, mark: int) -> bool:
        recorder = self._recorder
        recorder.mark = _NO_MARK
        while self.cycle < until:
            if self._asleep:
                self._doze(until)
            else:
                self._step()
            if mark != _NO_MARK and recorder.mark == mark:
                return True
        if self._device.state() == self._core.Device.State.Crashed:
            self._crash(self._probe.read_pc())
        return False

    def _step(self) -> None:
        """
        Run one instruction, or take an interrupt and run the first one of its vector.
        """
        pc = self._probe.read_pc()
        effect = self._effects[pc >> 1] if pc >> 1 < len(self._effects) else self._crash(pc)
        waits = bool(self._recorder.raised) and self._interrupts_on
        if waits and self._just_changed and self._correct:
            self._run_uninterrupted(effect, pc)
        elif waits:
            effect = Effect.PLAIN  # not this instruction runs, but the vector's
            self._run(Effect.PLAIN, pc)
        else:
            self._run(effect, pc)
        if effect == Effect.PLAIN:
            self._just_changed = False
            return
        self._just_changed = effect in {Effect.FLAGS, Effect.RETURN}
        if self._just_changed:
            self._note_flags(fine=self.fine and effect == Effect.FLAGS)
        elif effect == Effect.SLEEP:
            self._asleep = self._device.state() == self._core.Device.State.Sleeping

    def _run_uninterrupted(self, effect: int, pc: int) -> None:
        """
        Run the one instruction that comes between SEI or RETI and a waiting interrupt.
        """
        probe, opcode = self._probe, self._word(pc)
        probe.write_sreg(probe.read_sreg() & ~_INTERRUPTS_ON)
        self._run(effect, pc)
        if effect != Effect.FLAGS:
            probe.write_sreg(probe.read_sreg() | _INTERRUPTS_ON)
        if opcode & _IN_SREG_MASK == _IN_SREG:
            register = opcode >> 4 & 0x1F
            probe.write_gpreg(register, probe.read_gpreg(register) | _INTERRUPTS_ON)

    def _run(self, effect: int, pc: int) -> None:
        self._recorder.edge = self.cycle + _ACCESS_CYCLES.get(effect, 1)
        if effect == Effect.PLAIN or not self._correct or effect not in _CORRECTED:
            self._finish(self._device.exec_cycle(), pc)
        elif effect == Effect.SHORT_CALL:
            self._finish(self._device.exec_cycle() - 1, pc)
        else:
            self._access(effect, pc)

    def _access(self, effect: int, pc: int) -> None:
        """
        Run an instruction that reaches a register some cycles after its start.
        """
        ahead, address = _ACCESS_CYCLES[effect], self._address(pc)
        if address >= FIRST_RAM_ADDRESS:
            self._finish(self._device.exec_cycle(), pc)
            return
        self._advance(ahead)
        if effect == Effect.SET_BIT and (strobe := self._strobe(pc)):
            self._probe.write_ioreg(self._place(strobe[0]), 1 << strobe[1])
            self._probe.write_pc(pc + 2)
            return
        if address in self._timer_registers:
            self._manager.increment_cycle(1)
        flags = self._probe.read_sreg()
        # An interrupt that was raised on the way waits for the end of the instruction.
        self._probe.write_sreg(flags & ~_INTERRUPTS_ON)
        taken = self._device.exec_cycle()
        self._probe.write_sreg(flags)
        self._finish(taken - ahead, pc)

    def _strobe(self, pc: int) -> tuple[int, int] | None:
        """
        Return address and bit that the SBI at *pc* writes, if a one does something there.
        """
        address, bit = (self._image[pc] >> 3) + _IO_OFFSET, self._image[pc] & 7
        return (address, bit) if address in self._strobes else None

    def _address(self, pc: int) -> int:
        """
        Return the data address that the LD, ST, LDS or STS at *pc* reaches, 0 of another one.
        """
        opcode = self._word(pc)
        pointer = pointer_of(opcode)
        if pointer is not None:
            low, offset = pointer
            read = self._probe.read_gpreg
            return int(read(low) | read(low + 1) << 8) + offset
        return self._word(pc + 2) if opcode & _LONG_MASK == _LONG else 0

    def _word(self, pc: int) -> int:
        return int.from_bytes(self._image[pc : pc + 2], "little")

    def _finish(self, cycles: int, pc: int) -> None:
        """
        Let the rest of an instruction pass, and the response if an interrupt was taken before it.
        """
        if cycles < 0:
            self._crash(pc)
        if self._recorder.taken is None:
            self._advance(cycles)
            return
        self._recorder.enter(self.cycle, pc)
        self._interrupts_on = False
        response = self._chip.response_cycles + self._waking if self._correct else 0
        self._waking = 0
        self._advance(cycles + response)

    def _advance(self, cycles: int) -> None:
        """
        Let *cycles* pass, stopping at each at which a timer of the device is due.
        """
        manager, target = self._manager, self.cycle + cycles
        due = manager.next_when()
        while 0 < due <= target:
            manager.increment_cycle(max(0, due - manager.cycle()))
            self._recorder.now = max(due, self.cycle)
            manager.process_timers()
            due = manager.next_when()
        # The manager is a cycle ahead where an access to a timer has just been made.
        manager.increment_cycle(max(0, target - manager.cycle()))
        self.cycle = self._recorder.now = target

    def _note_flags(self, *, fine: bool) -> None:
        on = bool(self._probe.read_sreg() & _INTERRUPTS_ON)
        if on != self._interrupts_on:
            self._recorder.note_masking(self.cycle, on=on, fine=fine)
        self._interrupts_on = on

    def _doze(self, until: int) -> None:
        """
        Sleep until the next timer of the device is due; an interrupt ends it.
        """
        due = self._manager.next_when()
        if not self._interrupts_on:
            self._crash(self._probe.read_pc(), "asleep with interrupts off, for ever")
        self._advance(max(1, min(due if due > 0 else until, until) - self.cycle))
        if self._recorder.raised:
            self._asleep = False
            self._waking = _WAKE_CYCLES

    def _crash(self, pc: int, reason: str = "yasimavr stopped, or the program left its code") -> int:
        raise StepgenError.of(
            f"the program crashed at cycle {self.cycle}, PC {pc:#x}: {reason}",
            place=str(self._elf),
        )

    def read_ram(self, address: int, size: int) -> bytes:
        """
        Return *size* bytes of RAM from data address *address* on.
        """
        return bytes(self._probe.read_data(address, size))

    def write_ram(self, address: int, data: bytes) -> None:
        """
        Put *data* into RAM from data address *address* on, between two instructions.
        """
        self._probe.write_data(address, data)

    def register(self, address: int) -> int:
        """
        Return what an I/O register (data address) holds now; reading disturbs nothing.
        """
        return int(self._probe.read_ioreg(self._place(address), False))  # noqa: FBT003 - no CPU

    def _place(self, address: int) -> Any:  # noqa: ANN401 - a type of the library
        return self._core.reg_addr_t(address - _IO_OFFSET)

    def symbol(self, name: str) -> int:
        """
        Return the data address of a variable, or the byte address in flash of a function.
        """
        if name not in self._symbols:
            raise StepgenError.of("no such symbol", place=str(self._elf), text=name)
        return self._symbols[name]

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
        Return everything that was recorded since reset, dtype EVENT.
        """
        return self._recorder.events()

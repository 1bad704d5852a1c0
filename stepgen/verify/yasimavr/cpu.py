"""
The CPU of one simulated chip in yasimavr, run instruction by instruction.

What yasimavr leaves out or does unlike the chip is put right here: the interrupt response of 4
cycles and the 4 of waking up; the instruction that runs between SEI and an interrupt; RCALL, which
takes 3 cycles; SBI of a register of strobes; the cycle within an instruction at which it reaches a
register (yasimavr takes its first); and a tick at the very edge of an access counts before it.
"""

from pathlib import Path
from types import ModuleType
from typing import Any, NoReturn

from stepgen.devices import Mcu
from stepgen.errors import StepgenError
from stepgen.verify.yasimavr.opcodes import FIRST_RAM_ADDRESS, Effect, classify, pointer_of
from stepgen.verify.yasimavr.recorder import Recorder

NO_MARK = -1
_WAKE_CYCLES = 4
_INTERRUPTS_ON = 0x80
_IO_OFFSET = 0x20
_TIMER_REGISTERS = {1: 5, 2: 14}  # by bytes of the counter: TCCRnA to OCRnB, or to OCRnC
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


class Cpu:
    """
    A device of the library, and the loop that runs it.

    Args:
        core: The module yasimavr.lib.core.
        device: A device without a program.
        chip: Facts of the chip.
        elf: The program; *image* is its flash.
        f_cpu_hz: Clock of the CPU.
        watched: Data addresses of I/O registers whose writes are recorded as REGISTER.
        correct: Whether what yasimavr does unlike the chip is put right.
    """

    def __init__(  # noqa: PLR0913 - a chip, its program, and what to look at
        self,
        core: ModuleType,
        device: Any,  # noqa: ANN401 - a type of the library
        chip: Mcu,
        *,
        elf: Path,
        image: bytes,
        f_cpu_hz: int,
        watched: set[int],
        correct: bool,
    ) -> None:
        self._core, self._device, self._chip = core, device, chip
        self._elf, self._image, self._correct = elf, image, correct
        self._effects = classify(image)
        self._strobes = {port.pin.address for port in chip.ports} | {
            timer.tifr.address for timer in chip.timers
        }
        self._timer_registers = {
            timer.tccra.address + offset
            for timer in chip.timers
            for offset in range(_TIMER_REGISTERS[timer.counter_bytes])
        }
        self.cycle = 0
        self.fine = False
        self._waking = 0
        self._interrupts_on = self._just_changed = self._asleep = False
        self._load(f_cpu_hz)
        self.recorder = Recorder(core, device, self.probe, chip, watched)

    def _load(self, f_cpu_hz: int) -> None:
        self._loop = self._core.SimLoop(self._device)  # it owns the cycle manager
        self._manager: Any = self._loop.cycle_manager()
        firmware = self._core.Firmware.read_elf(str(self._elf))
        firmware.frequency = f_cpu_hz
        self._device.load_firmware(firmware)
        options = self._core.Device.Option
        self._device.set_option(options.InfiniteLoopDetect, False)  # noqa: FBT003 - the library's
        self._device.set_option(options.DisablePseudoSleep, True)  # noqa: FBT003 - the same
        self._device.set_option(options.IgnoreBadCpuIO, True)  # noqa: FBT003 - the same
        self.probe: Any = self._core.DeviceDebugProbe(self._device)

    def register(self, address: int) -> int:
        """
        Return what the register at data address *address* holds; reading disturbs nothing.
        """
        return int(self.probe.read_ioreg(self._place(address), False))  # noqa: FBT003 - no CPU

    def _place(self, address: int) -> Any:  # noqa: ANN401 - a type of the library
        return self._core.reg_addr_t(address - _IO_OFFSET)

    def run(self, until: int, mark: int = NO_MARK) -> bool:
        """
        Run until the cycle *until*, or until *mark* is written to EEDR; return whether it was.

        Raises:
            StepgenError: The program crashed.
        """
        recorder = self.recorder
        recorder.mark = NO_MARK
        while self.cycle < until:
            if self._asleep:
                self._doze(until)
            else:
                self._step()
            if mark != NO_MARK and recorder.mark == mark:
                return True
        if self._device.state() == self._core.Device.State.Crashed:
            self._crash(self.probe.read_pc())
        return False

    def _step(self) -> None:
        """
        Run one instruction, or take an interrupt and run the first one of its vector.
        """
        pc = self.probe.read_pc()
        effect = self._effects[pc >> 1] if pc >> 1 < len(self._effects) else self._crash(pc)
        waits = bool(self.recorder.raised) and self._interrupts_on
        if waits and self._just_changed and self._correct:
            self._run_uninterrupted(effect, pc)
        elif waits:
            effect = Effect.PLAIN  # not this instruction runs, but the vector's
            self._execute(Effect.PLAIN, pc)
        else:
            self._execute(effect, pc)
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
        probe, opcode = self.probe, self._word(pc)
        probe.write_sreg(probe.read_sreg() & ~_INTERRUPTS_ON)
        self._execute(effect, pc)
        if effect != Effect.FLAGS:
            probe.write_sreg(probe.read_sreg() | _INTERRUPTS_ON)
        if opcode & _IN_SREG_MASK == _IN_SREG:
            register = opcode >> 4 & 0x1F
            probe.write_gpreg(register, probe.read_gpreg(register) | _INTERRUPTS_ON)

    def _execute(self, effect: int, pc: int) -> None:
        self.recorder.edge = self.cycle + _ACCESS_CYCLES.get(effect, 1)
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
            self.probe.write_ioreg(self._place(strobe[0]), 1 << strobe[1])
            self.probe.write_pc(pc + 2)
            return
        if address in self._timer_registers:
            self._manager.increment_cycle(1)
        flags = self.probe.read_sreg()
        # An interrupt that was raised on the way waits for the end of the instruction.
        self.probe.write_sreg(flags & ~_INTERRUPTS_ON)
        taken = self._device.exec_cycle()
        self.probe.write_sreg(flags)
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
            read = self.probe.read_gpreg
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
        if self.recorder.taken is None:
            self._advance(cycles)
            return
        self.recorder.enter(self.cycle, pc)
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
            self.recorder.now = max(due, self.cycle)
            manager.process_timers()
            due = manager.next_when()
        # The manager is a cycle ahead where an access to a timer has just been made.
        manager.increment_cycle(max(0, target - manager.cycle()))
        self.cycle = self.recorder.now = target

    def _note_flags(self, *, fine: bool) -> None:
        on = bool(self.probe.read_sreg() & _INTERRUPTS_ON)
        if on != self._interrupts_on:
            self.recorder.note_masking(self.cycle, on=on, fine=fine)
        self._interrupts_on = on

    def _doze(self, until: int) -> None:
        """
        Sleep until the next timer of the device is due; an interrupt ends it.
        """
        due = self._manager.next_when()
        if not self._interrupts_on:
            self._crash(self.probe.read_pc(), "asleep with interrupts off, for ever")
        self._advance(max(1, min(due if due > 0 else until, until) - self.cycle))
        if self.recorder.raised:
            self._asleep = False
            self._waking = _WAKE_CYCLES

    def _crash(
        self, pc: int, reason: str = "yasimavr stopped, or the program left its code"
    ) -> NoReturn:
        raise StepgenError.of(
            f"the program crashed at cycle {self.cycle}, PC {pc:#x}: {reason}",
            place=str(self._elf),
        )

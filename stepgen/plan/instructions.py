"""
Instructions of the hot path with their cycles (AVR instruction set manual), and what they use.
"""

from collections.abc import Iterable
from dataclasses import dataclass

from stepgen.devices import Mcu, Register


@dataclass(frozen=True)
class Instruction:
    """
    One line of the hot path: its text with named operands, its cycles and why it is there.

    *label* stands before it. *cycles* are those of the usual way: a branch not taken.
    """

    text: str
    cycles: int
    note: str = ""
    label: str = ""

    @property
    def words(self) -> int:
        """
        Return its length in flash words: two with an address of 16 bits or more, else one.
        """
        return 2 if self.text.startswith(("lds", "sts", "jmp", "call")) else 1


@dataclass(frozen=True)
class Gate:
    """
    What a timing puts before the step: it lets through those interrupts at which a step is due.

    Args:
        instructions: It may use r24, and SREG is saved; those that are no step end in it.
        step_cycles: The way through it to the step.
        lap_cycles: The ways that end in it, RETI included: the usual one, then that of the last.
        late_cycles: How much longer the way to the step is where something was late, at most.
        overrun_cycles: How late the interrupt begins, from its flag, where a step counts as missed;
            here from the end of the composer's prologue. None where that cannot be told.
        registers: The registers that its instructions name.
        fields: The members of the motor's motion that they name.
        constants: The constants that they name, as C text.
        boundary: What comes first on the boundary's way: label 2 is the handler, without a step.
        advance: What follows each step, with r24 free; it leaves r25 on the stack.
        check: What follows that on the usual way, and gives r25 back: label 13 is the handler for
            a step that is due already.
        go_on: What follows the step of a boundary if the next run can begin without the handler,
            with r25 on the stack; it branches to label 16 if it cannot.
        out: What stands at label 16 then, before label 2.
        look: What stands at label 20, where an end may be due: on to the step at label 21, or to 2.
        handler_cycles: How much longer the boundary handler takes, at most.
        masked_cycles: How much longer a call has interrupts off, at most.
        tells_missed: Whether a step that was due before the one before it was made is counted.
    """

    instructions: tuple[Instruction, ...] = ()
    step_cycles: int = 0
    lap_cycles: tuple[int, ...] = ()
    late_cycles: int = 0
    overrun_cycles: int | None = None
    registers: tuple[tuple[str, Register], ...] = ()
    fields: tuple[tuple[str, str], ...] = ()
    constants: tuple[tuple[str, str], ...] = ()
    boundary: tuple[Instruction, ...] = ()
    advance: tuple[Instruction, ...] = ()
    check: tuple[Instruction, ...] = ()
    go_on: tuple[Instruction, ...] = ()
    out: tuple[Instruction, ...] = ()
    look: tuple[Instruction, ...] = ()
    handler_cycles: int = 0
    masked_cycles: int = 0
    tells_missed: bool = False


@dataclass(frozen=True)
class Place:
    """
    Where a byte of a motor's state lives: in a GPIOR, or in RAM under a variable's name.
    """

    name: str
    register: Register | None = None

    def load(self, into: str, operand: str, note: str = "") -> Instruction:
        """
        Return the instruction that reads the byte.
        """
        text = f"in    {into}, %[{operand}]" if self.register else f"lds   {into}, %[{operand}]"
        return Instruction(text, 1 if self.register else 2, note)

    def store(self, source: str, operand: str, note: str = "") -> Instruction:
        """
        Return the instruction that writes the byte.
        """
        text = f"out   %[{operand}], {source}" if self.register else f"sts   %[{operand}], {source}"
        return Instruction(text, 1 if self.register else 2, note)


@dataclass(frozen=True)
class Storage:
    """
    Where a motor keeps what its step interrupt needs.

    Args:
        count: Step interrupts until the next boundary, 1 to 255.
        state: The kernel's byte: the bits to toggle next, or the row of the present phase.
        scratch: SREG while a step interrupt runs; all motors share it, since none nests.
    """

    count: Place
    state: Place
    scratch: Place


def allocate(mcu: Mcu, names: Iterable[str]) -> tuple[Storage, ...]:
    """
    Return the storage of each motor: the first one gets the GPIORs, which save it four cycles.
    """
    state, count, scratch = (Place(register.name, register) for register in mcu.gpiors)
    return tuple(
        Storage(count, state, scratch)
        if index == 0
        else Storage(Place(f"{name}Count"), Place(f"{name}State"), scratch)
        for index, name in enumerate(names)
    )


@dataclass(frozen=True)
class Access:
    """
    How a register is read and written: by IN and OUT, or by LDS and STS.
    """

    load: str
    store: str
    cycles: int


def access(register: Register) -> Access:
    """
    Return the shortest way to *register*.
    """
    if register.in_io:
        return Access("in    ", "out   ", 1)
    return Access("lds   ", "sts   ", 2)


def total_cycles(instructions: Iterable[Instruction]) -> int:
    """
    Return the cycles of *instructions*, one after the other.
    """
    return sum(instruction.cycles for instruction in instructions)

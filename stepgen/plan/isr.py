"""
The composer of the step interrupt: it orders the fragments and owns prologue and epilogue.

The hot path is written as instructions with their cycles (AVR instruction set manual), so that
its length is known before anything is compiled.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace

from stepgen.devices import Mcu, Port, Register
from stepgen.plan.kernels import Kernel, PortWrite, Ring, Toggle

_CLOCK_TAKEN_CYCLES = 1  # SBRC that does not skip and RJMP, against SBRC that does
_VECTOR_JUMP_CYCLES = 3  # the JMP in the vector table


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


@dataclass(frozen=True)
class Motion:
    """
    What a motion asks of the step interrupt; cycles are more than those of constant speed.

    Args:
        kind: The spec's name of the motion.
        watches_clock: Whether each step looks if the clock has come to a moment to wake up at.
        handler_cycles: How much longer the handler of the rare ways can take.
        to_clock_cycles: How much later it starts the clock of a timer that it sets anew.
        thinking_cycles: The same when it made the step itself.
        masked_cycles: Longest stretch of a call of the library with interrupts off.
    """

    kind: str
    watches_clock: bool
    handler_cycles: int
    to_clock_cycles: int
    thinking_cycles: int
    masked_cycles: int


@dataclass(frozen=True)
class HotPath:
    """
    The step interrupt: its usual way, and the way out to the boundary.

    Args:
        usual: From the vector to RETI, when nothing but a step is due.
        clock: What follows label 3: a look at the clock; empty where no motion needs one.
        boundary: What follows label 1: the last step of a run, then the boundary handler.
        usual_cycles: Response, vector, all of *usual*.
        clock_cycles: The same with a look at the clock.
        edge_cycles: From the timer's flag to the end of the last port write, on the usual way.
        boundary_edge_cycles: The same on the boundary's way.
        boundary_entry_cycles: From the flag to the first instruction of the boundary handler.
        think_entry_cycles: The same when it is reached before the step.
    """

    usual: tuple[Instruction, ...]
    clock: tuple[Instruction, ...]
    boundary: tuple[Instruction, ...]
    usual_cycles: int
    clock_cycles: int
    edge_cycles: int
    boundary_edge_cycles: int
    boundary_entry_cycles: int
    think_entry_cycles: int


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


def compose(
    kernel: Kernel, storage: Storage, mcu: Mcu, handler: str, *, watches_clock: bool = False
) -> HotPath:
    """
    Return the step interrupt of *kernel*; its rare ways go on in the function *handler*.

    With *watches_clock* each step first looks whether the clock has come to the motor's next
    moment; the handler then goes before the step, and the count has not been touched.
    """
    saved = _saved(kernel)
    entry = (
        Instruction("push  r24", 2),
        Instruction("in    r24, %[sreg]", 1),
        storage.scratch.store("r24", "scratch", "SREG waits here: nothing can interrupt"),
    )
    count = (
        storage.count.load("r24", "count"),
        Instruction("dec   r24", 1, "one step less until the next boundary"),
        storage.count.store("r24", "count"),
        Instruction("breq  1f", 1, "each 255 steps, and where a move begins or ends"),
    )
    step = (
        *(Instruction(f"push  {register}", 2) for register in saved),
        *_step(kernel, storage),
        *(Instruction(f"pop   {register}", 2) for register in reversed(saved)),
    )
    leave = (
        storage.scratch.load("r24", "scratch"),
        Instruction("out   %[sreg], r24", 1),
        Instruction("pop   r24", 2),
    )
    think = (
        Instruction("lds   r24, %[mode]", 2, "here the count is 0", label="1"),
        Instruction("sbrc  r24, %[think]", 2, "a millisecond limit or the end of a move:"),
        Instruction("rjmp  2f", 0, "think before the step"),
    )
    out = (
        Instruction(leave[0].text, leave[0].cycles, leave[0].note, label="2"),
        *leave[1:],
        Instruction(f"jmp   {handler}", 3),
    )
    look, clock = _clock_watch() if watches_clock else ((), ())
    if watches_clock:
        count = (replace(count[0], label="4"), *count[1:])
    arrival = mcu.response_cycles + _VECTOR_JUMP_CYCLES
    until_count = arrival + _cycles(entry + look)
    until_step = until_count + _cycles(count)
    until_rare_step = until_step + 1 + _cycles(think)
    usual = (*entry, *look, *count, *step, *leave, Instruction("reti", mcu.response_cycles))
    looked = _CLOCK_TAKEN_CYCLES + _cycles(clock) if watches_clock else 0
    due = until_count + looked if watches_clock else until_rare_step + 1
    return HotPath(
        usual=usual,
        clock=clock,
        boundary=(*think, *step, *out),
        usual_cycles=arrival + _cycles(usual),
        clock_cycles=arrival + _cycles(usual) + looked,
        edge_cycles=until_step + _cycles_to_edge(step),
        boundary_edge_cycles=until_rare_step + looked + _cycles_to_edge(step),
        boundary_entry_cycles=until_rare_step + looked + _cycles(step + out),
        think_entry_cycles=due + _cycles(out),
    )


def _clock_watch() -> tuple[tuple[Instruction, ...], tuple[Instruction, ...]]:
    """
    Return the test whether to look at the clock, and the look: label 3, back to 4 or on to 2.

    The lower 16 bits of millis() less the moment to wake up at: negative as long as it is not
    there, since that moment is never set further ahead than 32 767 ms.
    """
    look = (
        Instruction("lds   r24, %[mode]", 2),
        Instruction("sbrc  r24, %[clock]", 2, "while the clock decides something:"),
        Instruction("rjmp  3f", 0, "look at it"),
    )
    clock = (
        Instruction("push  r25", 2, label="3"),
        Instruction("lds   r24, %[millis]", 2, "millis(), lower half,"),
        Instruction("lds   r25, %[wake]", 2, "less the moment to wake up at"),
        Instruction("sub   r24, r25", 1),
        Instruction("lds   r24, %[millis] + 1", 2),
        Instruction("lds   r25, %[wake] + 1", 2),
        Instruction("sbc   r24, r25", 1),
        Instruction("pop   r25", 2),
        Instruction("sbrs  r24, 7", 2, "negative: not yet"),
        Instruction("rjmp  2f", 0),
        Instruction("rjmp  4b", 2),
    )
    return look, clock


def _cycles(instructions: Iterable[Instruction]) -> int:
    return sum(instruction.cycles for instruction in instructions)


def _cycles_to_edge(step: tuple[Instruction, ...]) -> int:
    last = max(i for i, line in enumerate(step) if "%[port" in line.text and _writes(line))
    return _cycles(step[: last + 1])


def _writes(line: Instruction) -> bool:
    return line.text.startswith(("out", "sts"))


def _saved(kernel: Kernel) -> tuple[str, ...]:
    if isinstance(kernel, Toggle):
        return ()
    return ("r30", "r31") if len(kernel.writes) == 1 else ("r25", "r30", "r31")


def _step(kernel: Kernel, storage: Storage) -> tuple[Instruction, ...]:
    if isinstance(kernel, Toggle):
        return _toggle_step(kernel, storage)
    return _ring_step(kernel, storage)


def _toggle_step(kernel: Toggle, storage: Storage) -> tuple[Instruction, ...]:
    write = _access(kernel.port.pin)
    return (
        storage.state.load("r24", "state", "whose turn it is"),
        Instruction(f"{write.store}%[port0], r24", write.cycles, "ones written to PINx toggle"),
        Instruction("com   r24", 1),
        Instruction(f"andi  r24, {kernel.both:#04x}", 1),
        storage.state.store("r24", "state", "next time it is the other's"),
    )


def _ring_step(kernel: Ring, storage: Storage) -> tuple[Instruction, ...]:
    follow = (
        storage.state.load("r30", "state", "the row of the present phase"),
        Instruction("subi  r30, lo8(-(%[ring]))", 1, "no carry: the ring lies in one page"),
        Instruction("ldi   r31, hi8(%[ring])", 1),
        Instruction("lpm   r30, Z", 3, "the row of the next phase"),
        storage.state.store("r30", "state"),
        Instruction("subi  r30, lo8(-(%[ring] + 1))", 1),
    )
    if len(kernel.writes) == 1:
        return (*follow, *_single_write(kernel))
    lines = list(follow)
    for write in kernel.writes:
        access = _access(write.port.port)
        operand = f"%[port{_port_index(kernel, write.port)}]"
        lines.append(Instruction(f"lpm   r24, Z{'+' if write != kernel.writes[-1] else ''}", 3))
        lines.append(Instruction(f"{access.load}r25, {operand}", access.cycles))
        lines.extend(_combine(write))
        note = f"{write.port.letter}: {_WRITE_NOTES[write.operation]}"
        lines.append(Instruction(f"{access.store}{operand}, r25", access.cycles, note))
    return tuple(lines)


def _single_write(kernel: Ring) -> tuple[Instruction, ...]:
    write = kernel.writes[0]
    access = _access(write.port.port)
    return (
        Instruction("lpm   r24, Z", 3, "its pattern"),
        Instruction(f"{access.load}r30, %[port0]", access.cycles),
        Instruction(f"andi  r30, {~write.mask & 0xFF:#04x}", 1, "the port's other bits stay"),
        Instruction("or    r24, r30", 1),
        Instruction(f"{access.store}%[port0], r24", access.cycles),
    )


def _port_index(kernel: Ring, port: Port) -> int:
    return [share.port for share in kernel.ports].index(port)


def _combine(write: PortWrite) -> tuple[Instruction, ...]:
    keep = Instruction(f"andi  r25, {~write.mask & 0xFF:#04x}", 1)
    clear, add = Instruction("and   r25, r24", 1), Instruction("or    r25, r24", 1)
    return {"clear": (clear,), "set": (add,), "merge": (keep, add)}[write.operation]


_WRITE_NOTES = {
    "clear": "coils that end go off",
    "merge": "off and on at once",
    "set": "coils that begin go on",
}


@dataclass(frozen=True)
class _Access:
    load: str
    store: str
    cycles: int


def _access(register: Register) -> _Access:
    if register.in_io:
        return _Access("in    ", "out   ", 1)
    return _Access("lds   ", "sts   ", 2)

"""
The fragment of the step interrupt that makes the step, for each kernel.
"""

from stepgen.devices import Port
from stepgen.plan.instructions import Instruction, Storage, access
from stepgen.plan.kernels import Kernel, PortWrite, Ring, Toggle
from stepgen.plan.pulse_code import pulse_end, pulse_start
from stepgen.plan.pulses import Pulse


def saved_registers(kernel: Kernel) -> tuple[str, ...]:
    """
    Return the registers beside r24 that `step_code` uses and that must be saved around it.
    """
    if isinstance(kernel, Toggle | Pulse):
        return ()
    return ("r30", "r31") if len(kernel.writes) == 1 else ("r25", "r30", "r31")


def step_code(kernel: Kernel, storage: Storage) -> tuple[Instruction, ...]:
    """
    Return the instructions of one step of *kernel*; the last port write is its edge.
    """
    if isinstance(kernel, Pulse):
        return pulse_start(kernel)
    if isinstance(kernel, Toggle):
        return _toggle_step(kernel, storage)
    return _ring_step(kernel, storage)


def end_code(
    kernel: Kernel, leave: tuple[Instruction, ...], spent_cycles: int = 0
) -> tuple[Instruction, ...]:
    """
    Return *leave*, which gives SREG and r24 back, with what ends the step before it or behind it.

    *spent_cycles* have passed since the step's edge, beside the edge itself.
    """
    return pulse_end(kernel, leave, spent_cycles) if isinstance(kernel, Pulse) else leave


def _toggle_step(kernel: Toggle, storage: Storage) -> tuple[Instruction, ...]:
    write = access(kernel.port.pin)
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
        reach = access(write.port.port)
        operand = f"%[port{_port_index(kernel, write.port)}]"
        lines.append(Instruction(f"lpm   r24, Z{'+' if write != kernel.writes[-1] else ''}", 3))
        lines.append(Instruction(f"{reach.load}r25, {operand}", reach.cycles))
        lines.extend(_combine(write))
        note = f"{write.port.letter}: {_WRITE_NOTES[write.operation]}"
        lines.append(Instruction(f"{reach.store}{operand}, r25", reach.cycles, note))
    return tuple(lines)


def _single_write(kernel: Ring) -> tuple[Instruction, ...]:
    write = kernel.writes[0]
    reach = access(write.port.port)
    return (
        Instruction("lpm   r24, Z", 3, "its pattern"),
        Instruction(f"{reach.load}r30, %[port0]", reach.cycles),
        Instruction(f"andi  r30, {~write.mask & 0xFF:#04x}", 1, "the port's other bits stay"),
        Instruction("or    r24, r30", 1),
        Instruction(f"{reach.store}%[port0], r24", reach.cycles),
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

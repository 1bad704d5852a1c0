"""
The instructions of a pulse on STEP: what makes it rise, how long it stays, what makes it fall.
"""

from stepgen.plan.instructions import Instruction, access, total_cycles
from stepgen.plan.pulses import Pulse

_ROUND_CYCLES = 3  # DEC and BRNE, taken
_SHORT_CYCLES = 6  # below that a loop saves nothing


def pulse_start(kernel: Pulse) -> tuple[Instruction, ...]:
    """
    Return what makes STEP rise.
    """
    return _write(kernel, rises=True)


def pulse_end(
    kernel: Pulse, leave: tuple[Instruction, ...], spent_cycles: int = 0
) -> tuple[Instruction, ...]:
    """
    Return what lasts until the pulse and its pause are long enough, with *leave* in it.

    STEP has been HIGH for *spent_cycles* already.

    *leave* gives SREG and r24 back, which must be done anyhow: it is part of the pulse, if CBI ends
    that and the way to the next step is as long as the pause; else it is part of the pause.
    """
    fall = _write(kernel, rises=False)
    left = kernel.cycles.high - total_cycles(fall) - spent_cycles
    spare = total_cycles(leave)
    if kernel.is_near and not kernel.low_wait_cycles:
        return (*_wait(left - spare, "STEP stays HIGH"), *leave, *fall)
    pause = _wait(kernel.low_wait_cycles - spare, "STEP stays LOW")
    return (*_wait(left, "STEP stays HIGH"), *fall, *pause, *leave)


def _write(kernel: Pulse, *, rises: bool) -> tuple[Instruction, ...]:
    note = "STEP rises: one step" if rises else "STEP falls"
    if kernel.is_near:
        name = "sbi" if rises else "cbi"
        return (Instruction(f"{name}   %[port0], {kernel.bit}", 2, note),)
    reach = access(kernel.registers[0])
    mask = 1 << kernel.bit
    store = Instruction(f"{reach.store}%[port0], r24", reach.cycles, note)
    if kernel.toggles:
        return (Instruction(f"ldi   r24, {mask:#04x}", 1, "ones written to PINx toggle"), store)
    change = f"ori   r24, {mask:#04x}" if rises else f"andi  r24, {~mask & 0xFF:#04x}"
    return (
        Instruction(f"{reach.load}r24, %[port0]", reach.cycles),
        Instruction(change, 1, "the port's other bits stay"),
        store,
    )


def _wait(cycles: int, note: str) -> tuple[Instruction, ...]:
    """
    Return instructions that take *cycles*, none if there are none; a loop of them uses r24.
    """
    if cycles <= 0:
        return ()
    if cycles < _SHORT_CYCLES:
        rounds: tuple[Instruction, ...] = ()
        rest = cycles
    else:
        count, rest = divmod(cycles, _ROUND_CYCLES)
        rounds = (
            Instruction(f"ldi   r24, {count}", 1, note),
            Instruction("dec   r24", count, f"{count} times", label="8"),
            Instruction("brne  8b", 2 * count - 1),
        )
    pairs, single = divmod(rest, 2)
    short = (
        *(Instruction("rjmp  .+0", 2) for _ in range(pairs)),
        *(Instruction("nop", 1) for _ in range(single)),
    )
    return (*rounds, *short)

"""
The composer of the step interrupt: it orders the fragments and owns prologue and epilogue.

The hot path is written as instructions with their cycles (AVR instruction set manual), so that
its length is known before anything is compiled.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from stepgen.devices import Mcu
from stepgen.plan.instructions import Gate, Instruction, Storage, total_cycles
from stepgen.plan.kernels import Kernel
from stepgen.plan.ladder import Ladder
from stepgen.plan.step_code import end_code, saved_registers, step_code

_CLOCK_TAKEN_CYCLES = 1  # SBRC that does not skip and RJMP, against SBRC that does
_BRANCH_WORDS = 63  # how far a branch reaches
_VECTOR_JUMP_CYCLES = 3  # the JMP in the vector table


@dataclass(frozen=True)
class Motion:
    """
    What a motion asks of the step interrupt; cycles are more than those of constant speed.

    Args:
        kind: The spec's name of the motion.
        watches_clock: Whether each step looks if the clock has come to a moment to wake up at.
        changes_speed: Whether update events change the speed; at such a moment the handler may
            then make the step.
        handler_cycles: How much longer the handler of the rare ways can take, at most.
        to_clock_cycles: How much later it starts the clock of a timer that it sets anew.
        thinking_cycles: The same when it made the step itself.
        limit_cycles: How much later still with a limit in milliseconds.
        masked_cycles: Longest stretch of a call of the library with interrupts off.
        dumps: Whether the library can print the state of the motion.
        can_go_on: Whether the interrupt itself can begin the next run of steps, and look whether a
            limit in milliseconds is over.
        setting_cycles: What of *handler_cycles* goes into setting the timer anew.
        masked_setting_cycles: The same of *masked_cycles*.
        forms: The forms of timings that it can run on, by their module, and the form that each then
            has; None where all are as they are.
        ladder: The ramp of its moves, else None.
        queue: How many moves can wait.
        cruise_interval_256: The interval at its cruise speed, in 1/256 clocks.
        wish_field: Where in the motor's spec stands how fast it will be at most.
        needs_steps: Whether its clocks must be looked at with steps, each 16 s at least.
    """

    kind: str
    watches_clock: bool
    handler_cycles: int
    to_clock_cycles: int
    thinking_cycles: int
    limit_cycles: int
    masked_cycles: int
    dumps: bool = False
    can_go_on: bool = False
    setting_cycles: int = 0
    masked_setting_cycles: int = 0
    changes_speed: bool = False
    forms: Mapping[str, str] | None = None
    ladder: Ladder | None = None
    queue: int = 0
    cruise_interval_256: int = 0
    wish_field: tuple[str, ...] = ("max_steps_per_second",)
    needs_steps: bool = True


@dataclass(frozen=True)
class HotPath:
    """
    The step interrupt: its usual way, and the way out to the boundary.

    Args:
        usual: From the vector to RETI, when nothing but a step is due.
        boundary: What follows label 1: the last step of a run, then the boundary handler. It
            comes right behind *usual*: the BREQ that leads there reaches 63 words, and a step on
            four ports takes 61.
        clock: What follows label 3: a look at the clock; empty where no motion needs one.
        late: What follows label 13: on to the handler of a step that is due already; else empty.
        usual_cycles: Response, vector, all of *usual* on the way of a step.
        recurring_cycles: The same of the longest way that each step can take for long; None where
            that leads to the handler.
        lap_cycles: The same of interrupts without a step, in order of length; empty where none is.
        overrun_cycles: How late an interrupt begins, from its flag to the response, where its step
            counts as missed; None where that is no matter of this interrupt.
        clock_cycles: The same with a look at the clock.
        edge_cycles: From the timer's flag to the end of the write that makes the step, usually.
        boundary_edge_cycles: The same on the boundary's way.
        boundary_entry_cycles: From the flag to the first instruction of the boundary handler.
        think_entry_cycles: The same when it is reached before the step.
        limit_handler: Where it goes on in place of a step that would lead into a limit switch.
        pressed_cycles: How much longer it takes to the step while limit switches are pressed.
    """

    usual: tuple[Instruction, ...]
    boundary: tuple[Instruction, ...]
    clock: tuple[Instruction, ...]
    late: tuple[Instruction, ...]
    usual_cycles: int
    recurring_cycles: int | None
    lap_cycles: tuple[int, ...]
    overrun_cycles: int | None
    clock_cycles: int
    edge_cycles: int
    boundary_edge_cycles: int
    boundary_entry_cycles: int
    think_entry_cycles: int
    limit_handler: str = ""
    pressed_cycles: int = 0


def compose(
    kernel: Kernel,
    storage: Storage,
    mcu: Mcu,
    handler: str,
    gate: Gate,
    motion: Motion,
) -> HotPath:
    """
    Return the step interrupt of *kernel*; its rare ways go on in the function *handler*.

    The *gate* of the timing comes first. Where the *motion* watches the clock, each step then looks
    whether it has come to the motor's next moment; the handler then goes before the step, and the
    count has not been touched.
    """
    saved = saved_registers(kernel)
    entry = (
        Instruction("push  r24", 2),
        Instruction("in    r24, %[sreg]", 1),
        storage.scratch.store("r24", "scratch", "SREG waits here: nothing can interrupt"),
    )
    count: tuple[Instruction, ...] = (
        storage.count.load("r24", "count"),
        Instruction("dec   r24", 1, "one step less until the next boundary"),
        storage.count.store("r24", "count"),
    )
    step = (
        *(Instruction(f"push  {register}", 2) for register in saved),
        *step_code(kernel, storage),
        *(Instruction(f"pop   {register}", 2) for register in reversed(saved)),
    )
    moved, punctual = _moves(gate)
    leave = (
        storage.scratch.load("r24", "scratch"),
        Instruction("out   %[sreg], r24", 1),
        Instruction("pop   r24", 2),
    )
    think = (
        *gate.boundary,
        Instruction("lds   r24, %[mode]", 2, "here the count is 0"),
        Instruction("sbrc  r24, %[think]", 2, "an end may be due:"),
        Instruction("rjmp  20f" if gate.look else "rjmp  2f", 0, "think before the step"),
    )
    out = (
        Instruction(leave[0].text, leave[0].cycles, leave[0].note, label="2"),
        *leave[1:],
        Instruction(f"jmp   {handler}", 3),
    )
    think = (replace(think[0], label="1"), *think[1:])
    look, clock = _clock_watch() if motion.watches_clock else ((), ())
    if motion.watches_clock:
        count = (replace(count[0], label="4"), *count[1:])
    reti = Instruction("reti", mcu.response_cycles)
    ending = (*end_code(kernel, leave, total_cycles(punctual)), reti)
    late = _late(end_code(kernel, leave, total_cycles(punctual)), handler) if gate.check else ()
    rarely = "each 255 steps, and where a move begins or ends"
    count = (*count, *to_boundary((*step, *punctual, *ending, *late), rarely))
    arrival = mcu.response_cycles + _VECTOR_JUMP_CYCLES
    until_gate = arrival + total_cycles(entry)
    until_count = until_gate + gate.step_cycles + total_cycles(look)
    until_step = until_count + total_cycles(count)
    until_rare_step = until_step + 1 + total_cycles(think)
    rare_step = (*step, *moved, *end_code(kernel, (), total_cycles(moved)))
    again = (*gate.go_on, *leave, reti, *gate.out) if gate.go_on else ()
    onward = (*look, *count, *_labelled(step, gate), *punctual, *ending)
    usual_cycles = until_gate + gate.step_cycles + total_cycles(onward)
    looked = _CLOCK_TAKEN_CYCLES + total_cycles(clock) if motion.watches_clock else 0
    overrun = gate.overrun_cycles
    due = looked + (until_count if motion.changes_speed else until_rare_step + 1)
    by_look = until_rare_step + 1 + total_cycles((*gate.look, *step, *punctual, *ending))
    going_on = until_rare_step + total_cycles((*rare_step, *gate.go_on, *leave, reti))
    missed_turn = total_cycles((*gate.go_on, *gate.out))
    return HotPath(
        usual=(*entry, *gate.instructions, *onward),
        boundary=(*think, *rare_step, *again, *out, *gate.look),
        clock=clock,
        late=late,
        usual_cycles=usual_cycles,
        recurring_cycles=max(by_look, going_on) if gate.look else None,
        lap_cycles=tuple(until_gate + cycles for cycles in gate.lap_cycles),
        overrun_cycles=None if overrun is None else overrun - until_gate,
        clock_cycles=usual_cycles + looked,
        edge_cycles=until_step + cycles_to_edge(step),
        boundary_edge_cycles=until_rare_step + looked + cycles_to_edge(step),
        boundary_entry_cycles=until_rare_step
        + looked
        + total_cycles(rare_step + out)
        + missed_turn,
        think_entry_cycles=due + total_cycles((*gate.look, *out)),
    )


def _labelled(step: tuple[Instruction, ...], gate: Gate) -> tuple[Instruction, ...]:
    """
    Return *step* with label 21 where the look of *gate* goes on with it.
    """
    return (replace(step[0], label="21"), *step[1:]) if gate.look else step


def _moves(gate: Gate) -> tuple[tuple[Instruction, ...], tuple[Instruction, ...]]:
    """
    Return what of *gate* follows a step: before a boundary, and on the usual way.
    """
    if not gate.advance:
        return (), ()
    give_back = () if gate.go_on else (Instruction("pop   r25", 2),)
    return (*gate.advance, *give_back), (*gate.advance, *gate.check)


def _late(ending: tuple[Instruction, ...], handler: str) -> tuple[Instruction, ...]:
    """
    Return how an interrupt ends whose next step is due already: with *ending*, in a handler.
    """
    first, *rest = ending
    return (replace(first, label="13"), *rest, Instruction(f"jmp   {handler}_late", 3))


def to_boundary(between: tuple[Instruction, ...], note: str) -> tuple[Instruction, ...]:
    """
    Return the way to label 1, behind *between*: BREQ reaches 63 words, RJMP further.
    """
    if sum(instruction.words for instruction in between) <= _BRANCH_WORDS:
        return (Instruction("breq  1f", 1, note),)
    return (Instruction("brne  .+2", 2), Instruction("rjmp  1f", 0, note))


def _clock_watch() -> tuple[tuple[Instruction, ...], tuple[Instruction, ...]]:
    """
    Return the test whether to look at the clock, and the look: label 3, back to 4 or to 2.

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
        Instruction("rjmp  2b", 0),
        Instruction("rjmp  4b", 2),
    )
    return look, clock


def cycles_to_edge(step: tuple[Instruction, ...]) -> int:
    """
    Return the cycles of *step* up to the end of the write that makes it.
    """
    last = max(i for i, line in enumerate(step) if "%[port" in line.text and _writes(line))
    return total_cycles(step[: last + 1])


def _writes(line: Instruction) -> bool:
    return line.text.startswith(("out", "sts", "sbi"))

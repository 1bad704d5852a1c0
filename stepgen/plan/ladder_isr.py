"""
The step interrupt of a motor with ramps, on a compare channel of a 16-bit timer.

The usual step moves the compare register on by the interval, with a fraction of 1/256 clock that
is carried. At the end of a level the interval changes by the row's slope and the next level
begins: one addition. Only the end of a row, and whatever a call has changed, takes the handler.
"""

from dataclasses import replace

from stepgen.devices import Mcu
from stepgen.plan.instructions import Gate, Instruction, Storage, total_cycles
from stepgen.plan.isr import HotPath, cycles_to_edge, to_boundary
from stepgen.plan.kernels import Kernel
from stepgen.plan.model import TimerPlan
from stepgen.plan.polls import Polls
from stepgen.plan.step_code import end_code, saved_registers, step_code
from stepgen.plan.wide_gate import channel_registers, laps, passed

_VECTOR_JUMP_CYCLES = 3  # the JMP in the vector table
_NO_LAPS_CYCLES = 9  # LDS, TST, BRNE, LDS, TST, BREQ that branches
_HANDLER_CYCLES = 60  # to move the compare register, to look if that was too late, to count that
_BACK_CYCLES = 2  # the RJMP from a level's beginning to the usual way


def ladder_gate(timing: TimerPlan, storage: Storage) -> Gate:
    """
    Return the fragments of the compare channel of *timing*.
    """
    return Gate(
        boundary=laps(),
        advance=_advance(),
        check=(*passed(), Instruction("brpl  13f", 1)),
        go_on=_next_level(storage),
        handler_cycles=_HANDLER_CYCLES,
        tells_missed=True,
        registers=(*channel_registers(timing), ("tifr", timing.timer.tifr)),
        constants=(
            ("ocf", f"OCF{timing.timer.number}{timing.channel}"),
            ("soon", "kSoonTicks"),
        ),
        fields=(
            ("due", "due"),
            ("fraction", "dueFraction"),
            ("interval", "interval"),
            ("laps", "lapsLeft"),
            ("levels", "levels"),
            ("change", "change"),
            ("length", "length"),
            ("missed", "missed"),
        ),
    )


def _advance() -> tuple[Instruction, ...]:
    """
    Return what moves the compare register to the next step; r25 is on the stack.
    """
    return (
        Instruction("lds   r24, %[fraction]", 2, "when this step was due, and the interval"),
        Instruction("lds   r25, %[interval]", 2, "more: first 1/256 clocks,"),
        Instruction("add   r24, r25", 1),
        Instruction("sts   %[fraction], r24", 2),
        Instruction("lds   r24, %[due]", 2, "then clocks"),
        Instruction("lds   r25, %[interval] + 1", 2),
        Instruction("adc   r24, r25", 1),
        Instruction("sts   %[due], r24", 2),
        Instruction("lds   r24, %[due] + 1", 2),
        Instruction("lds   r25, %[interval] + 2", 2),
        Instruction("adc   r24, r25", 1),
        Instruction("sts   %[due] + 1, r24", 2),
        Instruction("sts   %[ocrHigh], r24", 2, "waits in TEMP"),
        Instruction("lds   r25, %[due]", 2),
        Instruction("sts   %[ocrLow], r25", 2, "the next match is the next step"),
    )


def _next_level(storage: Storage) -> tuple[Instruction, ...]:
    """
    Return what begins the next level of a row, if there is one.
    """
    added = [
        (
            Instruction(f"lds   r24, %[interval]{byte}", 2, note),
            Instruction(f"lds   r25, %[change]{byte}", 2),
            Instruction(f"{add}   r24, r25", 1),
            Instruction(f"sts   %[interval]{byte}, r24", 2),
        )
        for byte, add, note in (
            ("", "add", "the next level: the interval changes"),
            (" + 1", "adc", ""),
            (" + 2", "adc", ""),
        )
    ]
    return (
        Instruction("lds   r24, %[levels]", 2, "more levels in this row?"),
        Instruction("subi  r24, 1", 1),
        Instruction("brcc  .+2", 2),
        Instruction("rjmp  16f", 0, "no: decide what comes next"),
        Instruction("sts   %[levels], r24", 2),
        *(instruction for byte in added for instruction in byte),
        Instruction("lds   r24, %[length]", 2, "and lasts for so many steps"),
        storage.count.store("r24", "count"),
    )


def at_once() -> tuple[Instruction, ...]:
    """
    Return what has the next step made at once, since its moment has passed without a flag.
    """
    return (
        Instruction("sbic  %[tifr], %[ocf]", 1, "a match meanwhile is that step", label="18"),
        Instruction("rjmp  12b", 2),
        Instruction("lds   r24, %[tcntLow]", 2, "else there will be one at once"),
        Instruction("lds   r25, %[tcntHigh]", 2),
        Instruction("subi  r24, lo8(-(%[soon]))", 1),
        Instruction("sbci  r25, hi8(-(%[soon]))", 1),
        Instruction("sts   %[ocrHigh], r25", 2),
        Instruction("sts   %[ocrLow], r24", 2),
        Instruction("lds   r24, %[missed]", 2, "and it is counted"),
        Instruction("lds   r25, %[missed] + 1", 2),
        Instruction("adiw  r24, 1", 2),
        Instruction("sts   %[missed], r24", 2),
        Instruction("sts   %[missed] + 1, r25", 2),
        Instruction("rjmp  12b", 2),
    )


def compose_ladder(
    kernel: Kernel, storage: Storage, mcu: Mcu, handler: str, gate: Gate, polls: Polls
) -> HotPath:
    """
    Return the step interrupt of *kernel*; its rare ways go on in the function *handler*.

    Before each step it looks at the limit switches of *polls*.
    """
    saved = saved_registers(kernel)
    entry = (
        Instruction("push  r24", 2),
        Instruction("in    r24, %[sreg]", 1),
        storage.scratch.store("r24", "scratch", "SREG waits here: nothing can interrupt"),
    )
    step = (
        *(Instruction(f"push  {register}", 2) for register in saved),
        *step_code(kernel, storage),
        *(Instruction(f"pop   {register}", 2) for register in reversed(saved)),
        Instruction("push  r25", 2),
    )
    leave = (
        storage.scratch.load("r24", "scratch"),
        Instruction("out   %[sreg], r24", 1),
        Instruction("pop   r24", 2),
    )
    punctual = (replace(gate.advance[0], label="11"), *gate.advance[1:], *gate.check)
    restore = (Instruction("pop   r25", 2), *leave)
    first, *others = end_code(kernel, restore, 2 + total_cycles(punctual))  # 2 for the PUSH
    usual_end = (replace(first, label="12"), *others, Instruction("reti", mcu.response_cycles))
    usual_way = (*polls.before(step, 0), *punctual, *usual_end)
    late = (Instruction("rjmp  18f", 2, label="13"),)
    count = (
        storage.count.load("r24", "count"),
        Instruction("dec   r24", 1, "one step less of this level"),
        storage.count.store("r24", "count"),
        *to_boundary((*usual_way, *late), "at the end of a level"),
    )
    first_lap, *more_laps = gate.boundary
    decide = (2, 2, 1, 1, 2)  # push r25, then LDS, SUBI, BRCC that does not branch, RJMP
    rare = (
        replace(first_lap, label="1"),
        *more_laps,
        *polls.before(step, 1),
        *gate.go_on,
        Instruction("rjmp  11b", _BACK_CYCLES, "the rest is as usual"),
        Instruction("pop   r25", 2, label="16"),
        *end_code(kernel, (), sum(decide) + 2),
        replace(leave[0], label="2"),
        *leave[1:],
        Instruction(f"jmp   {handler}", 3),
        *at_once(),
        *polls.rare(leave),
    )
    arrival = mcu.response_cycles + _VECTOR_JUMP_CYCLES
    until_look = arrival + total_cycles((*entry, *count))
    until_step = until_look + polls.cycles
    until_rare_step = until_step + 1 + _NO_LAPS_CYCLES
    usual_cycles = until_look + total_cycles(usual_way)
    next_level = (*step, *gate.go_on, *punctual, *usual_end)
    tail = total_cycles((*end_code(kernel, (), sum(decide) + 2), *leave)) + 3
    until_late_step = until_rare_step + polls.pressed_cycles
    to_handler = max(
        until_late_step + total_cycles(step) + sum(decide[1:]) + 2 + tail,
        until_rare_step - polls.cycles + polls.entry_cycles(leave),
    )
    return HotPath(
        usual=(*entry, *count, *usual_way),
        boundary=rare,
        clock=(),
        late=late,
        usual_cycles=usual_cycles,
        recurring_cycles=until_late_step + total_cycles(next_level) + _BACK_CYCLES,
        lap_cycles=(),
        overrun_cycles=None,
        clock_cycles=usual_cycles,
        edge_cycles=until_step + cycles_to_edge(step),
        boundary_edge_cycles=until_rare_step + cycles_to_edge(step),
        boundary_entry_cycles=to_handler,
        think_entry_cycles=to_handler,
        limit_handler=polls.handler,
        pressed_cycles=polls.pressed_cycles,
    )

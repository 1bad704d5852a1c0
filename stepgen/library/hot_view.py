"""
The view of a step interrupt: instructions and operands as finished assembler text.
"""

from dataclasses import dataclass

from stepgen.devices import Register
from stepgen.plan.instructions import Instruction, Place
from stepgen.plan.kernels import Ring
from stepgen.plan.model import MotorPlan

THINK_BIT = 0
CLOCK_BIT = 5
_LINE_WIDTH = 34


@dataclass(frozen=True)
class Line:
    """
    An instruction as C text, and what stands behind it as a comment.
    """

    text: str
    comment: str


def instruction_lines(instructions: tuple[Instruction, ...]) -> tuple[Line, ...]:
    """
    Return *instructions* as the lines of an ``asm`` statement, each with its cycles and its note.
    """
    return tuple(_line(instruction) for instruction in instructions)


def operand_lines(motor: MotorPlan) -> tuple[Line, ...]:
    """
    Return what the names in the instructions of *motor* stand for.
    """
    storage = motor.storage
    operands = [
        '[sreg] "I"(_SFR_IO_ADDR(SREG))',
        _place_operand("scratch", storage.scratch),
        _place_operand("count", storage.count),
        *((_place_operand("state", storage.state),) if motor.kernel.state_note else ()),
        f'[mode] "i"(&{motor.name}Motion.mode)',
        f'[think] "I"({THINK_BIT})',
    ]
    if motor.motion.watches_clock:
        wake = f"{motor.name}{'Motion.wake' if motor.motion.changes_speed else 'Deadline'}"
        operands += [f'[clock] "I"({CLOCK_BIT})', f'[wake] "i"(&{wake})']
    if motor.motion.watches_clock or motor.gate.look:
        operands.append('[millis] "i"(&timer0_millis)')
    for name, register in motor.gate.registers:
        operands.append(_register_operand(name, register))
    for name, member in motor.gate.fields:
        operands.append(f'[{name}] "i"(&{motor.name}Motion.{member})')
    for name, constant in motor.gate.constants:
        operands.append(f'[{name}] "n"({constant})')
    kernel = motor.kernel
    if isinstance(kernel, Ring):
        operands.append(f'[ring] "i"({motor.name}Ring)')
    for index, register in enumerate(kernel.registers):
        operands.append(_register_operand(f"port{index}", register))
    used = "".join(line.text for line in _every_instruction(motor))
    *others, last = (text for text in operands if f"%{text.partition(' ')[0]}" in used)
    return (*(Line(text, ",") for text in others), Line(last, ""))


def _every_instruction(motor: MotorPlan) -> tuple[Instruction, ...]:
    path = motor.hot_path
    return (*path.usual, *path.late, *path.boundary, *path.clock)


def _line(instruction: Instruction) -> Line:
    label = f"{instruction.label}:" if instruction.label else "  "
    words = f"{label} {instruction.text}"
    text = f'"{words:<{_LINE_WIDTH}}\\n"'
    cycles = str(instruction.cycles) if instruction.cycles else " "
    return Line(text, f"  // {cycles}  {instruction.note}".rstrip())


def _register_operand(name: str, register: Register) -> str:
    access = '"I"(_SFR_IO_ADDR' if register.in_io else '"n"(_SFR_MEM_ADDR'
    return f"[{name}] {access}({register.name}))"


def _place_operand(name: str, place: Place) -> str:
    if place.register:
        return f'[{name}] "I"(_SFR_IO_ADDR({place.name}))'
    return f'[{name}] "i"(&{place.name})'

"""
What each instruction makes of what is known. Where it goes is not decided here.

What is not modelled makes things unknown, never known: a bound can then only be looser.
"""

from collections.abc import Callable

from stepgen.verify.bounds.arithmetic import (
    add,
    add_word,
    compare,
    complement,
    constant,
    count,
    do_and,
    do_or,
    do_xor,
    negate,
    shift_right,
    subtract,
)
from stepgen.verify.bounds.disassembly import Line
from stepgen.verify.bounds.knowledge import unknown_byte
from stepgen.verify.bounds.machine import IO_START, Machine, register

_SPL, _SPH, _SREG = 0x5D, 0x5E, 0x5F


def run(machine: Machine, line: Line) -> None:
    """
    Let *line* change what *machine* knows.
    """
    if not (line.is_branch or line.is_skip):
        _STEPS.get(line.name, _forget_all)(machine, line)


def _move_word(machine: Machine, line: Line) -> None:
    to, source = (register(operand) for operand in line.operands)
    machine.registers[to : to + 2] = machine.registers[source : source + 2]


def _in(machine: Machine, line: Line) -> None:
    address = int(line.operands[1], 0) + IO_START
    if address in {_SPL, _SPH}:  # the stack may be written through a pointer from now on
        machine.stack = [b if isinstance(b, int) else unknown_byte() for b in machine.stack]
    machine.put(line, machine.read(address))


def _out(machine: Machine, line: Line) -> None:
    address = int(line.operands[0], 0) + IO_START
    machine.write(address, machine.get(line, 1))
    if address == _SREG:
        machine.forget_flags()


def _set_io_bit(machine: Machine, line: Line, value: int) -> None:
    address, bit = int(line.operands[0], 0) + IO_START, int(line.operands[1], 0)
    held = list(machine.read(address))
    held[bit] = value
    machine.write(address, tuple(held))


def _indirect(machine: Machine, operand: str) -> int | None:
    """
    Return the address of ``X``, ``X+``, ``-X`` or ``Y+5``, and move the pointer.
    """
    name = operand.strip("+-0123456789")
    base = machine.pointer(name)
    before = operand.startswith("-")
    after = operand.endswith("+")
    offset = -1 if before else 0 if after else int(operand[1:] or 0)
    address = None if base is None else base + offset
    if before or after:
        machine.set_pointer(name, None if base is None else base + (1 if after else -1))
    return address


def _load(machine: Machine, line: Line) -> None:
    machine.put(line, machine.read(_indirect(machine, line.operands[1])))


def _store(machine: Machine, line: Line) -> None:
    value = machine.get(line, 1)
    machine.write(_indirect(machine, line.operands[0]), value)


def _load_program(machine: Machine, line: Line) -> None:
    if not line.operands:
        machine.registers[0] = unknown_byte()
        return
    if line.operands[1].endswith("+"):
        _indirect(machine, line.operands[1])
    machine.put(line, unknown_byte())


def _pop(machine: Machine, line: Line) -> None:
    top = machine.stack.pop() if machine.stack else unknown_byte()
    machine.put(line, unknown_byte() if isinstance(top, int) else top)


def _multiply(machine: Machine, _: Line) -> None:
    machine.registers[0], machine.registers[1] = unknown_byte(), unknown_byte()
    machine.forget_flags()


def _make_room(machine: Machine, _: Line) -> None:
    """
    ``rcall .+0`` pushes the address of what follows, for its two or three bytes of room.
    """
    machine.stack += [unknown_byte() for _ in range(machine.memory.pc_bytes)]


def _store_bit(machine: Machine, line: Line) -> None:
    machine.stored = machine.get(line, 0)[int(line.operands[1], 0)]


def _load_bit(machine: Machine, line: Line) -> None:
    value = list(machine.get(line, 0))
    value[int(line.operands[1], 0)] = machine.stored
    machine.put(line, tuple(value))


def _set_carry(machine: Machine, value: int) -> None:
    machine.carry, machine.borrows = value, False


def _set_stored(machine: Machine, value: int) -> None:
    machine.stored = value


def _forget_all(machine: Machine, _: Line) -> None:
    machine.registers = [unknown_byte() for _ in range(32)]
    machine.data.clear()
    machine.forget_flags()


def _nothing(_: Machine, __: Line) -> None:
    pass


def _swap(machine: Machine, line: Line) -> None:
    value = machine.get(line, 0)
    machine.put(line, value[4:] + value[:4])


_STEPS: dict[str, Callable[[Machine, Line], None]] = {
    **dict.fromkeys(("nop", "wdr", "cli", "sei", "jmp", "rjmp"), _nothing),
    "rcall": _make_room,
    "ldi": lambda m, i: m.put(i, constant(i)),
    "mov": lambda m, i: m.put(i, m.get(i, 1)),
    "movw": _move_word,
    "lds": lambda m, i: m.put(i, m.read(int(i.operands[1], 0))),
    "sts": lambda m, i: m.write(int(i.operands[0], 0), m.get(i, 1)),
    "in": _in,
    "out": _out,
    "sbi": lambda m, i: _set_io_bit(m, i, 1),
    "cbi": lambda m, i: _set_io_bit(m, i, 0),
    "ld": _load,
    "ldd": _load,
    "st": _store,
    "std": _store,
    **dict.fromkeys(("mul", "muls", "mulsu", "fmul", "fmuls", "fmulsu"), _multiply),
    "lpm": _load_program,
    "elpm": _load_program,
    "push": lambda m, i: m.stack.append(m.get(i, 0)),
    "pop": _pop,
    "add": lambda m, i: add(m, i, with_carry=False),
    "adc": lambda m, i: add(m, i, with_carry=True),
    "sub": lambda m, i: subtract(m, i, m.get(i, 1)),
    "subi": lambda m, i: subtract(m, i, constant(i)),
    "sbc": lambda m, i: subtract(m, i, m.get(i, 1), with_carry=True),
    "sbci": lambda m, i: subtract(m, i, constant(i), with_carry=True),
    "cp": lambda m, i: compare(m, i, m.get(i, 1)),
    "cpi": lambda m, i: compare(m, i, constant(i)),
    "cpc": lambda m, i: compare(m, i, m.get(i, 1), with_carry=True),
    "and": lambda m, i: do_and(m, i, m.get(i, 1)),
    "andi": lambda m, i: do_and(m, i, constant(i)),
    "or": lambda m, i: do_or(m, i, m.get(i, 1)),
    "ori": lambda m, i: do_or(m, i, constant(i)),
    "eor": do_xor,
    "com": complement,
    "neg": negate,
    "inc": lambda m, i: count(m, i, 1),
    "dec": lambda m, i: count(m, i, -1),
    "lsr": lambda m, i: shift_right(m, i, 0),
    "asr": lambda m, i: shift_right(m, i, m.get(i, 0)[7]),
    "ror": lambda m, i: shift_right(m, i, m.facts.bits.get(m.carry, m.carry)),
    "adiw": lambda m, i: add_word(m, i, 1),
    "sbiw": lambda m, i: add_word(m, i, -1),
    "swap": _swap,
    "bst": _store_bit,
    "bld": _load_bit,
    "sec": lambda m, _: _set_carry(m, 1),
    "clc": lambda m, _: _set_carry(m, 0),
    "set": lambda m, _: _set_stored(m, 1),
    "clt": lambda m, _: _set_stored(m, 0),
}

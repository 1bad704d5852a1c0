"""
What arithmetic and logic instructions make of registers and flags.

What is not modelled makes things unknown, never known: a bound can then only be looser.
Source: AVR Instruction Set Manual (DS40002198), the Boolean formula of each flag.
"""

from stepgen.verify.bounds.disassembly import Line
from stepgen.verify.bounds.knowledge import (
    Byte,
    Condition,
    all_equal,
    both,
    byte,
    number,
    unknown,
    unknown_byte,
)
from stepgen.verify.bounds.machine import Machine, register

_ZERO = byte(0)


def _difference(machine: Machine, first: Byte, second: Byte, *, with_carry: bool) -> Byte:
    """
    Return first - second, less the carry with *with_carry*; sets the flags.

    Z of a difference is that the two are equal. With a carry, Z says that all bytes so far
    are equal, if the earlier Z implies that nothing was borrowed.
    """
    carry = machine.facts.bits.get(machine.carry, machine.carry) if with_carry else 0
    one, other = number(first), number(second)
    if one is not None and other is not None and carry in {0, 1}:
        value = byte(one - other - carry)
        machine.carry = int(one < other + carry)
    else:
        value, machine.carry = unknown_byte(), unknown()
        if second == _ZERO and carry == 0:
            value, machine.carry = first, 0
    chain = with_carry and machine.borrows
    machine.borrows = chain or not with_carry
    is_plain = chain or carry == 0
    zero = all_equal(first, second) if is_plain else all_equal(value, _ZERO)
    return machine.result(value, chained=with_carry, zero=zero)


def subtract(machine: Machine, line: Line, second: Byte, *, with_carry: bool = False) -> None:
    """
    Set the first register to itself less *second*: SUB, SUBI, SBC, SBCI.
    """
    machine.put(line, _difference(machine, machine.get(line, 0), second, with_carry=with_carry))


def compare(machine: Machine, line: Line, second: Byte, *, with_carry: bool = False) -> None:
    """
    Set the flags of the first register less *second*: CP, CPI, CPC.
    """
    _difference(machine, machine.get(line, 0), second, with_carry=with_carry)


def add(machine: Machine, line: Line, *, with_carry: bool) -> None:
    """
    Add the second register to the first: ADD, ADC; with itself they are LSL and ROL.
    """
    first, second = machine.get(line, 0), machine.get(line, 1)
    carry = machine.facts.bits.get(machine.carry, machine.carry) if with_carry else 0
    machine.borrows = False
    one, other = number(first), number(second)
    if one is not None and other is not None and carry in {0, 1}:
        value = byte(one + other + carry)
        machine.carry = int(one + other + carry > 0xFF)  # noqa: PLR2004 - a byte
    elif line.operands[0] == line.operands[1]:  # LSL or ROL
        value = (carry, *first[:7])
        machine.carry = first[7]
    else:
        value, machine.carry = unknown_byte(), unknown()
    machine.put(line, machine.result(value, zero=all_equal(value, _ZERO)))


def constant(line: Line) -> Byte:
    """
    Return the constant that is the second operand.
    """
    return byte(int(line.operands[1], 0))


def _logic(machine: Machine, line: Line, value: Byte, zero: Condition) -> None:
    machine.borrows = False
    machine.put(line, machine.result(value, zero=zero))
    machine.sign = value[7]  # V is 0


def _and(first: Byte, second: Byte) -> Byte:
    return tuple(
        0 if 0 in (a, b) else b if a == 1 else a if b in (1, a) else unknown()
        for a, b in zip(first, second, strict=True)
    )


def _or(first: Byte, second: Byte) -> Byte:
    return tuple(
        1 if 1 in (a, b) else b if a == 0 else a if b in (0, a) else unknown()
        for a, b in zip(first, second, strict=True)
    )


def _xor(first: Byte, second: Byte) -> Byte:
    return tuple(
        0 if a == b else b if a == 0 else a if b == 0 else 1 if {a, b} == {0, 1} else unknown()
        for a, b in zip(first, second, strict=True)
    )


def do_and(machine: Machine, line: Line, second: Byte) -> None:
    """
    Keep those bits of the first register that *second* has: AND, ANDI, TST.
    """
    value = _and(machine.get(line, 0), second)
    _logic(machine, line, value, all_equal(value, _ZERO))


def do_or(machine: Machine, line: Line, second: Byte) -> None:
    """
    Set the flags of OR: its result is 0 exactly if both bytes are.
    """
    first = machine.get(line, 0)
    zero = both(all_equal(first, _ZERO), all_equal(second, _ZERO))
    _logic(machine, line, _or(first, second), zero)


def do_xor(machine: Machine, line: Line) -> None:
    """
    Toggle those bits of the first register that the second has: EOR, CLR.
    """
    first, second = machine.get(line, 0), machine.get(line, 1)
    _logic(machine, line, _xor(first, second), all_equal(first, second))


def shift_right(machine: Machine, line: Line, top: int) -> None:
    """
    Shift right by one, *top* coming in: LSR, ASR, ROR.
    """
    first = machine.get(line, 0)
    machine.carry = first[0]
    machine.borrows = False
    value = (*first[1:], top)
    machine.put(line, machine.result(value, zero=all_equal(value, _ZERO)))


def count(machine: Machine, line: Line, by: int) -> None:
    """
    Add *by*, and leave the carry alone: INC, DEC.
    """
    one = number(machine.get(line, 0))
    value = unknown_byte() if one is None else byte(one + by)
    machine.borrows = False
    machine.put(line, machine.result(value, zero=all_equal(value, _ZERO)))


def add_word(machine: Machine, line: Line, sign: int) -> None:
    """
    Add the constant, or with *sign* -1 subtract it, to a pair of registers: ADIW, SBIW.
    """
    first = register(line.operands[0])
    low, high = (machine.facts.resolve(machine.registers[first + i]) for i in (0, 1))
    added = sign * int(line.operands[1], 0)
    one, other = number(low), number(high)
    machine.carry = unknown()
    if one is not None and other is not None:
        total = (one | other << 8) + added
        low, high = byte(total), byte(total >> 8)
        machine.carry = int(not 0 <= total < 1 << 16)
    elif added:
        low, high = unknown_byte(), unknown_byte()
    else:
        machine.carry = 0
    machine.registers[first : first + 2] = [low, high]
    machine.borrows = sign < 0  # a difference of 0 borrows nothing
    machine.result(high, zero=both(all_equal(low, _ZERO), all_equal(high, _ZERO)))


def complement(machine: Machine, line: Line) -> None:
    """
    Turn each bit round: COM.
    """
    known = machine.get(line, 0)
    value = tuple(1 - bit if bit in {0, 1} else unknown() for bit in known)
    _logic(machine, line, value, all_equal(known, byte(0xFF)))
    machine.carry = 1


def negate(machine: Machine, line: Line) -> None:
    """
    Subtract from 0: NEG.
    """
    machine.put(line, _difference(machine, _ZERO, machine.get(line, 0), with_carry=False))

"""
The look at limit switches in the step interrupt: before a step, and only where it leads there.

A switch that is not pressed costs two cycles, or four on a port beyond SBIS. Only if it is pressed
does the interrupt look at the direction: away from it the step is made as ever.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from stepgen.plan.end_stops import EndSwitch
from stepgen.plan.instructions import Gate, Instruction, total_cycles

_LIMIT = "19"
_LABELS = (20, 30)  # of the usual way, and of the way at the end of a level


@dataclass(frozen=True)
class Polls:
    """
    The looks of one motor at *switches*; *handler* takes over where a step would lead into one.
    """

    switches: Sequence[EndSwitch]
    handler: str

    def before(self, step: Sequence[Instruction], way: int) -> tuple[Instruction, ...]:
        """
        Return *step* with the look before it: on the usual *way*, 0, or that at a level's end, 1.
        """
        looks = [_look(switch, _LABELS[way] + 2 * n) for n, switch in enumerate(self.switches)]
        parts = [list(part) for part in (*looks, step)]
        for number, part in enumerate(parts[1:]):
            part[0] = replace(part[0], label=str(_LABELS[way] + 2 * number + 1))
        return tuple(instruction for part in parts for instruction in part)

    @property
    def cycles(self) -> int:
        """
        Return the cycles of the look before a step, while no switch is pressed.
        """
        return sum(total_cycles(_look(switch, 0)) for switch in self.switches)

    @property
    def pressed_cycles(self) -> int:
        """
        Return how many more it takes while all of them are pressed, and none matters.
        """
        ways = (total_cycles(_pressed(switch, 0)) for switch in self.switches)
        return sum(cycles + 1 for cycles in ways)  # the RJMP there, less that it is not skipped

    def rare(self, leave: Sequence[Instruction]) -> tuple[Instruction, ...]:
        """
        Return where the looks go on if a switch is pressed; *leave* gives the registers back.
        """
        if not self.switches:
            return ()
        pressed = [
            instruction
            for way in _LABELS
            for number, switch in enumerate(self.switches)
            for instruction in _pressed(switch, way + 2 * number)
        ]
        first, *others = leave
        out = Instruction(f"jmp   {self.handler}", 3)
        return (*pressed, replace(first, label=_LIMIT), *others, out)

    def entry_cycles(self, leave: Sequence[Instruction]) -> int:
        """
        Return the cycles from the look's begin to the first instruction of the handler, at most.
        """
        if not self.switches:
            return 0
        return self.cycles + self.pressed_cycles + total_cycles(leave) + 3


def with_switches(gate: Gate, switches: Sequence[EndSwitch], *, homes: bool) -> Gate:
    """
    Return *gate* with the registers and constants that the looks at *switches* name.

    A motor that *homes* goes on behind the switch that it has seen.
    """
    if not switches:
        return gate
    way = "kReverse | kTouched" if homes else "kReverse"
    return replace(
        gate,
        registers=(*gate.registers, *((switch.end, switch.register) for switch in switches)),
        constants=(*gate.constants, ("way", way), ("back", "kReverse")),
    )


def _look(switch: EndSwitch, pressed: int) -> tuple[Instruction, ...]:
    bit, operand = switch.pin.bit.bit, f"%[{switch.end}]"
    go = Instruction(f"rjmp  {pressed}f", 0)
    note = f"unless the {switch.end} switch is pressed"
    if switch.register.bit_addressable:
        skip = "sbic " if switch.active_high else "sbis "
        return (Instruction(f"{skip} {operand}, {bit}", 2, note), go)
    skip = "sbrc " if switch.active_high else "sbrs "
    return (
        Instruction(f"lds   r24, {operand}", 2, note),
        Instruction(f"{skip} r24, {bit}", 2),
        go,
    )


def _pressed(switch: EndSwitch, label: int) -> tuple[Instruction, ...]:
    """
    Return what follows where *switch* is pressed: on to `_LIMIT` if the motor goes there.
    """
    load = Instruction("lds   r24, %[mode]", 2, f"the {switch.end} switch is", label=str(label))
    mask = Instruction("andi  r24, %[way]", 1, "pressed, and the motor goes there")
    compare = (Instruction("cpi   r24, %[back]", 1),) if switch.end == "low" else ()
    return (
        load,
        mask,
        *compare,
        Instruction(f"breq  {_LIMIT}f", 1),
        Instruction(f"rjmp  {label + 1}b", 2, "no: make the step"),
    )

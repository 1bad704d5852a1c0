"""
What is wired to the board in the picture of the wiring: drivers, limit switches, and their wires.
"""

from dataclasses import dataclass, field

from stepgen.datasheet.drivers import block_height, driver_of
from stepgen.datasheet.scene import COLORS
from stepgen.datasheet.switches import switches_height
from stepgen.devices.outlines import GROUND, Outline, Place
from stepgen.plan.end_stops import EndSwitch
from stepgen.plan.model import MotorPlan, Plan
from stepgen.plan.wires import Wire

_SIDES = ("up", "right", "down")


@dataclass
class Lead:
    """
    One wire; its lane, column and ends are found one after the other.
    """

    motor: MotorPlan
    signal: str
    place: Place
    title: str
    css: str
    x: float = 0
    y: float = 0
    lane: float = 0
    column: int = 0
    end: float = 0

    @property
    def side(self) -> str:
        """
        Return the side to which it leaves the board.
        """
        return self.place.header.side


@dataclass
class Block:
    """
    The driver of a motor, or its limit switches, and the wires that arrive there.
    """

    motor: MotorPlan
    wires: list[Lead] = field(default_factory=list)
    has_switches: bool = False
    top: float = 0

    @property
    def height(self) -> float:
        """
        Return how high it is, its title included.
        """
        rows = len(self.wires)
        return switches_height(rows) if self.has_switches else block_height(rows)


def blocks_of(plan: Plan, outline: Outline) -> list[Block]:
    """
    Return all drivers and switches, those whose wires leave upwards first.

    Raises:
        KeyError: A pin is not on *outline*.
    """
    blocks = [
        *(_driver_block(motor, outline) for motor in plan.motors),
        *(_switch_block(motor, outline) for motor in plan.motors if motor.end_switches),
    ]
    for block in blocks:
        block.wires.sort(key=_arrival)
    return sorted(blocks, key=lambda block: _mean_side(block.wires))


def _driver_block(motor: MotorPlan, outline: Outline) -> Block:
    plugged = driver_of(motor).is_plugged
    css = " plugged" if plugged else ""
    wires = [
        _wire(motor, wire, outline, f"w{index % COLORS + 1}{css}")
        for index, wire in enumerate(motor.drive.every_wire)
    ]
    return Block(motor, wires if plugged else [*wires, _ground(motor, outline, "ground")])


def _switch_block(motor: MotorPlan, outline: Outline) -> Block:
    first = len(motor.drive.every_wire)
    wires = [
        _wire(motor, switch, outline, f"w{(first + index) % COLORS + 1}")
        for index, switch in enumerate(motor.end_switches)
    ]
    wires.append(_ground(motor, outline, "ground of the switches"))
    return Block(motor, wires, has_switches=True)


def _wire(motor: MotorPlan, end: Wire | EndSwitch, outline: Outline, css: str) -> Lead:
    """
    Return the wire to a driver's input or to a switch.
    """
    label, bit = end.pin.label, end.pin.bit.name
    place = {place.label: place for place in outline.places()}[label]
    title = f"motor {motor.name}, {end.signal}: {label} ({bit})"
    return Lead(motor, end.signal, place, title, f"wire {css}")


def _ground(motor: MotorPlan, outline: Outline, name: str) -> Lead:
    grounds = [place for place in outline.places() if place.label == GROUND]
    place = max(grounds, key=lambda place: place.x)
    return Lead(motor, GROUND, place, f"motor {motor.name}, {name}: GND", "wire ground")


def _arrival(lead: Lead) -> tuple[int, int]:
    order = {"up": lead.place.x, "right": lead.place.y, "down": -lead.place.x}
    return _SIDES.index(lead.side), order[lead.side]


def _mean_side(wires: list[Lead]) -> float:
    return sum(_SIDES.index(lead.side) for lead in wires) / len(wires)

"""
The picture of a few wires: each is drawn, from its pin of the board to its driver.

Each wire goes from its pin straight off the board into a lane of its own, along it to a column in
front of the drivers, and from there to its input. Inputs are in the order in which wires
arrive, so that those of one side of the board never cross.
"""

from stepgen.datasheet.blocks import Block, Lead, blocks_of
from stepgen.datasheet.board import LEFT, Footprint, draw_board
from stepgen.datasheet.drivers import (
    MOTOR_WIDTH,
    ROW,
    TITLE_HEIGHT,
    WIDTH,
    draw_driver,
    driver_of,
    input_labels,
    input_y,
)
from stepgen.datasheet.scene import Scene, at
from stepgen.datasheet.switches import draw_switches
from stepgen.devices.outlines import PITCH_MIL, Outline, outline_of
from stepgen.plan.model import Plan

_LARGEST_BOARD = (350, 230)
_LARGEST_SCALE = 0.18  # units per mil
_LANE, _COLUMN = 6, 5.5
_NAME_ROOM = 26  # in front of a driver, for the pins' names
_GAP = 8


def routed_scene(plan: Plan) -> Scene:
    """
    Return the picture of all wires of *plan*, however large.

    Raises:
        KeyError: The board, or one of the pins, is on no outline.
    """
    outline = outline_of(plan.board)
    scale = _scale(outline)
    blocks = blocks_of(plan, outline)
    wires = [wire for block in blocks for wire in block.wires]
    ups = _lanes(blocks, "up")
    top = _GAP + max(len(ups) * _LANE, TITLE_HEIGHT) + _GAP
    lies = Footprint(outline, scale, top)
    bottom = _stack(blocks, top, lies.height)
    for index, wire in enumerate(ups):
        wire.lane = top - _GAP - (len(ups) - 1 - index) * _LANE
    downs = _lanes(blocks, "down")
    for index, wire in enumerate(downs):
        wire.lane = bottom + _GAP + (len(downs) - 1 - index) * _LANE
    for wire in wires:
        wire.x, wire.y = lies.at(wire.place.x, wire.place.y)
    columns = _columns(ups, downs, [wire for wire in wires if wire.side == "right"], scale)
    driver_x = LEFT + lies.width + _GAP + columns * _COLUMN + _NAME_ROOM
    scene = Scene(
        title=f"Wiring on the {plan.board.title}",
        description="; ".join(wire.title for wire in wires),
        width=at(driver_x + WIDTH + MOTOR_WIDTH + _GAP),
        height=at(bottom + _GAP + len(downs) * _LANE + 4),
        note=_note(plan),
    )
    draw_board(scene, plan.board, lies, {wire.place for wire in wires})
    for wire in wires:
        scene.stroke(_path(wire, driver_x, scale), wire.css, wire.title)
        scene.dot(wire.x, wire.y, 3, f"pin {wire.css}", wire.title)
        scene.write(driver_x - 3, wire.end - 2, wire.place.label, "pin-name end")
    for block in blocks:
        _draw_block(scene, block, driver_x)
    return scene


def _note(plan: Plan) -> str:
    plugged = any(driver_of(motor).is_plugged for motor in plan.motors)
    dashed = " Dashed: connections that a shield makes by itself." if plugged else ""
    return f"The board from above, not to scale.{dashed}"


def _draw_block(scene: Scene, block: Block, x: float) -> None:
    motor, signals = block.motor, [wire.signal for wire in block.wires]
    scene.write(x, block.top + 9, motor.name, "strong")
    if block.has_switches:
        scene.write(x, block.top + 20, "limit switches, not pressed", "quiet")
        draw_switches(scene, motor, x, block.top, signals)
    else:
        scene.write(x, block.top + 20, motor.drive.title, "quiet")
        draw_driver(scene, motor, x, block.top, input_labels(motor, signals))


def _scale(outline: Outline) -> float:
    widest, highest = _LARGEST_BOARD
    return min(_LARGEST_SCALE, widest / outline.width, highest / outline.height)


def _lanes(blocks: list[Block], side: str) -> list[Lead]:
    """
    Return the wires of *side*, the one whose lane is farthest from the board first.
    """
    ordered = blocks if side == "up" else list(reversed(blocks))
    return [
        wire
        for block in ordered
        for wire in (block.wires if side == "up" else reversed(block.wires))
        if wire.side == side
    ]


def _stack(blocks: list[Block], top: float, height: float) -> float:
    """
    Place the drivers one below the other, beside the board; return where the lower of both ends.
    """
    needed = sum(block.height for block in blocks)
    y = top - TITLE_HEIGHT + max(0.0, (height + TITLE_HEIGHT - needed) / 2)
    for block in blocks:
        block.top = y
        for index, wire in enumerate(block.wires):
            wire.end = input_y(y, index)
        y += block.height
    return max(top + height, y - ROW)


def _columns(ups: list[Lead], downs: list[Lead], rights: list[Lead], scale: float) -> int:
    """
    Give each wire a column, counted from the drivers, in which no other wire is at its height.
    """
    taken: list[list[tuple[float, float]]] = []

    def place(wire: Lead, first: int) -> int:
        start = wire.lane or _leaving_y(wire, scale)
        low, high = sorted((start, wire.end))
        column = first
        while column < len(taken) and any(a < high and low < b for a, b in taken[column]):
            column += 1
        if column == len(taken):
            taken.append([])
        taken[column].append((low - 2, high + 2))
        wire.column = column
        return column + 1

    for group in (ups, downs):
        free = 0
        for wire in group:
            free = place(wire, free)
    free = len(taken)
    for wire in rights:
        free = place(wire, free)
    return len(taken)


def _leaving_y(wire: Lead, scale: float) -> float:
    inner = wire.place.header.is_inner
    return wire.y + (PITCH_MIL * scale / 2 if inner else 0)


def _path(wire: Lead, driver_x: float, scale: float) -> str:
    """
    Return the way of *wire*; from an inner row it goes between two pins of the outer one.
    """
    column = driver_x - _NAME_ROOM - wire.column * _COLUMN
    start = f"M{at(wire.x)} {at(wire.y)}"
    if wire.side == "right":
        off = f"V{at(_leaving_y(wire, scale))}"
    else:
        aside = PITCH_MIL * scale / 2 if wire.place.header.is_inner else 0
        off = f"H{at(wire.x + aside)}V{at(wire.lane)}"
    return f"{start}{off}H{at(column)}V{at(wire.end)}H{at(driver_x)}"

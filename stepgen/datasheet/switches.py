"""
What limit switches look like in the picture of the wiring.
"""

from collections.abc import Sequence

from stepgen.datasheet.drivers import ROW, TITLE_HEIGHT, WIDTH, input_y
from stepgen.datasheet.scene import Scene, at
from stepgen.devices.outlines import GROUND
from stepgen.plan.end_stops import EndSwitch
from stepgen.plan.model import MotorPlan

_MARGIN = 10
_NOTE_HEIGHT = 12
_CONTACT, _GAP = WIDTH - 44, 16  # where its first contact is, and how far the second one
_RAIL = WIDTH - 12  # what all of them lead to
_OPEN = 7  # how far the lever of an open switch is from the contact


def switches_height(rows: int) -> float:
    """
    Return the height of the switches of one motor with *rows* wires, its title included.
    """
    return TITLE_HEIGHT + (rows - 1) * ROW + 2 * _MARGIN + _NOTE_HEIGHT


def draw_switches(
    scene: Scene, motor: MotorPlan, x: float, top: float, signals: Sequence[str]
) -> None:
    """
    Draw the switches of *motor* as they are in mid-way, in the order of *signals*, and ground.

    What they are called stands above, in the first ``TITLE_HEIGHT`` below *top*, and is not drawn.
    """
    height = switches_height(len(signals)) - TITLE_HEIGHT - _NOTE_HEIGHT
    scene.box(x, top + TITLE_HEIGHT, WIDTH, height, "driver switches")
    rows = {signal: input_y(top, index) for index, signal in enumerate(signals)}
    for signal, y in rows.items():
        scene.write(x + 5, y + 3.4, signal, "on-driver")
    grounded = [switch for switch in motor.end_switches if switch.pull_up]
    for switch in motor.end_switches:
        if switch.pull_up:
            _draw_switch(scene, motor, switch, x, rows[switch.signal])
        else:
            scene.write(x + _RAIL - 4, rows[switch.signal] + 3.4, "sensor", "on-driver end")
        remark = f"{switch.level} at the end"
        scene.write(x + WIDTH + 6, rows[switch.signal] + 3.4, remark, "quiet")
    if grounded:
        ends = [rows[GROUND], *(rows[switch.signal] for switch in grounded)]
        scene.stroke(
            f"M{at(x + 30)} {at(rows[GROUND])}H{at(x + _RAIL)}"
            f"M{at(x + _RAIL)} {at(min(ends))}V{at(max(ends))}",
            "coil",
            f"motor {motor.name}, switches to ground",
        )


def _draw_switch(scene: Scene, motor: MotorPlan, switch: EndSwitch, x: float, y: float) -> None:
    """
    Draw a contact, from its name to the rail: closed if it opens at the end.
    """
    start, end = x + _CONTACT, x + _CONTACT + _GAP
    way = "opens" if switch.active_high else "closes"
    lever = 0 if switch.active_high else -_OPEN
    scene.stroke(
        f"M{at(x + 50)} {at(y)}H{at(start)}l{_GAP} {lever}M{at(end)} {at(y)}H{at(x + _RAIL)}",
        "coil",
        f"motor {motor.name}, switch of the {switch.signal}: {way} there",
    )
    scene.dot(start, y, 1.6, "terminal")
    scene.dot(end, y, 1.6, "terminal")

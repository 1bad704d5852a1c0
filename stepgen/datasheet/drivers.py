"""
What drivers look like in the picture of the wiring: an entry for each kind with looks of its own.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from stepgen.datasheet.scene import Scene, at
from stepgen.plan.model import MotorPlan

WIDTH = 104
ROW = 12
TITLE_HEIGHT = 25
_NOTE_HEIGHT = 18
_LEAD = 20
_BUMPS = 3
_MOTOR_RADIUS = 19
MOTOR_WIDTH = 98
_LEAST_ROWS = 4
_MARGIN = 10


@dataclass(frozen=True)
class Driver:
    """
    How a driver is drawn.

    Args:
        outputs: Its terminals for the motor; two that follow each other are the ends of a winding.
        inputs: What its inputs are called, by the plan's signals; others are called as there.
        note: Where the motor's current comes from.
        is_plugged: Whether it sits on the board's headers, so that nobody has wires to lay.
        is_tapped: Whether the middle of each winding goes to the motor supply.
    """

    outputs: tuple[str, str, str, str] = ("A+", "A-", "B+", "B-")
    inputs: Mapping[str, str] = field(default_factory=dict)
    note: str = "motor supply: at the driver"
    is_plugged: bool = False
    is_tapped: bool = False


_DRIVERS = {
    "motor-shield": Driver(note="plugged on; motor supply: Vin, GND", is_plugged=True),
    # Coils A to D follow each other, so A and C, B and D are the halves of one winding.
    "four-wire": Driver(
        outputs=("OUT1", "OUT3", "OUT2", "OUT4"),
        inputs={"coil A": "IN1", "coil B": "IN2", "coil C": "IN3", "coil D": "IN4"},
        note="motor supply: COM and GND",
        is_tapped=True,
    ),
}
_OTHER = Driver()


def driver_of(motor: MotorPlan) -> Driver:
    """
    Return the looks of the driver of *motor*; without looks of its own it has two bipolar coils.
    """
    return _DRIVERS.get(motor.drive.kind, _OTHER)


def block_height(inputs: int) -> float:
    """
    Return the height of a driver with *inputs* inputs, its title and note included.
    """
    return TITLE_HEIGHT + _box_height(inputs) + _NOTE_HEIGHT


def input_y(top: float, index: int) -> float:
    """
    Return where input number *index* is, in a block that begins at *top*.
    """
    return top + TITLE_HEIGHT + _MARGIN + index * ROW


def input_labels(motor: MotorPlan, signals: Iterable[str]) -> list[str]:
    """
    Return what the inputs of *signals* are called at the driver of *motor*.
    """
    inputs = driver_of(motor).inputs
    return [inputs.get(signal, signal) for signal in signals]


def draw_driver(scene: Scene, motor: MotorPlan, x: float, top: float, labels: list[str]) -> None:
    """
    Draw the driver of *motor* with the inputs *labels*, and the motor on its right.

    What it is called stands above, in the first ``TITLE_HEIGHT`` below *top*, and is not drawn.
    """
    driver = driver_of(motor)
    height = _box_height(len(labels))
    scene.box(x, top + TITLE_HEIGHT, WIDTH, height, "driver")
    for index, label in enumerate(labels):
        scene.write(x + 5, input_y(top, index) + 3.4, label, "on-driver")
    scene.write(x, top + TITLE_HEIGHT + height + 12, driver.note, "quiet")
    _draw_motor(scene, motor, driver, x + WIDTH, top + TITLE_HEIGHT, height)


def _box_height(inputs: int) -> float:
    return max(inputs, _LEAST_ROWS) * ROW + 2 * _MARGIN - ROW


def _draw_motor(
    scene: Scene, motor: MotorPlan, driver: Driver, x: float, top: float, height: float
) -> None:
    spread = min(2.0 * ROW, (height - 2 * _MARGIN) / 3)
    first = top + height / 2 - 1.5 * spread
    rows = [first + index * spread for index in range(4)]
    r = spread / _BUMPS / 2
    for start, end in ((0, 1), (2, 3)):
        bumps = f"a{at(r)} {at(r)} 0 0 1 0 {at(2 * r)}" * _BUMPS
        lead = f"M{at(x)} {at(rows[start])}h{_LEAD}"
        ends = f"{driver.outputs[start]} to {driver.outputs[end]}"
        scene.stroke(f"{lead}{bumps}h{-_LEAD}", "coil", f"motor {motor.name}, winding from {ends}")
    for row, label in zip(rows, driver.outputs, strict=True):
        scene.dot(x, row, 2.2, "terminal")
        scene.write(x - 6, row + 3.4, label, "on-driver end")
    tap = x + _LEAD + r + 8
    if driver.is_tapped:
        middles = [(rows[0] + rows[1]) / 2, (rows[2] + rows[3]) / 2]
        away = at(tap - x - _LEAD - r)
        scene.stroke(
            f"M{at(x + _LEAD + r)} {at(middles[0])}h{away}V{at(middles[1])}h-{away}"
            f"M{at(tap)} {at(middles[0])}V{at(rows[0] - 5)}",
            "coil",
            f"motor {motor.name}, middle of both windings to the motor supply",
        )
        scene.write(tap - 3, rows[0] - 7, "+ supply", "quiet")
    center = (tap + 12 + _MOTOR_RADIUS, top + height / 2)
    scene.dot(*center, _MOTOR_RADIUS, "motor", f"motor {motor.name}")
    scene.write(center[0], center[1] + 5, "M", "on-motor")

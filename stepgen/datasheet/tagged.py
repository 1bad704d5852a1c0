"""
The picture of many wires: each pin bears a tag with its motor and signal, and no wire is drawn.

Below the board each kind of driver, and of limit switches, is drawn once, with the names of the
motors that have it.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from textwrap import wrap

from stepgen.datasheet.board import LEFT, Footprint, draw_board
from stepgen.datasheet.drivers import (
    MOTOR_WIDTH,
    WIDTH,
    block_height,
    draw_driver,
    input_labels,
    input_y,
)
from stepgen.datasheet.names import tag_names, together
from stepgen.datasheet.scene import COLORS, Scene, at
from stepgen.datasheet.switches import draw_switches, switches_height
from stepgen.devices.outlines import GROUND, PITCH_MIL, Outline, Place, Side, outline_of
from stepgen.plan.end_stops import EndSwitch
from stepgen.plan.model import MotorPlan, Plan
from stepgen.plan.wires import Wire

WIDEST = 702
"""Units that paper is wide, between its margins."""

_PITCH = 11  # between two pins; tags need so much
_LETTER = 6.2  # how wide one is, at most in the mean
_BOLD_LETTER = 7.2
_LINE = 11
_GAP = 8
_STUB = 14


@dataclass(frozen=True)
class Tag:
    """
    What is wired to a pin.
    """

    place: Place
    text: str
    title: str
    css: str

    @property
    def length(self) -> float:
        """
        Return how long it is, across the board's edge.
        """
        return len(self.text) * _LETTER + 6

    @property
    def is_far(self) -> bool:
        """
        Return whether it lies behind those of the outer row.
        """
        return self.place.header.is_inner


def tagged_scene(plan: Plan) -> Scene:
    """
    Return the picture of all pins of *plan*, with a tag on each that is used.

    Raises:
        KeyError: The board, or one of the pins, is on no outline.
    """
    outline = outline_of(plan.board)
    tags = tuple(_tags(plan, outline))
    above, right, below = (_room(tags, side) for side in ("up", "right", "down"))
    lies = Footprint(outline, _PITCH / PITCH_MIL, above + _GAP)
    scene = Scene(
        title=f"Wiring on the {plan.board.title}",
        description="; ".join(tag.title for tag in tags),
        width=at(max(LEFT + lies.width + right + _GAP, WIDEST)),
        note="The board from above, not to scale. The tag of a pin names the motor and the "
        "signal; each kind of driver and of switches is drawn once.",
    )
    draw_board(scene, plan.board, lies, {tag.place for tag in tags})
    for tag in tags:
        _draw_tag(scene, tag, lies, tags)
    bottom = lies.top + lies.height + below + _GAP
    scene.height = at(_draw_kinds(scene, plan, bottom))
    return scene


def _tags(plan: Plan, outline: Outline) -> Iterator[Tag]:
    places = {place.label: place for place in outline.places()}
    for index, (motor, name) in enumerate(zip(plan.motors, tag_names(plan), strict=True)):
        ends: Sequence[Wire | EndSwitch] = (*motor.drive.every_wire, *motor.end_switches)
        for end in ends:
            label = end.pin.label
            title = f"motor {motor.name}, {end.signal}: {label} ({end.pin.bit.name})"
            yield Tag(places[label], f"{name} {end.signal}", title, f"w{index % COLORS + 1}")


def _room(tags: Sequence[Tag], side: Side) -> float:
    """
    Return how far the tags of *side* reach beyond the board.
    """
    return _near(tags, side) + max(
        (tag.length for tag in tags if tag.place.header.side == side and tag.is_far), default=0
    )


def _near(tags: Sequence[Tag], side: Side) -> float:
    """
    Return how far those of the outer row reach.
    """
    near = (tag.length for tag in tags if tag.place.header.side == side and not tag.is_far)
    return max((length + _GAP for length in near), default=_GAP)


def _draw_tag(scene: Scene, tag: Tag, lies: Footprint, tags: Sequence[Tag]) -> None:
    """
    Draw the wire from the pin off the board, and the tag at its end.
    """
    x, y = lies.at(tag.place.x, tag.place.y)
    side = tag.place.header.side
    off = _near(tags, side) if tag.is_far else _GAP
    aside = _PITCH / 2 if tag.is_far else 0
    thick = _PITCH - 1.4
    scene.dot(x, y, 3, f"pin {tag.css}", tag.title)
    if side == "right":
        edge = LEFT + lies.width + off
        scene.stroke(f"M{at(x)} {at(y)}V{at(y + aside)}H{at(edge)}", f"wire {tag.css}", tag.title)
        scene.box(edge, y + aside - thick / 2, tag.length, thick, f"tag {tag.css}")
        scene.write(edge + 3, y + aside + 3.4, tag.text, "on-tag")
        return
    up = side == "up"
    edge = lies.top - off if up else lies.top + lies.height + off
    scene.stroke(f"M{at(x)} {at(y)}H{at(x + aside)}V{at(edge)}", f"wire {tag.css}", tag.title)
    outer = edge - tag.length if up else edge
    scene.box(x + aside - thick / 2, outer, thick, tag.length, f"tag {tag.css}")
    start = edge - 3 if up else edge + 3
    scene.write(x + aside + 3.4, start, tag.text, "on-tag" if up else "on-tag end", -90)


@dataclass
class Kind:
    """
    What is drawn once: a driver or limit switches, as the first of *motors* has them.
    """

    motors: list[MotorPlan]
    signals: tuple[str, ...]
    has_switches: bool

    @property
    def height(self) -> float:
        """
        Return how high it is, its title included.
        """
        rows = len(self.signals)
        return switches_height(rows) if self.has_switches else block_height(rows)

    @property
    def title(self) -> str:
        """
        Return what it is.
        """
        return "limit switches, not pressed" if self.has_switches else self.motors[0].drive.title


def _kinds(plan: Plan) -> Iterator[Kind]:
    """
    Yield each kind of driver, then each kind of limit switches.
    """
    drivers: dict[tuple[str, ...], Kind] = {}
    switches: dict[tuple[tuple[str, str, bool], ...], Kind] = {}
    for motor in plan.motors:
        signals = tuple(wire.signal for wire in motor.drive.every_wire)
        one = Kind([], (*signals, GROUND), has_switches=False)
        drivers.setdefault((motor.drive.title, *signals), one).motors.append(motor)
        ends = tuple((end.signal, end.level, end.pull_up) for end in motor.end_switches)
        if ends:
            named = (*(signal for signal, _, _ in ends), GROUND)
            one = Kind([], named, has_switches=True)
            switches.setdefault(ends, one).motors.append(motor)
    yield from drivers.values()
    yield from switches.values()


def _draw_kinds(scene: Scene, plan: Plan, top: float) -> float:
    """
    Draw all kinds from *top* on, as many in a row as there is room for; return where they end.
    """
    kinds = tuple(_kinds(plan))
    count = min(len(kinds), int(float(scene.width) / (_STUB + WIDTH + MOTOR_WIDTH)))
    slot = float(scene.width) / count
    for first in range(0, len(kinds), count):
        row = kinds[first : first + count]
        names = [
            wrap(together(one.motors, plan), int((slot - _STUB) / _BOLD_LETTER)) for one in row
        ]
        lines = max(map(len, names))
        for index, (one, text) in enumerate(zip(row, names, strict=True)):
            _draw_kind(scene, one, text, index * slot + _STUB, top + lines * _LINE)
        top += (lines - 1) * _LINE + max(one.height for one in row) + _GAP
    return top - _GAP


def _draw_kind(scene: Scene, kind: Kind, names: list[str], x: float, top: float) -> None:
    """
    Draw *kind* with the *names* of its motors above *top*, where its title is.
    """
    for index, line in enumerate(reversed(names)):
        scene.write(x, top - 2 - index * _LINE, line, "strong")
    top -= _LINE
    scene.write(x, top + 20, kind.title, "quiet")
    motor = kind.motors[0]
    for index in range(len(kind.signals)):
        y = input_y(top, index)
        scene.stroke(f"M{at(x - _STUB + 2)} {at(y)}H{at(x)}", "coil")
    if kind.has_switches:
        draw_switches(scene, motor, x, top, kind.signals)
    else:
        draw_driver(scene, motor, x, top, input_labels(motor, kind.signals))

"""
The board in the picture of the wiring, seen from above: its edge, its parts and its pins.
"""

from collections.abc import Collection
from dataclasses import dataclass

from stepgen.datasheet.scene import Scene, at
from stepgen.devices import Board
from stepgen.devices.outlines import Outline, Place

LEFT = 30
"""Room for connectors, which stick out."""

_HOLE_MIL = 63


@dataclass(frozen=True)
class Footprint:
    """
    Where a board lies in the picture.

    Args:
        outline: What it looks like.
        scale: Units of the picture per mil.
        top: Where its upper edge is.
    """

    outline: Outline
    scale: float
    top: float

    @property
    def width(self) -> float:
        """
        Return how wide it is in the picture.
        """
        return self.outline.width * self.scale

    @property
    def height(self) -> float:
        """
        Return how high it is in the picture.
        """
        return self.outline.height * self.scale

    def at(self, x_mil: float, y_mil: float) -> tuple[float, float]:
        """
        Return where in the picture a place of the outline is.
        """
        return LEFT + x_mil * self.scale, self.top + y_mil * self.scale


def draw_board(scene: Scene, board: Board, lies: Footprint, used: Collection[Place]) -> None:
    """
    Draw *board* with all its pins; those that are *used* stand out.
    """
    outline, scale = lies.outline, lies.scale
    edge = "L".join(f"{at(x)} {at(y)}" for x, y in (lies.at(*one) for one in outline.corners))
    scene.stroke(f"M{edge}z", "board", board.title)
    for hole in outline.holes:
        scene.dot(*lies.at(*hole), _HOLE_MIL * scale, "hole")
    for part in outline.parts:
        scene.box(*lies.at(part.x, part.y), part.width * scale, part.height * scale, "part")
        name = board.mcu.title if part.name == "chip" else part.name
        x, y = lies.at(part.x + part.width / 2, part.y + part.height / 2)
        scene.write(x, y + 3.4, name, "on-part middle")
    scene.write(*lies.at(*outline.title), board.title, "board-name middle")
    for place in outline.places():
        _draw_pin(scene, place, lies, is_used=place in used)


def _draw_pin(scene: Scene, place: Place, lies: Footprint, *, is_used: bool) -> None:
    """
    Draw a pin and its name as boards have it printed beside it: without the D of digital pins.
    """
    x, y = lies.at(place.x, place.y)
    name = place.label.removeprefix("D") if place.label[1:].isdigit() else place.label
    scene.dot(x, y, 2, "hole")
    css = "used" if is_used else "free"
    if place.header.side == "up":
        scene.write(x + 3.4, y + 4, name, f"{css} end", -90)
    elif place.header.side == "down":
        scene.write(x + 3.4, y - 4, name, css, -90)
    elif place.header.is_inner:
        scene.write(x - 5, y + 3.4, name, f"{css} end")
    else:
        scene.write(x + 5, y + 3.4, name, css)

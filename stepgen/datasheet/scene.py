"""
A drawing as finished SVG geometry: the template prints it and decides nothing.
"""

from dataclasses import dataclass, field

COLORS = 6
"""Of wires and tags: the classes ``w1`` and so on of the style."""


@dataclass(frozen=True)
class Stroke:
    """
    A path; *title* is what screen readers and tooltips say of it, or "".
    """

    d: str
    css: str
    title: str = ""


@dataclass(frozen=True)
class Dot:
    """
    A circle.
    """

    x: str
    y: str
    r: str
    css: str
    title: str = ""


@dataclass(frozen=True)
class Label:
    """
    A text; *turn* is an SVG transform or "".
    """

    x: str
    y: str
    text: str
    css: str
    turn: str = ""


@dataclass
class Scene:
    """
    A drawing: first its strokes are drawn, then its dots, then its labels.

    Its unit is a pixel, 1/96 inch, when it is printed, so that its type has the size that it says.

    Args:
        note: What stands below it, or "".
    """

    title: str
    description: str
    width: str = "0"
    height: str = "0"
    strokes: list[Stroke] = field(default_factory=list)
    dots: list[Dot] = field(default_factory=list)
    labels: list[Label] = field(default_factory=list)
    note: str = ""

    def stroke(self, d: str, css: str, title: str = "") -> None:
        """
        Add a path.
        """
        self.strokes.append(Stroke(d, css, title))

    def box(self, x: float, y: float, width: float, height: float, css: str) -> None:
        """
        Add a rectangle.
        """
        self.stroke(f"M{at(x)} {at(y)}h{at(width)}v{at(height)}h{at(-width)}z", css)

    def dot(self, x: float, y: float, r: float, css: str, title: str = "") -> None:
        """
        Add a circle.
        """
        self.dots.append(Dot(at(x), at(y), at(r), css, title))

    def write(self, x: float, y: float, text: str, css: str, degrees: int = 0) -> None:
        """
        Add a text, turned around its own place.
        """
        turn = f"rotate({degrees} {at(x)} {at(y)})" if degrees else ""
        self.labels.append(Label(at(x), at(y), text, css, turn))


def at(length: float) -> str:
    """
    Return *length* in a drawing's units, to a tenth of one.
    """
    return f"{round(length, 1) + 0.0:g}"

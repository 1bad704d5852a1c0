"""
Plots as self-contained SVG: the frame, lines and texts that all of them are made of.
"""

from xml.etree import ElementTree as ET

Point = tuple[float, float]

_STYLE = (
    "text{font:13px sans-serif;fill:#222}.grid{stroke:#ddd}.axis{stroke:#222}"
    ".end{text-anchor:end}.middle{text-anchor:middle}.title{font-weight:bold;font-size:15px}"
)


def drawing(width: int, height: int, title: str, style: str) -> ET.Element:
    """
    Return an empty picture on white with its *title*, and *style* beside the common one.
    """
    root = ET.Element(
        "svg",
        xmlns="http://www.w3.org/2000/svg",
        viewBox=f"0 0 {width} {height}",
        width=str(width),
        height=str(height),
        role="img",
    )
    ET.SubElement(root, "title").text = title
    ET.SubElement(root, "style").text = _STYLE + style
    ET.SubElement(root, "rect", width="100%", height="100%", fill="#fff")
    return root


def text_of(root: ET.Element) -> str:
    """
    Return the file of the picture *root*.
    """
    ET.indent(root)
    return ET.tostring(root, encoding="unicode") + "\n"


def line(root: ET.Element, kind: str, start: Point, end: Point) -> None:
    """
    Draw a straight line of the class *kind*.
    """
    ends = {"x1": start[0], "y1": start[1], "x2": end[0], "y2": end[1]}
    ET.SubElement(root, "line", {"class": kind}, **{key: f"{at:.1f}" for key, at in ends.items()})


def curve(root: ET.Element, kind: str, points: list[Point]) -> None:
    """
    Draw lines from point to point, of the class *kind*.
    """
    shown = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    ET.SubElement(root, "polyline", {"class": kind, "points": shown})


def dot(root: ET.Element, kind: str, at: Point) -> None:
    """
    Draw a dot of the class *kind*.
    """
    place = {"cx": f"{at[0]:.1f}", "cy": f"{at[1]:.1f}"}
    ET.SubElement(root, "circle", {"class": kind, "r": "3"}, **place)


def write(root: ET.Element, text: str, x: float, y: float, kind: str = "start") -> None:
    """
    Write *text* at a place, of the class *kind*.
    """
    ET.SubElement(root, "text", {"class": kind}, x=f"{x:.1f}", y=f"{y:.1f}").text = text

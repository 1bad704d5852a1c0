"""
``stepgen simulate``: the picture of a run.
"""

from itertools import pairwise
from pathlib import Path
from xml.etree import ElementTree as ET

from tests.cli.conftest import Stepgen

SVG = "{http://www.w3.org/2000/svg}"
SPECS = Path(__file__).parents[2] / "specs"


def test_the_plot_shows_each_change_of_each_wire(stepgen: Stepgen, pan: Path) -> None:
    """
    Eight full steps and back change each DIR wire eight times, and PWM A and B four times.
    """
    run = stepgen("simulate", pan, "--plot", pan.parent / "run.svg")

    root = ET.parse(pan.parent / "run.svg").getroot()  # noqa: S314 - our own
    wires = [line.get("points", "") for line in root.iter(f"{SVG}polyline")]
    changes = [sum(one == two for one, two in pairwise(heads(wire))) for wire in wires]
    names = [text.text for text in root.iter(f"{SVG}text") if text.get("class") == "end"]
    assert run.code == 0, run.err
    assert changes == [8, 8, 4, 4]
    assert names[-4:] == ["motor DIR A D12", "motor DIR B D13", "motor PWM A D3", "motor PWM B D11"]


def heads(points: str) -> list[str]:
    """
    Return the x of each point of a polyline: a change is two points above each other.
    """
    return [point.split(",")[0] for point in points.split()]


def test_a_plot_is_svg(stepgen: Stepgen, pan: Path) -> None:
    """
    Another ending is refused before anything is compiled.
    """
    run = stepgen("simulate", pan, "--plot", "run.png")

    assert run.code == 2
    assert "give a name that ends in .svg" in run.err
    assert not (pan.parent / "run.png").exists()

"""
The datasheet in Chromium: it can be read in light and dark, in wide windows and narrow ones.
"""

import re
from pathlib import Path

import pytest
from PIL import Image

from stepgen import api
from tests.datasheet.browser import chromium, looked_at
from tests.datasheet.large import LARGE, large
from tests.datasheet.pages import page, report_of, spec

DARK = {"light": (), "dark": ("--force-dark-mode",)}
PAPER = {"light": (0xFF, 0xFF, 0xFF), "dark": (0x12, 0x17, 0x1D)}  # --paper in style.css.j2
# A shield on an Uno, two motors on a Mega, small boards with four wires, ramps, timer 2,
# and boards with an ATmega32U4.
LOOKED_AT = (
    "uno_motor_shield",
    "mega_pan_tilt",
    "nano_uln2003_port_c",
    "pro-mini-8mhz_28byj48",
    "mega_stacked_shields_variable",
    "uno_28byj48_ramp",
    "uno_homing",
    "leonardo_motor_shield",
    "micro_slider",
)


@pytest.mark.parametrize("scheme", DARK)
@pytest.mark.parametrize("name", LOOKED_AT)
def test_everything_can_be_read(tmp_path: Path, name: str, scheme: str) -> None:
    """
    Contrast is WCAG's AA for each text and line; no label leaves its picture or covers another.
    """
    found = looked_at(tmp_path, page(spec(name)), "--window-size=1100,4000", *DARK[scheme])

    assert found["dark"] == (scheme == "dark")
    assert found["texts"] > 150
    assert found["lines"] > 5
    assert found["faint"] == []
    assert found["outside"] == []
    assert found["overlapping"] == []


@pytest.mark.parametrize("name", LARGE)
def test_a_crowded_picture_can_be_read(tmp_path: Path, name: str) -> None:
    """
    Long names, twelve motors, wires from every side and both inner rows, switches of every kind.
    """
    found = looked_at(tmp_path, page(large(name, tmp_path)), "--window-size=1100,5000")

    assert found["faint"] == []
    assert found["outside"] == []
    assert found["overlapping"] == []


@pytest.mark.parametrize("outcome", ["passed", "failed"])
@pytest.mark.parametrize("scheme", DARK)
def test_the_outcome_can_be_read(tmp_path: Path, scheme: str, outcome: str) -> None:
    """
    So can the outcome of a verification, good or bad.
    """
    path = spec("uno_motor_shield")
    checks = [{"name": "the pattern", "passed": outcome == "passed", "detail": "step 3"}]
    report = report_of(api.plan(path), passed=outcome == "passed", checks=checks)
    found = looked_at(tmp_path, page(path, report), "--window-size=1100,4000", *DARK[scheme])

    assert found["faint"] == []


@pytest.mark.parametrize("width", [1000, 500])
@pytest.mark.parametrize("name", LARGE)
def test_it_needs_no_scrolling_sideways(tmp_path: Path, name: str, width: int) -> None:
    """
    The page is as wide as a window; in a narrow one its pictures and tables scroll by themselves.
    """
    found = looked_at(tmp_path, page(large(name, tmp_path)), f"--window-size={width},800")

    assert found["wide"] <= 0


def test_faint_and_crowded_text_is_noticed(tmp_path: Path) -> None:
    """
    The look itself can fail: grey text, and two labels in the corner, one upon the other.
    """
    text = page(spec("uno_motor_shield")).replace("--ink: #17202a", "--ink: #999999")
    text = re.sub(r'x="[\d.]+" y="[\d.]+" transform="">(PWM [AB])<', r'x="1" y="1">\1<', text)
    found = looked_at(tmp_path, text, "--window-size=1100,4000")

    assert any(line.startswith("DIR A: ") for line in found["faint"])
    assert {"PWM A", "PWM B"} <= set(found["outside"])
    assert "PWM B and PWM A" in found["overlapping"]


@pytest.mark.parametrize("scheme", DARK)
def test_the_picture_of_the_page(tmp_path: Path, scheme: str) -> None:
    """
    A screenshot shows the scheme's paper at the edge, and a board, wires and text on it.
    """
    shot = tmp_path / "shot.png"
    options = (f"--screenshot={shot}", "--window-size=1100,800", *DARK[scheme])
    chromium(tmp_path, page(spec("mega_pan_tilt")), *options)
    with Image.open(shot) as opened:
        picture = opened.convert("RGB")

    assert picture.size == (1100, 800)
    assert picture.getpixel((2, 2)) == PAPER[scheme]
    colors = {color: count for count, color in picture.getcolors(1 << 20) or []}
    board = {"light": (0xD9, 0xEC, 0xE9), "dark": (0x16, 0x37, 0x3B)}[scheme]
    assert colors[board] > 50_000  # of 880 000 pixels
    assert len(colors) > 100

"""
The datasheet in Chromium: it can be read in light and dark, and fits on two pages of paper.
"""

import json
import re
import shutil
import subprocess
from html import unescape
from pathlib import Path
from typing import Any

import pytest
from PIL import Image
from pypdf import PdfReader

from stepgen import api
from tests.datasheet.pages import SPECS, page, report_of, spec

LOOK = Path(__file__).with_name("look.js")
DARK = {"light": (), "dark": ("--force-dark-mode",)}
PAPER = {"light": (0xFF, 0xFF, 0xFF), "dark": (0x12, 0x17, 0x1D)}  # --paper in style.css.j2
A4_POINTS = (595, 842)
# A shield on an Uno, two motors on a Mega, small boards with four wires, ramps, and timer 2.
LOOKED_AT = (
    "uno_motor_shield",
    "mega_pan_tilt",
    "nano_uln2003_port_c",
    "pro-mini-8mhz_28byj48",
    "mega_stacked_shields_variable",
    "uno_28byj48_ramp",
    "uno_homing",
)
LEAST_POINTS = 7.5

CROWDED = """\
library: Crowded
board: mega
motors:
  aMotorWithTheLongestNameOfAll31: {drive: {kind: four-wire, pins: [D22, D23, D24, D25]}, timer: 1}
  second: {drive: {kind: four-wire, pins: [D50, D51, A0, A15]}, timer: 3}
  third: {drive: motor-shield, timer: 4}
  fourth: {drive: {kind: four-wire, pins: [D0, D21, D38, D39]}, timer: 5, motion: update-events}
"""


SIX = """\
library: Six
board: mega
uses: [Serial, Wire]
motors:
  x: {timing: {kind: compare, timer: 1, channel: A}, steps_per_turn: 200, MOVE,
      drive: {kind: step-dir, driver: a4988, socket: ramps-1.4 X, microsteps: 16}}
  y: {timing: {kind: compare, timer: 1, channel: B}, steps_per_turn: 400, MOVE,
      drive: {kind: step-dir, driver: a4988, socket: ramps-1.4 Y, microsteps: 16}}
  z: {timing: {kind: compare, timer: 3, channel: A},
      drive: {kind: step-dir, driver: a4988, socket: ramps-1.4 Z, microsteps: 16}}
  feed: {timing: {kind: compare, timer: 4, channel: A}, steps_per_turn: 200,
         drive: {kind: step-dir, driver: drv8825, socket: ramps-1.4 E0, microsteps: 32}}
  pan: {timing: {kind: compare, timer: 4, channel: B}, motion: update-events, steps_per_turn: 2048,
        drive: {kind: four-wire, pins: [D40, D42, D44, D59]}}
  tilt: {timing: {kind: compare, timer: 5, channel: A}, motion: update-events,
         drive: {kind: four-wire, pins: [D50, D51, D52, D53], sequence: half}}
""".replace("MOVE", "motion: {kind: trapezoid, cruise_speed: 1500, acceleration: 3000}")


SWITCHES = """\
library: Switches
board: mega
motors:
  aMotorWithTheLongestNameOfAll31: {timing: {kind: compare, timer: 1, channel: A}, MOVE,
      drive: {kind: step-dir, driver: a4988, socket: ramps-1.4 X}, limits: {low: D14, high: D15}}
  sensed: {timing: {kind: compare, timer: 1, channel: B}, MOVE, drive: motor-shield,
      limits: {high: {pin: D40, pull_up: false}, low: {pin: D41, active: high}}}
""".replace("MOVE", "motion: {kind: trapezoid, cruise_speed: 1500, acceleration: 3000}")


def chromium(folder: Path, text: str, *options: str) -> str:
    """
    Show the page *text* in Chromium; return what that prints.
    """
    found = shutil.which("chromium")
    assert found, "there is no chromium; `make browser` installs it"
    (folder / "page.html").write_text(text, encoding="utf-8")
    return subprocess.run(
        [
            found,
            "--headless=new",
            "--no-sandbox",  # tests may run as root; the page has no script of its own
            "--disable-gpu",
            "--hide-scrollbars",
            "--no-first-run",
            f"--user-data-dir={folder / 'profile'}",
            *options,
            (folder / "page.html").as_uri(),
        ],
        check=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        encoding="utf-8",
        timeout=120,
    ).stdout


def looked_at(folder: Path, text: str, *options: str) -> dict[str, Any]:
    """
    Return what look.js finds in the page *text*.
    """
    script = LOOK.read_text(encoding="utf-8")
    shown = text.replace("</body>", f"<script>{script}</script></body>")
    dumped = chromium(folder, shown, "--dump-dom", *options)
    match = re.search(r'<pre id="found">(.*?)</pre>', dumped, re.DOTALL)
    assert match
    found: dict[str, Any] = json.loads(unescape(match[1]))
    return found


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


@pytest.mark.parametrize("text", [CROWDED, SWITCHES], ids=["motors", "switches"])
def test_a_crowded_picture_can_be_read(tmp_path: Path, text: str) -> None:
    """
    Four motors with long names on one Mega, with wires from every side and both inner rows.

    So can that of switches of every kind, where a long name stands above them.
    """
    path = tmp_path / "crowded.yaml"
    path.write_text(text, encoding="utf-8")
    found = looked_at(tmp_path, page(path), "--window-size=1100,5000")

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


def test_it_needs_no_scrolling_sideways(tmp_path: Path) -> None:
    """
    A window of 1000 pixels shows the whole width.
    """
    found = looked_at(tmp_path, page(spec("mega_pan_tilt")), "--window-size=1000,800")

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


@pytest.mark.parametrize("path", SPECS, ids=lambda path: path.stem)
def test_it_prints_on_two_pages(tmp_path: Path, path: Path) -> None:
    """
    So does that of every library, with one motor to three, and with all that a verification adds.
    """
    paper = tmp_path / "page.pdf"
    text = page(path, report_of(api.plan(path)))
    chromium(tmp_path, text, f"--print-to-pdf={paper}", "--no-pdf-header-footer")
    pages = PdfReader(paper).pages

    assert len(pages) == 2
    for one in pages:
        width, height = one.mediabox.width, one.mediabox.height
        assert (round(width), round(height)) == A4_POINTS
    assert "Wiring" in pages[0].extract_text()
    assert "45 checks passed" in pages[1].extract_text()


@pytest.mark.parametrize(("text", "most"), [(CROWDED, 3), (SIX, 4)], ids=["four", "six"])
def test_many_motors_print_on_few_pages(tmp_path: Path, text: str, most: int) -> None:
    """
    With four motors of long names on three, with six of every kind of motion on four.
    """
    path, paper = tmp_path / "spec.yaml", tmp_path / "page.pdf"
    path.write_text(text, encoding="utf-8")
    shown = page(path, report_of(api.plan(path)))
    chromium(tmp_path, shown, f"--print-to-pdf={paper}", "--no-pdf-header-footer")
    pages = PdfReader(paper).pages

    assert len(pages) == most
    assert "45 checks passed" in pages[-1].extract_text()


def test_what_is_printed_is_large_enough_to_read() -> None:
    """
    No text around the pictures is smaller on paper than 7.5 points.
    """
    printed = page(spec("mega_pan_tilt")).partition("@media print {")[2].partition("</style>")[0]
    printed = re.sub(r".*\.axis-text.*", "", printed)  # in a picture, in its own units
    sizes = [float(size) for size in re.findall(r"font-size: ([\d.]+)pt", printed)]

    assert len(sizes) == printed.count("font")
    assert min(sizes) == LEAST_POINTS

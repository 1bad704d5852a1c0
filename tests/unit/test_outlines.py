"""
Boards are drawn as the footprints that others publish of them: size, pins and holes.

The numbers below are those of the files that stepgen/devices/outlines.py names, in mm as there; the
place of a pin is told from the upper left corner when USB, or the serial header, is on the left.
"""

import pytest

from stepgen.devices import boards
from stepgen.devices.outlines import Outline, outline_of

MM_PER_MIL = 0.0254
ROUNDING_MM = 0.03  # coordinates are whole mil

SIZES_MM = {
    "uno": (68.58, 53.34),  # -27.94 to 40.64, -2.54 to 50.8
    "leonardo": (68.58, 53.34),
    "mega": (101.6, 53.34),
    "nano": (43.18, 17.78),  # -3.81 to 39.37, -1.27 to 16.51
    "pro-mini": (33.02, 17.78),  # -16.51 to 16.51, -8.89 to 8.89
    "micro": (48.48, 18.034),
}

# The first and the last pin of each row of the footprints, and single pins.
PINS_MM = {
    # KiCad's pad 1 is at 27.94 mm and 2.54 mm from the lower left corner; y = 50.8 - its y.
    "uno": {
        "IOREF": (30.48, 50.8),
        "VIN": (45.72, 50.8),
        "A0": (50.8, 50.8),
        "A5": (63.5, 50.8),
        "D0": (63.5, 2.54),
        "D7": (45.72, 2.54),
        "D8": (41.66, 2.54),
        "D13": (28.96, 2.54),
        "SCL": (18.8, 2.54),
    },
    # y = 53.34 + that of the footprint, whose origin is the lower left corner.
    "leonardo": {
        "SCL": (18.796, 2.54),
        "D8": (41.656, 2.54),
        "D7": (45.72, 2.54),
        "D0": (63.5, 2.54),
        "A0": (50.8, 50.8),
        "D14": (63.627, 22.86),  # MISO
        "D15": (63.627, 25.4),  # SCK
        "D16": (66.167, 25.4),  # MOSI
    },
    "mega": {
        "SCL": (18.796, 2.54),
        "D8": (41.656, 2.54),
        "D7": (45.72, 2.54),
        "D0": (63.5, 2.54),
        "D14": (68.58, 2.54),
        "D21": (86.36, 2.54),
        "A0": (50.8, 50.8),
        "A7": (68.58, 50.8),
        "A8": (73.66, 50.8),
        "A15": (91.44, 50.8),
        "D22": (93.98, 5.08),
        "D23": (96.52, 5.08),
        "D52": (93.98, 43.18),
        "D53": (96.52, 43.18),
    },
    # Rows 15.24 mm apart, 3.81 mm from both ends.
    "nano": {
        "D12": (3.81, 1.27),
        "D2": (29.21, 1.27),
        "D1": (39.37, 1.27),
        "D13": (3.81, 16.51),
        "A0": (11.43, 16.51),
        "A7": (29.21, 16.51),
        "VIN": (39.37, 16.51),
    },
    # x = 16.51 + y of the footprint, y = 8.89 - x of it.
    "pro-mini": {
        "RAW": (3.81, 1.27),
        "A3": (13.97, 1.27),
        "D10": (31.75, 1.27),
        "A4": (15.1206, 4.1959),
        "A5": (12.5806, 4.1959),
        "D1": (3.81, 16.51),
        "D9": (31.75, 16.51),
    },
    # y = 18.034 + that of the footprint.
    "micro": {
        "D12": (3.92, 1.414),
        "D2": (29.32, 1.414),
        "D0": (36.94, 1.414),
        "D17": (42.02, 1.414),  # SS
        "D16": (44.56, 1.414),  # MOSI
        "D13": (3.92, 16.654),
        "A0": (11.54, 16.654),
        "A5": (24.24, 16.654),
        "5V": (31.86, 16.654),
        "D14": (42.02, 16.654),  # MISO
        "D15": (44.56, 16.654),  # SCK
    },
}

HOLES_MM = {
    "uno": ((15.24, 2.54), (13.97, 50.8), (66.04, 17.78), (66.04, 45.72)),
    "mega": (
        (15.24, 2.54),
        (13.97, 50.8),
        (66.04, 17.78),
        (66.04, 45.72),
        (96.52, 50.8),
        (90.17, 2.54),
    ),
}


def outline(name: str) -> Outline:
    """
    Return the outline of the board called *name*.
    """
    (board,) = (board for board in boards() if board.name == name)
    return outline_of(board)


@pytest.mark.parametrize("name", SIZES_MM)
def test_a_board_has_its_size(name: str) -> None:
    """
    Its edge reaches as far as that of the footprint.
    """
    drawn = outline(name)
    size = (drawn.width * MM_PER_MIL, drawn.height * MM_PER_MIL)

    assert size == pytest.approx(SIZES_MM[name], abs=ROUNDING_MM)
    assert max(x for x, _ in drawn.corners) == drawn.width
    assert max(y for _, y in drawn.corners) == drawn.height


@pytest.mark.parametrize("name", PINS_MM)
def test_pins_are_where_the_footprint_has_them(name: str) -> None:
    """
    So are the ends of each row, with which all of it lies right, at a pitch of 2.54 mm.
    """
    places = {place.label: place for place in outline(name).places()}

    for label, where in PINS_MM[name].items():
        pin = (places[label].x * MM_PER_MIL, places[label].y * MM_PER_MIL)
        assert pin == pytest.approx(where, abs=ROUNDING_MM), label


@pytest.mark.parametrize("name", HOLES_MM)
def test_holes_are_where_the_footprint_has_them(name: str) -> None:
    """
    Those that are drawn; some would hide names of pins.
    """
    holes = outline(name).holes

    assert len(holes) == 4
    for x, y in holes:
        hole = pytest.approx((x * MM_PER_MIL, y * MM_PER_MIL), abs=ROUNDING_MM)
        assert any(where == hole for where in HOLES_MM[name])


def test_the_gap_between_pins_7_and_8() -> None:
    """
    It is 160 mil on every board with shield headers: 45.72 mm - 41.656 mm.
    """
    for name in ("uno", "duemilanove", "ethernet", "leonardo", "leonardo-eth", "mega", "mega-adk"):
        places = {place.label: place for place in outline(name).places()}
        assert places["D7"].x - places["D8"].x == 160

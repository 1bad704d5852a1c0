"""
What boards look like from above: outlines and header positions, for pictures of their wiring.

All lengths are in mil (1/1000 inch) from the upper left corner, x to the right and y down, with the
USB connector on the left. Sources, which tests hold the pins against:

- Uno, Nano: KiCad's footprints, in Module.pretty of KiCad/kicad-footprints,
  Arduino_UNO_R3_WithMountingHoles.kicad_mod and Arduino_Nano.kicad_mod: edge, pins, holes, USB and
  power.
- Mega, Leonardo, Micro, Pro Mini, and the names of the Nano's pins: arduino-library.pretty of
  Alarm-Siren/arduino-kicad-library, Arduino_Mega2560_R3_Shield.kicad_mod,
  Arduino_Leonardo_Shield.kicad_mod, Arduino_Micro_Socket.kicad_mod,
  Arduino_Pro_Mini_Socket.kicad_mod and Arduino_Nano_Socket.kicad_mod: edge, pins, and where USB is.

Drawn schematically, since no such source was found: the chips, how deep connectors reach into the
board, the serial header of the Pro Mini, the LED RX of the Leonardo, all that the Ethernet boards
and the Leonardo ETH have unlike Uno and Leonardo, and the Uno Mini, which is half as large with a
pitch of 50 mil and is drawn as an Uno.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Literal

from stepgen.devices.model import Board

Side = Literal["up", "down", "right"]

GROUND = "GND"
PITCH_MIL = 100


@dataclass(frozen=True)
class Header:
    """
    A row of pins at a pitch of 100 mil.

    Args:
        labels: What the pins are called, in their order; "-" is one that is not connected.
        x: Where the first pin is; y likewise.
        side: Where wires leave the board from here.
        downward: Whether the row goes down, not to the right.
        is_inner: Whether another row lies between this one and the edge.
    """

    labels: str
    x: int
    y: int
    side: Side
    downward: bool = False
    is_inner: bool = False


@dataclass(frozen=True)
class Part:
    """
    Something on the board by which people recognise it: a connector, or a chip.
    """

    name: str
    x: int
    y: int
    width: int
    height: int


@dataclass(frozen=True)
class Place:
    """
    Where a pin is, and how a wire leaves it.
    """

    label: str
    x: int
    y: int
    header: Header


@dataclass(frozen=True)
class Outline:
    """
    A family of boards of one shape.

    Args:
        boards: Names of the boards.
        width: The board's width; height likewise.
        corners: The corners of its edge, in their order.
        headers: Its rows of pins.
        parts: Its connectors and chips.
        title: The middle of the place for its name.
        holes: The centres of mounting holes that lie clear of the pins' names.
    """

    boards: tuple[str, ...]
    width: int
    height: int
    corners: tuple[tuple[int, int], ...]
    headers: tuple[Header, ...]
    parts: tuple[Part, ...]
    title: tuple[int, int]
    holes: tuple[tuple[int, int], ...] = ()

    def places(self) -> Iterator[Place]:
        """
        Yield the place of each pin that is connected.
        """
        for header in self.headers:
            for index, label in enumerate(header.labels.split()):
                along = index * PITCH_MIL
                x = header.x + (0 if header.downward else along)
                y = header.y + (along if header.downward else 0)
                if label != "-":
                    yield Place(label, x, y, header)


_DIGITAL = (
    Header("SCL SDA AREF GND D13 D12 D11 D10 D9 D8", 740, 100, "up"),
    Header("D7 D6 D5 D4 D3 D2 D1 D0", 1800, 100, "up"),
)
_POWER = Header("- IOREF RESET 3V3 5V GND GND VIN", 1100, 2000, "down")
_USB_B = Part("USB", -250, 375, 625, 450)
_JACK = Part("power", -75, 1625, 525, 350)

UNO = Outline(
    boards=("uno", "duemilanove"),
    width=2700,
    height=2100,
    corners=(
        (0, 0),
        (2540, 0),
        (2600, 60),
        (2600, 510),
        (2700, 610),
        (2700, 1900),
        (2600, 2000),
        (2600, 2100),
        (0, 2100),
    ),
    headers=(*_DIGITAL, _POWER, Header("A0 A1 A2 A3 A4 A5", 2000, 2000, "down")),
    parts=(_USB_B, _JACK, Part("chip", 1200, 1350, 1250, 300)),
    title=(1350, 800),
    holes=((600, 100), (550, 2000), (2600, 700), (2600, 1800)),
)

UNO_MINI = replace(
    UNO, boards=("uno-mini",), parts=(Part("USB", -60, 850, 330, 360), UNO.parts[-1]), holes=()
)
ETHERNET = replace(
    UNO, boards=("ethernet",), parts=(Part("Ethernet", -80, 325, 860, 640), *UNO.parts[1:])
)

LEONARDO = replace(
    UNO,
    boards=("leonardo",),
    headers=(
        *UNO.headers,
        # Of the ICSP header, whose other pins are 5V, RESET and GND.
        Header("D14 D15", 2505, 900, "right", downward=True, is_inner=True),
        Header("D16", 2605, 1000, "right", downward=True),
        Header("D17", 1000, 450, "up", is_inner=True),  # the LED RX
    ),
    parts=(Part("USB", -39, 440, 330, 320), *UNO.parts[1:]),
)

LEONARDO_ETH = replace(
    LEONARDO,
    boards=("leonardo-eth",),
    parts=(Part("Ethernet", -80, 325, 860, 640), *UNO.parts[1:]),
)

MEGA = Outline(
    boards=("mega", "mega1280", "mega-adk"),
    width=4000,
    height=2100,
    corners=(
        (0, 0),
        (3840, 0),
        (3900, 60),
        (3900, 500),
        (4000, 600),
        (4000, 1950),
        (3900, 2050),
        (3900, 2100),
        (0, 2100),
    ),
    headers=(
        *_DIGITAL,
        Header("D14 D15 D16 D17 D18 D19 D20 D21", 2700, 100, "up"),
        _POWER,
        Header("A0 A1 A2 A3 A4 A5 A6 A7", 2000, 2000, "down"),
        Header("A8 A9 A10 A11 A12 A13 A14 A15", 2900, 2000, "down"),
        Header(
            # A GND follows, whose name A15 leaves no room for.
            "5V D22 D24 D26 D28 D30 D32 D34 D36 D38 D40 D42 D44 D46 D48 D50 D52",
            3700,
            100,
            "right",
            downward=True,
            is_inner=True,
        ),
        Header(
            "5V D23 D25 D27 D29 D31 D33 D35 D37 D39 D41 D43 D45 D47 D49 D51 D53 GND",
            3800,
            100,
            "right",
            downward=True,
        ),
    ),
    parts=(_USB_B, _JACK, Part("chip", 1900, 850, 700, 600)),
    title=(1900, 560),
    holes=((600, 100), (550, 2000), (2600, 700), (3800, 2000)),
)

NANO = Outline(
    boards=("nano",),
    width=1700,
    height=700,
    corners=((0, 0), (1700, 0), (1700, 700), (0, 700)),
    headers=(
        Header("D12 D11 D10 D9 D8 D7 D6 D5 D4 D3 D2 GND RST D0 D1", 150, 50, "up"),
        Header("D13 3V3 AREF A0 A1 A2 A3 A4 A5 A6 A7 5V RST GND VIN", 150, 650, "down"),
    ),
    parts=(Part("USB", -100, 200, 400, 300), Part("chip", 700, 220, 380, 150)),
    title=(890, 470),
)

PRO_MINI = Outline(
    boards=("pro-mini", "pro-mini-8mhz"),
    width=1300,
    height=700,
    corners=((0, 0), (1300, 0), (1300, 700), (0, 700)),
    headers=(
        Header("RAW GND RST VCC A3 A2 A1 A0 D13 D12 D11 D10", 150, 50, "up"),
        Header("A5 A4", 495, 165, "up", is_inner=True),
        Header("D1 D0 RST GND D2 D3 D4 D5 D6 D7 D8 D9", 150, 650, "down"),
    ),
    parts=(Part("serial", -40, 190, 180, 320), Part("chip", 480, 300, 380, 110)),
    title=(670, 490),
)

MICRO = Outline(
    boards=("micro",),
    width=1909,
    height=710,
    corners=((0, 0), (1909, 0), (1909, 710), (0, 710)),
    headers=(
        Header("D12 D11 D10 D9 D8 D7 D6 D5 D4 D3 D2 GND RST D0 D1 D17 D16", 154, 56, "up"),
        Header("D13 3V3 AREF A0 A1 A2 A3 A4 A5 - - 5V RST GND VIN D14 D15", 154, 656, "down"),
    ),
    parts=(Part("USB", -33, 216, 273, 280), Part("chip", 640, 220, 400, 280)),
    title=(1420, 370),
)

OUTLINES = (UNO, UNO_MINI, ETHERNET, LEONARDO, LEONARDO_ETH, MEGA, NANO, MICRO, PRO_MINI)


def outline_of(board: Board) -> Outline:
    """
    Return what *board* looks like.

    Raises:
        KeyError: No outline names it.
    """
    found = [outline for outline in OUTLINES if board.name in outline.boards]
    if not found:
        raise KeyError(f"nobody has said what the {board.title} looks like")
    return found[0]

"""
Speed against time: as an SVG picture, and as text for the terminal.
"""

from bisect import bisect_right
from fractions import Fraction
from xml.etree.ElementTree import Element

from stepgen.commands import svg
from stepgen.datasheet.chart import ticks
from stepgen.plan.speed_changes import SpeedChange
from stepgen.units import MILLISECONDS_PER_SECOND

_WIDTH, _HEIGHT = 800, 450
_LEFT, _RIGHT, _TOP, _BOTTOM = 80, 80, 50, 60
_PLOT_WIDTH, _PLOT_HEIGHT = _WIDTH - _LEFT - _RIGHT, _HEIGHT - _TOP - _BOTTOM
_MOST_DOTS = 60
_TAIL = 0.05  # how much longer than the change the picture shows the end speed
_STYLE = ".speed{fill:none;stroke:#0b63b0;stroke-width:2}.update{fill:#0b63b0}"
_BRAILLE_DOTS = ((0x01, 0x08), (0x02, 0x10), (0x04, 0x20), (0x40, 0x80))  # [row][column]
_DOT_ROWS, _DOT_COLUMNS = 4, 2


def svg_plot(change: SpeedChange) -> str:
    """
    Return *change* as a self-contained SVG: steps/s on the left, RPM on the right, seconds below.
    """
    span_s = change.end.due_ms / MILLISECONDS_PER_SECOND * (1 + _TAIL)
    top_sps = float(max(update.rate_sps for update in change.updates)) * (1 + _TAIL)
    root = svg.drawing(_WIDTH, _HEIGHT, describe(change), _STYLE)
    svg.write(root, describe(change), _WIDTH / 2, _TOP - 24, "middle title")
    _draw_axes(root, span_s, top_sps, float(change.clock.rpm(Fraction(1))))
    _draw_speed(root, change, span_s, top_sps)
    return svg.text_of(root)


def describe(change: SpeedChange) -> str:
    """
    Return *change* in a line: from where to where, in how many updates.
    """
    start, end = (float(update.rate_sps) for update in (change.updates[0], change.end))
    updates = "1 update" if change.count == 1 else f"{change.count} updates"
    return f"{start:.6g} to {end:.6g} steps/s in {updates} of {change.interval_ms} ms"


def _draw_axes(root: Element, span_s: float, top_sps: float, rpm_per_sps: float) -> None:
    right, bottom = _LEFT + _PLOT_WIDTH, _TOP + _PLOT_HEIGHT
    for at_s in ticks(span_s):
        x = _LEFT + at_s / span_s * _PLOT_WIDTH
        svg.line(root, "grid", (x, _TOP), (x, bottom))
        svg.write(root, f"{at_s:.6g}", x, bottom + 20, "middle")
    for rate_sps in ticks(top_sps):
        y = bottom - rate_sps / top_sps * _PLOT_HEIGHT
        svg.line(root, "grid", (_LEFT, y), (right, y))
        svg.write(root, f"{rate_sps:.6g}", _LEFT - 8, y + 4, "end")
    top_rpm = top_sps * rpm_per_sps
    for rpm in ticks(top_rpm):
        y = bottom - rpm / top_rpm * _PLOT_HEIGHT
        svg.line(root, "axis", (right, y), (right + 5, y))
        svg.write(root, f"{rpm:.6g}", right + 8, y + 4)
    for start, end in (
        ((_LEFT, _TOP), (_LEFT, bottom)),
        ((_LEFT, bottom), (right, bottom)),
        ((right, _TOP), (right, bottom)),
    ):
        svg.line(root, "axis", start, end)
    svg.write(root, "time since the call, s", _LEFT + _PLOT_WIDTH / 2, _HEIGHT - 16, "middle")
    svg.write(root, "steps/s", _LEFT - 8, _TOP - 10, "end")
    svg.write(root, "RPM", right + 8, _TOP - 10)


def _draw_speed(root: Element, change: SpeedChange, span_s: float, top_sps: float) -> None:
    """
    Draw the speed as a staircase, and the updates as dots where there are few.
    """
    bottom = _TOP + _PLOT_HEIGHT
    corners: list[tuple[float, float]] = []
    for update in change.updates:
        x = _LEFT + update.due_ms / MILLISECONDS_PER_SECOND / span_s * _PLOT_WIDTH
        y = bottom - float(update.rate_sps) / top_sps * _PLOT_HEIGHT
        if corners:
            corners.append((x, corners[-1][1]))
        corners.append((x, y))
        if update.number and change.count <= _MOST_DOTS:
            svg.dot(root, "update", (x, y))
    corners.append((_LEFT + _PLOT_WIDTH, corners[-1][1]))
    svg.curve(root, "speed", corners)


def text_plot(change: SpeedChange, columns: int = 60, rows: int = 12, *, ascii_only: bool) -> str:
    """
    Return *change* as lines of text: dots of braille, or stars where the output is ASCII.
    """
    across, down = (1, 1) if ascii_only else (_DOT_COLUMNS, _DOT_ROWS)
    dots = _dots(change, columns * across, rows * down)
    lines = []
    for row in range(rows):
        shown = "".join(
            _cell(dots, column, row, ascii_only=ascii_only) for column in range(columns)
        )
        lines.append(shown.rstrip("\u2800 "))
    top_sps = float(max(update.rate_sps for update in change.updates))
    labels = [f"{top_sps:.5g}", *[""] * (rows - 2), "0"]
    bar, corner, dash = "|+-" if ascii_only else "│└─"
    drawn = [f"{label:>8} {bar}{line}" for label, line in zip(labels, lines, strict=True)]
    end_s = f"{change.end.due_ms / MILLISECONDS_PER_SECOND:.6g} s"
    return "\n".join(
        [" steps/s", *drawn, " " * 9 + corner + dash * columns, f"{'0':>10}{end_s:>{columns}}"]
    )


def _dots(change: SpeedChange, width: int, height: int) -> set[tuple[int, int]]:
    """
    Return the dots of the speed as (column, row from the top), without gaps between them.
    """
    times_ms = [update.due_ms for update in change.updates]
    top_sps = max(update.rate_sps for update in change.updates)
    found: set[tuple[int, int]] = set()
    above = None
    for column in range(width):
        at_ms = column * change.end.due_ms / (width - 1)
        rate_sps = change.updates[bisect_right(times_ms, at_ms) - 1].rate_sps
        row = height - 1 - round(rate_sps / top_sps * (height - 1))
        above = row if above is None else above
        found.update((column, between) for between in range(min(above, row), max(above, row) + 1))
        above = row
    return found


def _cell(dots: set[tuple[int, int]], column: int, row: int, *, ascii_only: bool) -> str:
    if ascii_only:
        return "*" if (column, row) in dots else " "
    pattern = sum(
        bit
        for down, bits in enumerate(_BRAILLE_DOTS)
        for across, bit in enumerate(bits)
        if (column * _DOT_COLUMNS + across, row * _DOT_ROWS + down) in dots
    )
    return chr(0x2800 + pattern)

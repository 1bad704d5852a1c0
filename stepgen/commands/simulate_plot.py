"""
A simulated run as a picture: each wire over time, and the calls of the sketch.
"""

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING
from xml.etree.ElementTree import Element

from stepgen.commands import svg
from stepgen.datasheet.chart import ticks
from stepgen.devices import PortBit
from stepgen.plan.model import Plan
from stepgen.units import MILLISECONDS_PER_SECOND

if TYPE_CHECKING:
    from stepgen.verify.runner import Outcome

_WIDTH = 900
_LEFT, _RIGHT, _TOP, _BOTTOM = 140, 30, 44, 50
_CALL, _LANE, _SWING = 18, 36, 22  # heights of a call's line, of a wire's lane, and of its levels
_TAIL = 0.02  # how much longer than the run the picture is
_STYLE = (
    ".wire{fill:none;stroke:#0b63b0;stroke-width:1.5}.call{stroke:#b04a0b;stroke-dasharray:4 3}"
)

Levels = list[tuple[int, bool]]
"""Cycle and level: first what a wire shows at the start, then each change."""


def svg_waves(plan: Plan, outcome: "Outcome") -> str:
    """
    Return the run as a self-contained SVG: wires one below the other, HIGH above LOW.

    Milliseconds count from the begin of the first call. Wires that never change are left out.
    """
    from stepgen.verify.simulation import call_rows  # noqa: PLC0415 - needs numpy

    calls = [(int(row[0]), f"{row[1]}: {row[2]} {row[3]}") for row in call_rows(plan, outcome)]
    first = calls[0][0] if calls else 0
    lanes = [(name, _levels(outcome, bit, first)) for name, bit in _wires(plan)]
    lanes = [(name, levels) for name, levels in lanes if len(levels) > 1]
    last = max([first + 1, *(at for at, _ in calls), *(levels[-1][0] for _, levels in lanes)])
    span_cycles = (last - first) * (1 + _TAIL)
    cycles_per_ms = plan.board.f_cpu_hz / MILLISECONDS_PER_SECOND
    top = _TOP + _CALL * (len(calls) + 1)
    bottom = top + _LANE * len(lanes)

    def x_of(cycle: float) -> float:
        return _LEFT + (cycle - first) / span_cycles * (_WIDTH - _LEFT - _RIGHT)

    title = f"{plan.library.name} on a simulated {plan.board.title}: {outcome.scenario.name}"
    root = svg.drawing(_WIDTH, bottom + _BOTTOM, title, _STYLE)
    svg.write(root, title, _WIDTH / 2, _TOP - 20, "middle title")
    for at_ms in ticks(span_cycles / cycles_per_ms):
        x = x_of(first + at_ms * cycles_per_ms)
        svg.line(root, "grid", (x, top), (x, bottom))
        svg.write(root, f"{at_ms:.6g}", x, bottom + 18, "middle")
    for row, (cycle, text) in enumerate(calls, start=1):
        _draw_call(root, text, x_of(cycle), _TOP + _CALL * row, bottom)
    for row, (name, levels) in enumerate(lanes, start=1):
        svg.write(root, name, _LEFT - 8, top + _LANE * row - 6, "end")
        corners = [(x_of(cycle), high) for cycle, high in levels]
        _draw_wire(root, corners, top + _LANE * row, _WIDTH - _RIGHT)
    svg.write(root, "time since the first call, ms", _WIDTH / 2, bottom + 38, "middle")
    return svg.text_of(root)


def _wires(plan: Plan) -> Iterator[tuple[str, PortBit]]:
    for motor in plan.motors:
        for wire in motor.drive.every_wire:
            yield f"{motor.name} {wire.signal} {wire.pin.label}", wire.pin.bit


def _levels(outcome: "Outcome", bit: PortBit, first: int) -> Levels:
    """
    Return the levels of *bit* from the cycle *first* on.
    """
    level = False
    found: Levels = []
    for state in outcome.trace.ports:
        high = bool(state.value >> bit.bit & 1)
        if state.port != bit.port or high == level:
            continue
        level = high
        if state.cycle >= first:
            found.append((state.cycle, high))
    start = not found[0][1] if found else level
    return [(first, start), *found]


def _draw_call(root: Element, text: str, x: float, y: float, bottom: float) -> None:
    """
    Mark a call with a line through all wires; its text stays inside of the picture.
    """
    svg.line(root, "call", (x, y - 10), (x, bottom))
    on_the_left = x < _WIDTH / 2
    svg.write(root, text, x + (5 if on_the_left else -5), y, "start" if on_the_left else "end")


def _draw_wire(
    root: Element, corners: Sequence[tuple[float, bool]], floor: float, right: float
) -> None:
    heights = [(x, floor - 4 - (_SWING if high else 0)) for x, high in corners]
    points = [heights[0]]
    for x, y in heights[1:]:
        points += [(x, points[-1][1]), (x, y)]
    svg.curve(root, "wire", [*points, (right, points[-1][1])])

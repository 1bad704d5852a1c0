"""
The rotor of a two-phase motor with four coils, such as a 28BYJ-48: it follows the coils' pull.

In a circle of 360 electrical degrees, which is four full steps, the coils pull to 0, 90, 180 and
270 degrees. The torque of a coil is a sine: none where it pulls to, and none right opposite.
"""

from collections.abc import Iterable, Iterator

_CIRCLE = 360
_QUARTER = 90


def turned(phases: Iterable[frozenset[int]]) -> Iterator[int]:
    """
    Yield by how many degrees the rotor turns in each phase, from 0 degrees on.

    It goes to where the coils of the phase pull together, on the shorter way; opposite to that it
    stays, as it does without current or where two opposite coils cancel each other.

    Args:
        phases: The coils that are on, 0 to 3 in the order in which they pull.
    """
    angle = 0
    for coils in phases:
        x = sum((1, 0, -1, 0)[coil] for coil in coils)
        y = sum((0, 1, 0, -1)[coil] for coil in coils)
        pull = _PULLS.get((x, y))
        way = 0 if pull is None else (pull - angle + _CIRCLE // 2) % _CIRCLE - _CIRCLE // 2
        way = 0 if abs(way) == _CIRCLE // 2 else way
        angle += way
        yield way


_PULLS = {
    (1, 0): 0,
    (1, 1): 45,
    (0, 1): _QUARTER,
    (-1, 1): 135,
    (-1, 0): 180,
    (-1, -1): 225,
    (0, -1): 270,
    (1, -1): 315,
}

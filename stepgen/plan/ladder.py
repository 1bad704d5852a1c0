"""
Ramps: the levels of speed that a motor climbs and descends, as a short table.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Row:
    """
    Levels of equal length, whose intervals differ by the same amount, in 1/256 clock.
    """

    levels: int
    steps: int
    slope_256: int


@dataclass(frozen=True)
class Ladder:
    """
    A ramp from its lowest level up.
    """

    first_interval_256: int
    rows: tuple[Row, ...]

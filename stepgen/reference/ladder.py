"""
The ladder: the intervals that an axis climbs through from rest, and back down.

Which ladder it is the planner chooses. Here it is taken as it is, level by level; how near it comes
to the physics is judged in `stepgen.reference.ramp`.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property


@dataclass(frozen=True)
class Rung:
    """
    Some levels of a ladder that are alike.

    Args:
        levels: How many there are.
        steps: Steps on each of them.
        slope_256: By how much the interval becomes shorter from each level to the next, in 1/256
            clock.
    """

    levels: int
    steps: int
    slope_256: int


@dataclass(frozen=True)
class Level:
    """
    A level of a ladder.

    Args:
        height: Steps made since rest by who has climbed up to it.
        steps: Steps on it by who climbs on; 0 at the top.
        interval_256: The interval between them, in 1/256 clock.
    """

    height: int
    steps: int
    interval_256: int


@dataclass(frozen=True)
class Ladder:
    """
    The first interval, in 1/256 clock, and how it becomes shorter from level to level.
    """

    first_interval_256: int
    rungs: tuple[Rung, ...]

    @cached_property
    def levels(self) -> tuple[Level, ...]:
        """
        Return every level, from rest to the top.
        """
        return tuple(self._levels())

    def goal(self, cruise_256: int) -> int:
        """
        Return the number of the highest level of a motion whose shortest interval is *cruise_256*.

        All levels up to it have that interval or longer ones; from rest on it is level 0 anyhow.
        """
        goal = 0
        for number, level in enumerate(self.levels[1:], 1):
            if level.interval_256 < cruise_256:
                break
            goal = number
        return goal

    def _levels(self) -> Iterator[Level]:
        height, interval_256 = 0, self.first_interval_256
        for rung in self.rungs:
            for _ in range(rung.levels):
                yield Level(height, rung.steps, interval_256)
                height += rung.steps
                interval_256 -= rung.slope_256
        yield Level(height, 0, interval_256)

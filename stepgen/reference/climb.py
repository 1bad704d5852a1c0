"""
Up and down the ladder: which interval follows a step of an axis.
"""

from stepgen.reference.ladder import Ladder, Level


class Climb:
    """
    One leg of an axis: where on the ladder it is, and how many steps it has left.

    It goes up while it is below its goal and there is room to come down again, down from where it
    has to, and else it stays. What comes next is decided anew after each visit of a level, up or
    down, and after each step on the flat.

    Args:
        ladder: What it climbs on.
        cruise_256: Its shortest interval, in 1/256 clock.

    Attributes:
        left: Steps still to be made, None without an end.
        interval_256: The interval after the last step, or the first one.
        cruise_256: Its shortest interval.
    """

    def __init__(self, ladder: Ladder, cruise_256: int) -> None:
        self._ladder = ladder
        self.set_cruise(cruise_256)
        self.begin(0)

    def set_cruise(self, cruise_256: int) -> None:
        """
        Let *cruise_256* be the shortest interval from the next decision on.
        """
        self.cruise_256 = cruise_256
        self._goal = self._ladder.goal(cruise_256)

    @property
    def rest(self) -> int:
        """
        Return how many steps it takes to come to rest once this visit is over, it included.
        """
        return self._visit_left + self._level.height

    def begin(self, left: int | None) -> None:
        """
        Begin a leg of *left* steps, from rest.
        """
        self.left = left
        self._number = 0
        self._is_climbing = False
        self._visit_left = 0
        self.interval_256 = self._ladder.first_interval_256
        if left != 0:
            self._decide()

    def wait_first(self, interval_256: int) -> None:
        """
        Let the first step of a leg that has just begun come after *interval_256*, by itself.

        What comes next is decided after it.
        """
        self._number = 0
        self._visit(1, interval_256)

    def redirect(self, ahead: int | None) -> None:
        """
        Lead to *ahead* steps from here, None without an end; if that is too near, only to rest.

        A level that is walked down is walked to its end. One that is climbed from is left only if
        it can be come down to again; else the next step is the last of it.
        """
        if self._is_climbing:
            steps = self._visit_left + self._level.height + self._level.steps
            if ahead is None or ahead >= steps:
                self.left = ahead
                return
            self._stay()
        self.left = ahead if ahead is None or ahead >= self.rest else self.rest

    def change_cruise(self, cruise_256: int) -> None:
        """
        Do as `set_cruise`, perhaps in flight: a level beyond the new goal is not climbed to.
        """
        self.set_cruise(cruise_256)
        if self._is_climbing and self._number >= self._goal:
            self._stay()

    def step(self) -> bool:
        """
        Count a step that was made, and tell whether it was the last.
        """
        if self.left is not None:
            self.left -= 1
        self._visit_left -= 1
        if self._visit_left == 0 and self.left != 0:
            self._number += self._is_climbing
            self._decide()
        return self.left == 0

    @property
    def _level(self) -> Level:
        return self._ladder.levels[self._number]

    def _stay(self) -> None:
        """
        Let the next step be the last on this level, which is not left.
        """
        self._is_climbing = False
        self._visit_left = 1

    def _decide(self) -> None:
        level = self._level
        if self._number > self._goal or self.left == level.height:
            self._number -= 1
            self._visit(self._level.steps, self._level.interval_256)
        elif self._number < self._goal and self._has_room(level):
            self._visit(level.steps, level.interval_256)
            self._is_climbing = True
        else:
            at_goal = self._number == self._goal
            self._visit(1, self.cruise_256 if at_goal else level.interval_256)

    def _has_room(self, level: Level) -> bool:
        """
        Tell whether *level* can be climbed from, and come down to again, before the end.
        """
        return self.left is None or self.left - level.height >= 2 * level.steps

    def _visit(self, steps: int, interval_256: int) -> None:
        self._is_climbing = False
        self._visit_left = steps
        self.interval_256 = interval_256

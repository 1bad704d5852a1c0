"""
Speed changes by update events: what each update of ``motorSetSpeed`` does to the speed.

Each event changes the virtual value by the modification: faster subtracts it, slower adds it. With
VARIABLE_PWR the modification is halved after each update when faster, doubled when slower.
Source: system 1, chapters 7 and 8.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

from stepgen.errors import StepgenError
from stepgen.plan.rates import Clock, check_period
from stepgen.plan.timings.fast_pwm import choose_setting
from stepgen.units import MILLISECONDS_PER_SECOND

LARGEST_UINT16 = 65_535


@dataclass(frozen=True)
class Update:
    """
    The state right after an update event; number 0 is the call itself.

    Args:
        number: Which update, 0 for the call.
        due_ms: Milliseconds since the call.
        virtual_clocks: The virtual value from here on.
        modification_clocks: What this update changed it by, 0 for the call.
        prescaler: The timer's prescaler from here on.
        timer_value: Timer ticks in one period, TOP + 1.
        rate_sps: The rate on the wire from here on.
        steps_made: Steps since the call, at constant rates between updates.
    """

    number: int
    due_ms: int
    virtual_clocks: int
    modification_clocks: int
    prescaler: int
    timer_value: int
    rate_sps: Fraction
    steps_made: float


@dataclass(frozen=True)
class SpeedChange:
    """
    A planned speed change: the arguments of ``motorSetSpeed`` and what comes of them.

    Args:
        clock: The I/O clock, and the steps in a turn.
        faster: Whether the modification is subtracted.
        halving: Whether VARIABLE_PWR halves (faster) or doubles (slower) it.
        start_clocks: The virtual value of the call.
        modification_clocks: The first modification.
        interval_ms: Milliseconds between two updates.
        updates: The call and then each update.
    """

    clock: Clock
    faster: bool
    halving: bool
    start_clocks: int
    modification_clocks: int
    interval_ms: int
    updates: tuple[Update, ...]

    @property
    def count(self) -> int:
        """
        Return the number of updates.
        """
        return len(self.updates) - 1

    @property
    def end(self) -> Update:
        """
        Return the last update, at which the end speed begins.
        """
        return self.updates[-1]

    @property
    def call(self) -> str:
        """
        Return the call of ``motorSetSpeed`` as C++ text to paste.
        """
        bits = (
            "SPEED_VARIABLE",
            "IRQ_TIMING",
            *(["VARIABLE_PWR"] if self.halving else []),
            "FASTER" if self.faster else "SLOWER",
            "DRV_EN",
        )
        control = " | ".join(f"MOTOR_CTRL_{bit}" for bit in bits)
        return (
            f"motorSetSpeed({control}, {self.start_clocks}UL, 0UL, "
            f"{self.modification_clocks}UL, {self.interval_ms}, {self.count});"
        )


@dataclass(frozen=True)
class Course:
    """
    How the virtual value goes, whatever the time between updates.

    Args:
        start_clocks: The virtual value of the call.
        modification_clocks: The first modification, 1 or more.
        faster: Whether it is subtracted.
        halving: Whether it is halved (faster) or doubled (slower) after each update.
        count: Number of updates.
    """

    start_clocks: int
    modification_clocks: int
    faster: bool
    halving: bool
    count: int

    def modifications(self) -> Iterator[int]:
        """
        Yield the modification of each update.
        """
        clocks = self.modification_clocks
        for _ in range(self.count):
            yield clocks
            if self.halving:
                clocks = clocks >> 1 if self.faster else clocks << 1

    def virtuals(self) -> Iterator[int]:
        """
        Yield the virtual value of the call and then after each update.
        """
        clocks = self.start_clocks
        yield clocks
        for change in self.modifications():
            clocks += -change if self.faster else change
            yield clocks


def plan_change(course: Course, interval_ms: int, clock: Clock) -> SpeedChange:
    """
    Return each update of *course*, one in *interval_ms* milliseconds.

    Raises:
        StepgenError: A number that its argument cannot hold, a modification that is or becomes
            0, or a speed out of the timer's range.
    """
    check_uint16(course.count, "updates")
    check_uint16(interval_ms, "milliseconds between updates")
    _check_modification(course)
    return SpeedChange(
        clock=clock,
        faster=course.faster,
        halving=course.halving,
        start_clocks=course.start_clocks,
        modification_clocks=course.modification_clocks,
        interval_ms=interval_ms,
        updates=tuple(_updates(course, interval_ms, clock)),
    )


def _updates(course: Course, interval_ms: int, clock: Clock) -> Iterator[Update]:
    interval_s = interval_ms / MILLISECONDS_PER_SECOND
    steps_made = 0.0
    changes = (0, *course.modifications())
    for number, virtual_clocks in enumerate(course.virtuals()):
        _check_speed(number, virtual_clocks, clock)
        setting = choose_setting(virtual_clocks)
        rate_sps = clock.rate_sps(setting.period_cycles)
        yield Update(
            number=number,
            due_ms=number * interval_ms,
            virtual_clocks=virtual_clocks,
            modification_clocks=changes[number],
            prescaler=setting.prescaler,
            timer_value=setting.top + 1,
            rate_sps=rate_sps,
            steps_made=steps_made,
        )
        steps_made += float(rate_sps) * interval_s


def _check_speed(number: int, virtual_clocks: int, clock: Clock) -> None:
    try:
        check_period(virtual_clocks, clock)
    except StepgenError as error:
        where = f"after update {number}: " if number else "at the start: "
        raise StepgenError.of(where + error.faults[0].reason) from None


def check_uint16(value: int, what: str) -> None:
    """
    Refuse a number of *what* that ``motorSetSpeed`` cannot take.

    Raises:
        StepgenError: Not within 1 to 65535.
    """
    if value > LARGEST_UINT16:
        raise StepgenError.of(
            f"{value} {what} are too many: motorSetSpeed takes at most {LARGEST_UINT16}; "
            "choose a shorter change or another number of updates"
        )
    if value < 1:
        raise StepgenError.of(
            f"{value} {what} make no change: motorSetSpeed takes at least 1; choose a longer "
            "change or another number of updates"
        )


def _check_modification(course: Course) -> None:
    clocks = course.modification_clocks
    if clocks < 1:
        raise StepgenError.of(
            "the modification would be 0 clocks, and nothing would change; choose fewer updates "
            "or speeds further apart"
        )
    if course.halving and course.faster and not clocks >> (course.count - 1):
        raise StepgenError.of(
            f"a modification of {clocks} clocks is halved to 0 after {clocks.bit_length()} "
            f"updates; choose at most {clocks.bit_length()} updates"
        )

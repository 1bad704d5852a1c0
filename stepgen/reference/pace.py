"""
When the step interrupt comes: the deadlines of the timer, and when each is served.
"""

from dataclasses import dataclass, field

from stepgen.reference.facts import ServiceCycle, SetCycle, served_at_once
from stepgen.reference.stimuli import ChannelSet, ClockOn
from stepgen.reference.timer import (
    FRACTIONS,
    HALF_ROUND_CYCLES,
    TimerSetting,
    first_match_cycles,
    first_overflow_cycle,
)


@dataclass
class Pace:
    """
    The interval in progress and the deadline that ends it.

    Args:
        service_cycle: A pure function from a deadline to the cycle of its service.
        set_cycle: The same to the cycle at which its interrupt has set the channel for the next,
            None where it sets none.
        interval: Prescaler and period of the interval in progress, None at rest.
        deadline_cycle: When the timer sets the flag of a step next, None until its clock is on.
        begun: Each interval so far that began with a step, by the deadline of that step.
    """

    service_cycle: ServiceCycle
    set_cycle: SetCycle
    interval: TimerSetting | None = None
    deadline_cycle: int | None = None
    begun: dict[int, TimerSetting] = field(default_factory=dict)

    def begin(self, interval: TimerSetting) -> None:
        """
        Begin with *interval*; its deadline comes from the clock.
        """
        self.interval, self.deadline_cycle = interval, None

    def stop(self) -> None:
        """
        Let no deadline come any more.
        """
        self.interval = self.deadline_cycle = None

    def go_on(self, deadline: int, interval: TimerSetting) -> None:
        """
        Go on from *deadline* with *interval*.
        """
        self.interval, self.deadline_cycle = interval, deadline + interval.period_cycles
        self.begun[deadline] = interval

    def clock_on(self, clock: ClockOn) -> None:
        """
        Take the deadline from *clock*, if it has the prescaler of the interval in progress.
        """
        if self.interval is not None and clock.prescaler == self.interval.prescaler:
            self.deadline_cycle = first_overflow_cycle(clock.cycle, clock.tcnt, self.interval)

    def channel_set(self, setting: ChannelSet) -> None:
        """
        Take the deadline of the interval in progress from the first match of its channel.
        """
        if self.interval is not None:
            period = self.interval.period_cycles
            first = setting.cycle + setting.ahead_cycles
            self.deadline_cycle = first + period - first_match_cycles(period)

    def is_passed(self, deadline: int) -> bool:
        """
        Tell whether the step after that of *deadline* was due before its channel was set to it.

        A channel matches at the clocks after the one that sets it. With laps it is not set to the
        next step by then.
        """
        set_cycle = self.set_cycle(deadline)
        following = self.deadline_cycle
        if set_cycle is None or following is None or self.has_laps:
            return False
        return following <= set_cycle

    @property
    def has_laps(self) -> bool:
        """
        Tell whether the interval in progress is so long that the channel matches before its end.
        """
        return self.interval is not None and self.interval.period_cycles >= HALF_ROUND_CYCLES

    def serviced(self, deadline: int) -> int:
        """
        Return when *deadline* is served.
        """
        return self.service_cycle(deadline)

    def lateness_cycles(self, deadline: int) -> int:
        """
        Return how much later than *deadline* its service comes.
        """
        return self.service_cycle(deadline) - deadline

    def served_by(self, cycle: int) -> int | None:
        """
        Return the deadline if its service comes at or before *cycle*, else None.

        Raises:
            ValueError: The service lies before the deadline.
        """
        deadline = self.deadline_cycle
        if deadline is None or deadline > cycle:
            return None
        service = self.serviced(deadline)
        if service < deadline:
            raise ValueError(f"deadline {deadline} served too early, at {service}")
        return deadline if service <= cycle else None


@dataclass
class FinePace(Pace):
    """
    The same with intervals in 1/256 clock, whose fractions add up.

    A channel matches at whole clocks: each 256 parts make a deadline come a clock later.

    Args:
        interval_256: The interval in progress.
        fraction_256: What the deadline that ends it lacks of a whole clock, 0 to 255.
        again_cycle: A pure function from a deadline that was put off to the cycle of its service.
        put_off: The deadlines so far whose own interrupt made no step.
    """

    interval_256: int = 0
    fraction_256: int = 0
    again_cycle: ServiceCycle = served_at_once
    put_off: set[int] = field(default_factory=set)

    def put_off_step(self, deadline: int) -> None:
        """
        Let the step of *deadline* wait for an interrupt of its own, which is asked for at once.
        """
        self.put_off.add(deadline)

    def serviced(self, deadline: int) -> int:
        """
        Return when *deadline* is served, by its interrupt or, if it was put off, by the one after.
        """
        if deadline in self.put_off:
            return self.again_cycle(deadline)
        return self.service_cycle(deadline)

    def begin_256(self, interval_256: int) -> None:
        """
        Begin with *interval_256*; its deadline comes from the channel.
        """
        self.interval_256 = interval_256
        whole, self.fraction_256 = divmod(interval_256, FRACTIONS)
        self.begin(TimerSetting(1, whole))

    def go_on_256(self, deadline: int, interval_256: int) -> None:
        """
        Go on from *deadline* with *interval_256*.
        """
        self.interval_256 = interval_256
        whole, self.fraction_256 = divmod(self.fraction_256 + interval_256, FRACTIONS)
        self.go_on(deadline, TimerSetting(1, whole))

    @property
    def has_laps(self) -> bool:
        """
        Tell whether the interval in progress is so long that the channel matches before its end.
        """
        return self.interval_256 // FRACTIONS >= HALF_ROUND_CYCLES

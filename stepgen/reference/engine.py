"""
The half of the model that runs by itself: intervals, steps, update events and end points.
"""

from dataclasses import dataclass, field

from stepgen.reference.axis import Axis
from stepgen.reference.contract import Status
from stepgen.reference.facts import MotorFacts
from stepgen.reference.motion import Motion
from stepgen.reference.notices import Notices
from stepgen.reference.pace import Pace
from stepgen.reference.stimuli import UINT32_STATES, SetSpeed
from stepgen.reference.timer import TimerSetting


@dataclass
class Engine:
    """
    One motion after the other, each step at its deadline.

    Args:
        facts: What the spec decides.
        axis: What it moves.
        pace: When its interrupt comes.
        notices: What it tells the sketch.
        millis: What ``millis()`` returns.
        motion: The present motion, or the last one until it is forgotten.
        running: Whether a step of it may still come.
        heard_millis: What ``millis()`` returned when the sketch last gave a sign of life.
    """

    facts: MotorFacts
    axis: Axis
    pace: Pace
    notices: Notices = field(default_factory=Notices)
    millis: int = 0
    motion: Motion | None = None
    running: bool = False
    heard_millis: int = 0

    def start(self, call: SetSpeed, call_index: int) -> None:
        """
        Begin the motion of the accepted *call*; one in progress ends its interval first.
        """
        motion = Motion.of(call, call_index, self.millis, self.facts)
        self.axis.face(call.cycle, motion.direction)
        if not self.running:
            self.pace.stop()
            self.axis.switch(call.cycle, on=True, call_index=call_index)
        if self.pace.deadline_cycle is None:
            self.pace.begin(self._first_interval(motion, from_rest=not self.running))
        self.notices.clear()
        self.hear()
        self.motion, self.running = motion, True

    def hear(self) -> None:
        """
        Let the command time-out begin anew.
        """
        self.heard_millis = self.millis

    def _first_interval(self, motion: Motion, *, from_rest: bool) -> TimerSetting:
        """
        Return the interval that begins with a call: from rest the driver may have to wake up.
        """
        if from_rest and motion.virtual_cycles < self.facts.wake_cycles:
            return self.facts.setting(self.facts.wake_cycles)
        return motion.begin_interval()

    def rest(self) -> None:
        """
        Let no step come any more, and no release of the coils.
        """
        self.pace.stop()
        self.running = False

    def forget(self) -> None:
        """
        Rest, with nothing left of the last motion.
        """
        self.rest()
        self.motion = None

    def ended_at(self, millis: int) -> bool:
        """
        Tell whether a millis limit has passed while its last interval is still in progress.
        """
        return self.running and self.motion is not None and self.motion.ended_at(millis)

    def update_check(self) -> None:
        """
        Let one due event happen, unless a millis limit has passed.
        """
        motion = self.motion
        pending = motion and self.running and not self.ended_at(self.millis)
        if motion and pending and not motion.updates_in_interrupt:
            self._update(motion)

    def call_back(self, cycle: int) -> None:
        """
        Notice a millis limit that has passed, and make the callbacks that are due.
        """
        if self.ended_at(self.millis):
            self.notices.end_point()
        self.notices.deliver(cycle)

    def serve_until(self, cycle: int) -> None:
        """
        Serve each deadline whose interrupt comes at or before *cycle*.
        """
        while (deadline := self.pace.served_by(cycle)) is not None:
            self._serve(deadline)

    def _serve(self, deadline: int) -> None:
        overrun_cycles = self.facts.overrun_cycles
        if overrun_cycles is not None and self.pace.lateness_cycles(deadline) >= overrun_cycles:
            self.notices.overrun()
        motion = self.motion
        if motion is None or not self.running:
            self._release(deadline)
        elif self._left_alone():
            self.running = False
            self.notices.left_alone()
            self._release(deadline)
            self.motion = None
        elif motion.ended_at(self.millis):
            self._end()
            self._release(deadline)
        else:
            self._step(motion, deadline)

    def _left_alone(self) -> bool:
        """
        Tell whether the command time-out is over: (millis - heard) mod 2^32 >= time-out.
        """
        timeout = self.facts.command_timeout_millis
        return timeout is not None and (self.millis - self.heard_millis) % UINT32_STATES >= timeout

    def _step(self, motion: Motion, deadline: int) -> None:
        self.axis.step(deadline, motion.direction, motion.call_index)
        self.pace.go_on(deadline, motion.begin_interval())
        if self.facts.sees_passed and self.pace.is_passed(deadline):
            self.notices.overrun()
        if motion.count_step():
            self._end()
        elif motion.updates_in_interrupt:
            self._update(motion)

    def _update(self, motion: Motion) -> None:
        if motion.update(self.millis):
            self.notices.fault(Status.FAULT | Status.TIMER_DIV_ERROR)

    def _end(self) -> None:
        """
        End the motion at its end point; with ``release`` one more deadline comes.
        """
        self.running = False
        self.notices.end_point()
        if self.facts.at_rest == "hold":
            self.pace.stop()

    def _release(self, deadline: int) -> None:
        """
        Switch the coils off at this deadline if the motion that ended releases them.
        """
        self.pace.stop()
        if self.motion is not None and self.facts.at_rest == "release":
            self.axis.switch(
                deadline,
                on=False,
                call_index=self.motion.call_index,
                served_cycle=self.pace.service_cycle(deadline),
            )

"""
The integer model: predicts every edge of one motor exactly, from what happens to it.

Motion ``constant``, timing fast PWM mode 15. The contract is the table of
systems/1-motor-driver.md; the timer is in `stepgen.reference.timer`.
"""

from typing import assert_never

from stepgen.reference.axis import Axis, wrapped_int32
from stepgen.reference.contract import Code, Control, Status, fault_bits, stops, verdict
from stepgen.reference.facts import MotorFacts, ServiceCycle, served_at_once
from stepgen.reference.motion import ConstantMotion
from stepgen.reference.stimuli import (
    Call,
    ClockOn,
    Edge,
    Hold,
    Init,
    MillisTick,
    Release,
    SetSpeed,
    Stimulus,
)
from stepgen.reference.timer import first_overflow_cycle


class MotorModel:
    """
    One motor, fed with stimuli in the order of their cycles; it begins as Init leaves it.

    A deadline is the cycle at which the timer sets TOV. Its interrupt is served at
    ``service_cycle(deadline)``, the deadline or later. What is served up to and including
    the commit of a call belongs to the calls before it; the millis limit is judged with the
    last `MillisTick` at or before the service. Deadlines are absolute: a late service delays
    none of the following.

    MISSED is not predicted: in fast PWM the hardware cannot tell a missed period.

    Args:
        facts: What the spec decides.
        service_cycle: A pure function from a deadline to the cycle of its service.
        position: Where the position begins, for tests of its wrap; Init makes it 0.
    """

    def __init__(
        self,
        facts: MotorFacts,
        service_cycle: ServiceCycle = served_at_once,
        *,
        position: int = 0,
    ) -> None:
        self._releases = facts.at_rest == "release"
        self._minimum_cycles = facts.minimum_cycles
        self._service_cycle = service_cycle
        self._axis = Axis(facts.phases, facts.coils_off, wrapped_int32(position))
        self._now_cycle = 0
        self._millis = 0
        self._codes: list[Code] = []
        self._status = Status(0)
        self._motion: ConstantMotion | None = None
        self._releasing: ConstantMotion | None = None  # done, its coils go off one interval later
        self._deadline_cycle: int | None = None

    @property
    def status(self) -> Status:
        """
        Return the status bits; SPIN_FIXED while running.
        """
        return self._status | Status.SPIN_FIXED if self.running else self._status

    @property
    def position(self) -> int:
        """
        Return the steps made since Init, backwards ones negative, as int32.
        """
        return self._axis.position

    @property
    def running(self) -> bool:
        """
        Tell whether a step may still come; the release after the last step is none.
        """
        return self._motion is not None

    @property
    def steps_left(self) -> int | None:
        """
        Return the steps still to be made: 0 at rest, None without a steps limit.
        """
        return self._motion.steps_left if self._motion else 0

    @property
    def return_codes(self) -> tuple[Code, ...]:
        """
        Return the code of each call so far (SetSpeed, Hold, Release, Init), in order.
        """
        return tuple(self._codes)

    def status_at(self, cycle: int, millis: int) -> Status:
        """
        Return what ``motorReadStatus()`` shows at *cycle*, while ``millis()`` returns *millis*.

        It shows REACHED as soon as a millis limit has passed, before the due moment at
        which the step is not made; until then the motor also counts as running.
        """
        self._serve_until(cycle)
        ended = self._motion is not None and self._motion.ended_at(millis)
        return self.status | Status.REACHED if ended else self.status

    def advance(self, cycle: int) -> list[Edge]:
        """
        Serve what is due up to and including *cycle*; return the edges since the last time.

        Raises:
            ValueError: *cycle* lies before what has already happened.
        """
        self._serve_until(cycle)
        return self._axis.take_edges()

    def apply(self, stimulus: Stimulus) -> int:
        """
        Let *stimulus* happen and return the code of the call, 0 if it is none.

        Raises:
            ValueError: The stimulus lies before what has already happened.
        """
        if isinstance(stimulus, MillisTick):
            self._millis_tick(stimulus)
            return Code.FINE
        self._serve_until(stimulus.cycle)
        if isinstance(stimulus, ClockOn):
            self._clock_on(stimulus)
            return Code.FINE
        code = self._call(stimulus)
        self._codes.append(code)
        return code

    def _call(self, call: Call) -> Code:
        match call:
            case SetSpeed():
                return self._set_speed(call)
            case Hold() | Release():
                return self._set_rest(call)
            case Init():
                return self._init(call)
        assert_never(call)

    def _init(self, call: Init) -> Code:
        self._motion = self._releasing = self._deadline_cycle = None
        self._status = Status(0)
        self._axis.init(call.cycle, len(self._codes))
        return Code.FINE

    def _set_speed(self, call: SetSpeed) -> Code:
        code = verdict(call.control, call.virtual_cycles, self._minimum_cycles)
        if code < 0:
            self._status |= fault_bits(code)
        elif stops(call.control, call.virtual_cycles):
            self._stop(call)
        else:
            self._start(call)
        return code

    def _stop(self, call: SetSpeed) -> None:
        self._motion = self._releasing = self._deadline_cycle = None
        self._status |= Status.REACHED
        if self._releases or not call.control & Control.DRV_EN:
            self._axis.switch(call.cycle, on=False, call_index=len(self._codes))

    def _start(self, call: SetSpeed) -> None:
        index = len(self._codes)
        if not self.running:
            self._releasing = self._deadline_cycle = None  # the ClockOn begins the first interval
            self._axis.switch(call.cycle, on=True, call_index=index)
        self._status = Status(0)
        self._motion = ConstantMotion.of(call, index, self._millis)

    def _set_rest(self, call: Hold | Release) -> Code:
        if self.running:
            self._status |= fault_bits(Code.RUNNING)
            return Code.RUNNING
        self._releasing = self._deadline_cycle = None
        self._axis.switch(call.cycle, on=isinstance(call, Hold), call_index=len(self._codes))
        return Code.FINE

    def _millis_tick(self, tick: MillisTick) -> None:
        self._require_order(tick.cycle)
        if tick.cycle > self._now_cycle:
            self._serve_until(tick.cycle - 1)  # a service in the very cycle sees the new value
            self._now_cycle = tick.cycle
        self._millis = tick.millis

    def _clock_on(self, clock: ClockOn) -> None:
        """
        Take the next deadline from this clock, if it has the prescaler that the call asks for.
        """
        paced = self._motion or self._releasing
        if paced is not None and clock.prescaler == paced.setting.prescaler:
            self._deadline_cycle = first_overflow_cycle(clock.cycle, clock.tcnt, paced.setting)

    def _require_order(self, cycle: int) -> None:
        if cycle < self._now_cycle:
            raise ValueError(f"cycle {cycle} lies before cycle {self._now_cycle}")

    def _serve_until(self, cycle: int) -> None:
        self._require_order(cycle)
        while self._deadline_cycle is not None:
            deadline = self._deadline_cycle
            service = self._service_cycle(deadline)
            if service < deadline:
                raise ValueError(f"deadline {deadline} served too early, at {service}")
            if service > cycle:
                break
            self._serve(deadline)
        self._now_cycle = cycle

    def _serve(self, deadline: int) -> None:
        motion = self._motion
        if motion is None:
            self._release(deadline)
        elif motion.ended_at(self._millis):
            self._end(motion)
            self._release(deadline)
        else:
            self._axis.step(deadline, motion.direction, motion.call_index)
            self._deadline_cycle = deadline + motion.setting.period_cycles
            if motion.count_step():
                self._end(motion)

    def _end(self, motion: ConstantMotion) -> None:
        """
        End *motion* at its end point; with ``release`` its next deadline is one more.
        """
        self._motion = None
        self._status |= Status.REACHED
        if self._releases:
            self._releasing = motion
        else:
            self._deadline_cycle = None

    def _release(self, deadline: int) -> None:
        """
        Switch the coils off at this deadline if the motion that ended releases them.
        """
        if self._releasing is not None:
            self._axis.switch(deadline, on=False, call_index=self._releasing.call_index)
        self._releasing = self._deadline_cycle = None

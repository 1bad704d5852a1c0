"""
The integer model: predicts every edge of one motor exactly, from what happens to it.

Motions ``constant`` and ``update-events``, timings ``fast-pwm``, ``ctc`` and ``compare``. The
contract is the table of systems/1-motor-driver.md; the timer is in `stepgen.reference.timer`.
"""

from collections.abc import Mapping
from typing import assert_never

from stepgen.reference.axis import Axis, DirectedAxis, Turn, wrapped_int32
from stepgen.reference.contract import Code, Control, Status
from stepgen.reference.engine import Engine
from stepgen.reference.facts import (
    MotorFacts,
    ServiceCycle,
    SetCycle,
    never_set,
    served_at_once,
)
from stepgen.reference.notices import CallbackMade
from stepgen.reference.pace import Pace
from stepgen.reference.sharing import Need
from stepgen.reference.stimuli import (
    Call,
    CallBack,
    Callbacks,
    ChannelSet,
    ClockOn,
    Edge,
    Hold,
    Init,
    KeepAlive,
    MillisTick,
    Release,
    SetSpeed,
    Stimulus,
    UpdateCheck,
)
from stepgen.reference.timer import TimerSetting
from stepgen.reference.verdict import fault_bits, stops, verdict


class MotorModel:
    """
    One motor, fed with stimuli in the order of their cycles; it begins as Init leaves it.

    A deadline is the cycle at which the timer sets its flag for a step. Its interrupt is served at
    ``service_cycle(deadline)``, the deadline or later. What is served up to and including
    the commit of a call belongs to the calls before it; a millis limit and the update events of
    the interrupt are judged with the last `MillisTick` at or before the service. Deadlines are
    absolute: a late service delays none of the following.

    An update event acts from the first deadline after it. One that is due at the step that
    ends the motion, or while a passed millis limit lets no step come, does not happen.

    A deadline that is served too late is an overrun: MISSED is set until the next start, and it is
    counted until Init. Only of those that `MotorFacts.overrun_cycles` can tell: in fast PWM
    the hardware does not see a missed period.

    Args:
        facts: What the spec decides.
        service_cycle: A pure function from a deadline to the cycle of its service.
        set_cycle: The same to the cycle at which that has set the channel of a timer that runs
            through for the next; on such a timer a step that was due by then is an overrun.
        position: Where the position begins, for tests of its wrap; Init makes it 0.
    """

    def __init__(
        self,
        facts: MotorFacts,
        service_cycle: ServiceCycle = served_at_once,
        *,
        set_cycle: SetCycle = never_set,
        position: int = 0,
    ) -> None:
        self._facts = facts
        axis = DirectedAxis if facts.has_direction else Axis
        self._axis = axis(facts.phases, facts.released, wrapped_int32(position))
        self._engine = Engine(facts, self._axis, Pace(service_cycle, set_cycle))
        self._notices = self._engine.notices
        self._now_cycle = 0
        self._codes: list[Code] = []

    @property
    def status(self) -> Status:
        """
        Return the status bits; SPIN_FIXED while running with no update event left.
        """
        fixed = self.running and self.updates_left == 0
        return self._notices.status | Status.SPIN_FIXED if fixed else self._notices.status

    @property
    def position(self) -> int:
        """
        Return the steps made since Init, backwards ones negative, as int32.
        """
        return self._axis.position

    @property
    def overruns(self) -> int:
        """
        Return the deadlines since Init that were served too late, as uint16.
        """
        return self._notices.overruns

    @property
    def timed_out(self) -> bool:
        """
        Tell whether the command time-out ended the last motion.
        """
        return self._notices.timed_out

    @property
    def running(self) -> bool:
        """
        Tell whether a step may still come; the release after the last step is none.
        """
        return self._engine.running

    @property
    def steps_left(self) -> int | None:
        """
        Return the steps still to be made: 0 at rest, None without a steps limit.
        """
        motion = self._engine.motion
        return motion.steps_left if motion and self.running else 0

    @property
    def virtual_cycles(self) -> int:
        """
        Return the virtual value: at rest what an end point left of it, 0 after a stop or Init.
        """
        return self._engine.motion.virtual_cycles if self._engine.motion else 0

    @property
    def modification(self) -> int:
        """
        Return what the next update event changes the virtual value by; at rest likewise.
        """
        return self._engine.motion.modification if self._engine.motion else 0

    @property
    def updates_left(self) -> int:
        """
        Return how many update events have not happened; at rest likewise.
        """
        return self._engine.motion.updates_left if self._engine.motion else 0

    @property
    def return_codes(self) -> tuple[Code, ...]:
        """
        Return the code of each call so far (SetSpeed, Hold, Release, Init), in order.
        """
        return tuple(self._codes)

    @property
    def needs(self) -> tuple[Need, ...]:
        """
        Return each change so far of whether the motor needs current; it begins without.
        """
        return tuple(self._axis.needs)

    @property
    def intervals(self) -> Mapping[int, TimerSetting]:
        """
        Return each interval so far that began with a step, by the deadline of that step.
        """
        return self._engine.pace.begun

    @property
    def turns(self) -> tuple[Turn, ...]:
        """
        Return each change of DIR so far; it begins forward, and without DIR there is none.
        """
        return tuple(self._axis.turns)

    @property
    def callbacks(self) -> tuple[CallbackMade, ...]:
        """
        Return each callback so far, with the moment of the `CallBack` that made it.
        """
        return tuple(self._notices.made)

    def status_at(self, cycle: int, millis: int) -> Status:
        """
        Return what ``motorReadStatus()`` shows at *cycle*, while ``millis()`` returns *millis*.

        It shows REACHED as soon as a millis limit has passed, before the due moment at
        which the step is not made; until then the motor also counts as running. An
        `CallBack` in between notices it too, and makes the callback; reading does not.
        """
        self._serve_until(cycle)
        return self.status | Status.REACHED if self._engine.ended_at(millis) else self.status

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
        Let *stimulus* happen and return the code of the call, 0 if it has none.

        Raises:
            ValueError: The stimulus lies before what has already happened.
        """
        if isinstance(stimulus, MillisTick):
            self._millis_tick(stimulus)
            return Code.FINE
        self._serve_until(stimulus.cycle)
        match stimulus:
            case ClockOn():
                self._engine.pace.clock_on(stimulus)
            case ChannelSet():
                self._engine.pace.channel_set(stimulus)
            case Callbacks():
                self._notices.has_reached_callback = stimulus.reached
                self._notices.has_fault_callback = stimulus.fault
            case KeepAlive():
                self._engine.hear()
            case UpdateCheck():
                self._engine.update_check()
            case CallBack():
                self._engine.call_back(stimulus.cycle)
            case _:
                self._codes.append(self._call(stimulus))
                return self._codes[-1]
        return Code.FINE

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
        self._engine.forget()
        self._notices.clear()
        self._notices.overruns = 0
        self._axis.init(call.cycle, len(self._codes))
        return Code.FINE

    def _set_speed(self, call: SetSpeed) -> Code:
        code = verdict(call, self._facts)
        if code < 0:
            self._notices.fault(fault_bits(code))
        elif stops(call):
            self._stop(call)
        else:
            self._engine.start(call, len(self._codes))
        return code

    def _stop(self, call: SetSpeed) -> None:
        self._engine.forget()
        self._notices.stopped()
        if self._facts.at_rest == "release" or not call.control & Control.DRV_EN:
            self._axis.switch(call.cycle, on=False, call_index=len(self._codes))

    def _set_rest(self, call: Hold | Release) -> Code:
        if self.running:
            self._notices.fault(fault_bits(Code.RUNNING))
            return Code.RUNNING
        self._engine.rest()
        self._axis.switch(call.cycle, on=isinstance(call, Hold), call_index=len(self._codes))
        return Code.FINE

    def _millis_tick(self, tick: MillisTick) -> None:
        self._require_order(tick.cycle)
        if tick.cycle > self._now_cycle:
            self._serve_until(tick.cycle - 1)  # a service in the very cycle sees the new value
            self._now_cycle = tick.cycle
        self._engine.millis = tick.millis

    def _require_order(self, cycle: int) -> None:
        if cycle < self._now_cycle:
            raise ValueError(f"cycle {cycle} lies before cycle {self._now_cycle}")

    def _serve_until(self, cycle: int) -> None:
        self._require_order(cycle)
        self._engine.serve_until(cycle)
        self._now_cycle = cycle

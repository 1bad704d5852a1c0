"""
The integer model of an axis: motion ``trapezoid`` on a channel of a 16-bit timer, edge by edge.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import assert_never

from stepgen.reference.axis import Axis, DirectedAxis, Turn, wrapped_int32
from stepgen.reference.climb import Climb
from stepgen.reference.contract import Code
from stepgen.reference.end_stops import EndStopFacts, EndStopState, Fault, Leg
from stepgen.reference.facts import MotorFacts, ServiceCycle, SetCycle, never_set, served_at_once
from stepgen.reference.notices import Notices
from stepgen.reference.pace import FinePace
from stepgen.reference.sharing import Need
from stepgen.reference.stimuli import (
    AxisCall,
    AxisStimulus,
    ChannelSet,
    ClearFault,
    ClockOn,
    Edge,
    EmergencyStop,
    Halt,
    Hold,
    Home,
    Init,
    MillisTick,
    Move,
    MoveTo,
    QueueMoveTo,
    Release,
    RunOn,
    SetPace,
    SetPosition,
    Stop,
    Switches,
)
from stepgen.reference.timer import FRACTIONS, TimerSetting


@dataclass(frozen=True)
class Start:
    """
    A call at *cycle* that began a leg from rest, whose first step is due *interval_cycles* later.
    """

    cycle: int
    interval_cycles: int


class TrapezoidModel:
    """
    One axis, fed with stimuli in the order of their cycles; it begins as Init leaves it.

    Deadlines and services are those of `stepgen.reference.integer.MotorModel`. A leg is a way
    from rest to rest in one direction. While one is under way, a call acts from the next step on.

    Args:
        facts: What the spec decides; they have a ladder.
        service_cycle: A pure function from a deadline to the cycle of its service.
        set_cycle: The same to the cycle at which that has set the channel for the next.
        again_cycle: The same to the cycle of a second service, where the first met a switch.
        position: Where the position begins, for tests of its wrap; Init makes it 0.
    """

    def __init__(
        self,
        facts: MotorFacts,
        service_cycle: ServiceCycle = served_at_once,
        *,
        set_cycle: SetCycle = never_set,
        again_cycle: ServiceCycle = served_at_once,
        position: int = 0,
    ) -> None:
        if facts.ladder is None:
            raise ValueError("these are no facts of an axis: they have no ladder")
        self._facts = facts
        axis = DirectedAxis if facts.has_direction else Axis
        self._axis = axis(facts.phases, facts.released, wrapped_int32(position))
        self._pace = FinePace(service_cycle, set_cycle, again_cycle=again_cycle)
        self._notices = Notices()
        self._climb = Climb(facts.ladder, facts.cruise_256)
        self._slowest_256 = facts.ladder.first_interval_256
        self._limits = facts.end_stops or EndStopFacts(frozenset())
        self._stops = EndStopState()
        self._running = False
        self._direction = 1
        self._destination = self._axis.position
        self._endless: int | None = None
        self._queue: list[int] = []
        self._call_index = 0
        self._now_cycle = 0
        self._codes: list[Code] = []
        self._starts: list[Start] = []

    @property
    def position(self) -> int:
        """
        Return the steps made, backwards ones negative, from where Init or SetPosition began.
        """
        return self._axis.position

    @property
    def target(self) -> int:
        """
        Return where the last move leads that was asked for; the position while there is no end.
        """
        if self._endless is not None:
            return self.position
        return self._queue[-1] if self._queue else self._destination

    @property
    def distance(self) -> int:
        """
        Return the steps from the position to the target, int32.
        """
        return wrapped_int32(self.target - self.position)

    @property
    def running(self) -> bool:
        """
        Tell whether a step may still come; the release after the last step is none.
        """
        return self._running

    @property
    def fault(self) -> Fault:
        """
        Return why it moves no more; NONE if it does.
        """
        return self._stops.fault

    @property
    def homed(self) -> bool:
        """
        Tell whether its positions count from a switch.
        """
        return self._stops.homed

    @property
    def pressed(self) -> frozenset[str]:
        """
        Return the ends whose switches are pressed.
        """
        return self._stops.pressed

    @property
    def overruns(self) -> int:
        """
        Return the steps since Init that were due before their channel was set, as uint16.
        """
        return self._notices.overruns

    @property
    def return_codes(self) -> tuple[Code, ...]:
        """
        Return the code of each call so far, in order.
        """
        return tuple(self._codes)

    @property
    def needs(self) -> tuple[Need, ...]:
        """
        Return each change so far of whether the motor needs current; it begins without.
        """
        return tuple(self._axis.needs)

    @property
    def turns(self) -> tuple[Turn, ...]:
        """
        Return each change of DIR so far; it begins forward, and without DIR there is none.
        """
        return tuple(self._axis.turns)

    @property
    def intervals(self) -> Mapping[int, TimerSetting]:
        """
        Return each interval so far that began with a step, by the deadline of that step.
        """
        return self._pace.begun

    @property
    def starts(self) -> tuple[Start, ...]:
        """
        Return each call so far that began a leg from rest.
        """
        return tuple(self._starts)

    def advance(self, cycle: int) -> list[Edge]:
        """
        Serve what is due up to and including *cycle*; return the edges since the last time.

        Raises:
            ValueError: *cycle* lies before what has already happened.
        """
        self._serve_until(cycle)
        return self._axis.take_edges()

    def apply(self, stimulus: AxisStimulus) -> Code:
        """
        Let *stimulus* happen and return the code of the call, 0 if it has none.

        Raises:
            ValueError: The stimulus lies before what has already happened.
        """
        # What is pressed in a cycle is seen by the interrupt that is entered in it.
        self._serve_until(stimulus.cycle - isinstance(stimulus, Switches))
        match stimulus:
            case Switches():
                self._stops.pressed = stimulus.pressed
                return Code.FINE
            case ChannelSet():
                if self._pace.deadline_cycle is None:
                    self._pace.channel_set(stimulus)
                return Code.FINE
            case ClockOn() | MillisTick():
                return Code.FINE
            case _:
                self._codes.append(self._call(stimulus))
                return self._codes[-1]

    def _call(self, call: AxisCall) -> Code:
        match call:
            case MoveTo() | Move() | QueueMoveTo():
                return self._move(call)
            case RunOn():
                return self._run(call)
            case Home():
                return self._home(call)
            case SetPace():
                return self._set_pace(call)
            case SetPosition() | Hold() | Release():
                return self._set_at_rest(call)
            case _:
                self._do(call)
                return Code.FINE

    def _do(self, call: Stop | Halt | EmergencyStop | ClearFault | Init) -> None:
        """
        Make a call that is never refused.
        """
        match call:
            case Stop():
                self._stop()
            case Halt():
                self._halt(call.cycle)
            case EmergencyStop():
                self._cease(call.cycle, Fault.EMERGENCY)
            case ClearFault():
                self._stops.fault = Fault.NONE
            case Init():
                self._init(call)
            case _:
                assert_never(call)

    def _move(self, call: MoveTo | Move | QueueMoveTo) -> Code:
        steps = call.steps if isinstance(call, Move) else call.position - self.position
        destination = wrapped_int32(self.position + steps)
        if refused := self._refusal(destination):
            return refused
        if isinstance(call, QueueMoveTo) and self._running:
            return self._enqueue(call)
        self._aim(call.cycle, destination)
        return Code.FINE

    def _refusal(self, destination: int) -> Code:
        """
        Return why a move to *destination* is refused, whatever the axis does; FINE if it is not.
        """
        if self._stops.fault:
            return Code.FAULT
        if self._stops.leg:
            return Code.HOMING
        return Code.FINE if self._limits.allows(destination) else Code.RANGE

    def _aim(self, cycle: int, destination: int) -> None:
        self._forget_plans()
        self._destination = destination
        if self._running:
            self._redirect(wrapped_int32(self._way * self._direction))
        elif self._way:
            self._begin(cycle, _sign(self._way))

    def _enqueue(self, call: QueueMoveTo) -> Code:
        if self._endless is not None:
            return Code.RUNNING
        if call.position == self.target:
            return Code.FINE
        if len(self._queue) == self._facts.queue:
            return Code.QUEUE_FULL
        self._queue.append(call.position)
        return Code.FINE

    def _run(self, call: RunOn) -> Code:
        if self._limits.range:
            lowest, highest = self._limits.range
            end = highest if call.direction > 0 else lowest
            return self._move(MoveTo(call.cycle, end))
        if refused := self._refusal(self.position):
            return refused
        self._forget_plans()
        self._endless = call.direction
        if self._running:
            self._redirect(None if call.direction == self._direction else 0)
        else:
            self._begin(call.cycle, call.direction)
        return Code.FINE

    def _home(self, call: Home) -> Code:
        homing = self._limits.homing
        if homing is None:
            raise ValueError("these are no facts of an axis that finds home")
        if self._stops.fault:
            return Code.FAULT
        if self._running:
            return Code.RUNNING
        self._stops.homed = False
        self._stops.leg = Leg.SEEK
        self._stops.sketch_256 = self._climb.cruise_256
        self._climb.set_cruise(homing.fast_256)
        self._aim(call.cycle, wrapped_int32(self.position + homing.there * homing.travel))
        return Code.FINE

    def _stop(self) -> None:
        self._end_homing()
        self._call_index = len(self._codes)
        self._come_to_rest()

    def _come_to_rest(self) -> None:
        self._forget_plans()
        if self._running:
            self._climb.redirect(0)
            self._destination = wrapped_int32(self.position + self._direction * self._climb.rest)

    def _halt(self, cycle: int, served_cycle: int | None = None) -> None:
        """
        Make no step any more: a call at *cycle*, or an interrupt of that deadline, when served.
        """
        self._end_homing()
        self._rest()
        if self._facts.at_rest == "release":
            index = len(self._codes) if served_cycle is None else self._call_index
            self._axis.switch(cycle, on=False, call_index=index, served_cycle=served_cycle)

    def _cease(self, cycle: int, fault: Fault, served_cycle: int | None = None) -> None:
        """
        Do as `_halt`, and move no more for *fault*.
        """
        self._stops.fault = fault
        self._stops.homed = False
        self._halt(cycle, served_cycle)

    def _end_homing(self) -> None:
        if self._stops.leg:
            self._stops.leg = Leg.NONE
            self._climb.set_cruise(self._stops.sketch_256)

    def _set_pace(self, call: SetPace) -> Code:
        if call.interval_256 < self._facts.cruise_256:
            return Code.TOO_FAST
        if self._stops.leg:
            return Code.HOMING
        self._climb.change_cruise(call.interval_256)
        return Code.FINE

    def _set_at_rest(self, call: SetPosition | Hold | Release) -> Code:
        if self._running:
            return Code.RUNNING
        if not isinstance(call, SetPosition):
            self._pace.stop()
            on = isinstance(call, Hold)
            self._axis.switch(call.cycle, on=on, call_index=len(self._codes))
            return Code.FINE
        if not self._limits.allows(call.position):
            return Code.RANGE
        self._axis.position = self._destination = call.position
        return Code.FINE

    def _init(self, call: Init) -> None:
        self._axis.init(call.cycle, len(self._codes))
        self._rest()
        self._direction = 1
        self._notices.overruns = 0
        self._climb.set_cruise(self._facts.cruise_256)
        self._stops = EndStopState(self._stops.pressed)

    @property
    def _way(self) -> int:
        """
        Return the steps from the position to the end of this leg, or that of the leg after a turn.
        """
        return wrapped_int32(self._destination - self.position)

    def _forget_plans(self) -> None:
        self._queue.clear()
        self._endless = None

    def _rest(self) -> None:
        """
        Let nothing come any more.
        """
        self._forget_plans()
        self._pace.stop()
        self._running = False
        self._destination = self.position

    def _begin(self, cycle: int, direction: int) -> None:
        """
        Begin a leg from rest, with the call at *cycle*; the driver may have to wake up.
        """
        self._call_index = len(self._codes)
        self._pace.stop()
        self._begin_leg(cycle, direction)
        self._axis.switch(cycle, on=True, call_index=self._call_index)
        if self._facts.wake_cycles:
            self._climb.wait_first(max(self._slowest_256, self._facts.wake_cycles * FRACTIONS))
        first = self._climb.interval_256
        self._pace.begin_256(first)
        self._starts.append(Start(cycle, first // FRACTIONS))
        self._running = True

    def _begin_leg(self, cycle: int, direction: int) -> None:
        self._stops.seen = False
        self._direction = direction
        self._axis.face(cycle, direction)
        self._climb.begin(None if self._endless else abs(self._way))

    def _redirect(self, ahead: int | None) -> None:
        """
        Lead the leg under way to *ahead* steps from here, None without an end, or only to rest.
        """
        self._call_index = len(self._codes)
        self._climb.redirect(ahead)

    def _serve_until(self, cycle: int) -> None:
        if cycle < self._now_cycle:
            raise ValueError(f"cycle {cycle} lies before cycle {self._now_cycle}")
        while (deadline := self._pace.served_by(cycle)) is not None:
            self._serve(deadline)
        self._now_cycle = cycle

    def _serve(self, deadline: int) -> None:
        if not self._running:
            self._release(deadline)
            return
        if self._stops.leads_into(self._direction):
            self._meet_switch(deadline)
            return
        self._axis.step(deadline, self._direction, self._call_index)
        if self._climb.step():
            self._end_leg(deadline)
        if self._running or self._facts.at_rest == "release":
            self._pace.go_on_256(deadline, self._climb.interval_256)
            if self._pace.is_passed(deadline):
                self._notices.overrun()
        else:
            self._pace.stop()

    def _meet_switch(self, deadline: int) -> None:
        """
        Let the interrupt of *deadline* find that its step leads into a switch: it makes none.

        Homing comes to rest behind the switch that it looks for; the step then comes after all.
        """
        if not self._stops.looks_for_switch:
            self._cease(deadline, Fault.LIMIT, self._pace.serviced(deadline))
            return
        self._stops.contact = self.position
        self._come_to_rest()
        self._stops.seen = True
        self._pace.put_off_step(deadline)

    def _home_on(self) -> None:
        """
        Have the next leg of homing follow the one that has ended, or end it.
        """
        stops, homing = self._stops, self._limits.homing
        if homing is None or not stops.leg:
            return
        failed = not stops.seen if stops.looks_for_switch else homing.towards in stops.pressed
        if stops.leg is Leg.PARK:
            stops.homed = True
            self._end_homing()
            return
        if failed:
            stops.fault = Fault.HOMING
            self._end_homing()
            return
        away = -homing.there * homing.back_off
        stops.leg = Leg(stops.leg + 1)
        self._climb.set_cruise(homing.slow_256 if stops.leg is Leg.APPROACH else homing.fast_256)
        if stops.leg is Leg.BACK_OFF:
            self._destination = wrapped_int32(stops.contact + away)
        elif stops.leg is Leg.APPROACH:
            self._destination = wrapped_int32(self.position - 2 * away)
        else:
            self._axis.position = wrapped_int32(self.position - stops.contact + homing.position)
            self._destination = homing.park

    def _end_leg(self, deadline: int) -> None:
        """
        Begin the next leg with the last step of the one before, or come to rest.
        """
        self._home_on()
        if self._endless:
            self._begin_leg(deadline, self._endless)
            return
        while not self._way and self._queue:
            self._destination = self._queue.pop(0)
        if self._way:
            self._begin_leg(deadline, _sign(self._way))
        else:
            self._running = False

    def _release(self, deadline: int) -> None:
        self._pace.stop()
        self._axis.switch(
            deadline,
            on=False,
            call_index=self._call_index,
            served_cycle=self._pace.service_cycle(deadline),
        )


def _sign(number: int) -> int:
    return 1 if number > 0 else -1

"""
The test bench: a sketch that does what a mailbox in RAM says, on a simulated chip.
"""

from dataclasses import dataclass, field
from enum import IntEnum
from pathlib import Path
from struct import Struct
from typing import Self

from stepgen.devices import Register, Timer16
from stepgen.errors import StepgenError
from stepgen.plan.end_stops import EndStops
from stepgen.plan.model import MotorPlan, Plan, TimerPlan
from stepgen.verify.events import Events, Kind
from stepgen.verify.simulators import SIMAVR, Machine, Simulator

_MAILBOX = Struct("<BBBBIIIHHHbBiHBBBiiiBIBBB")
_DELAY = Struct("<H")
_RESULT, _WITHIN, _STEPS, _TOP_HIGH = 10, 15, 17, 21  # their places in the mailbox
_LIMITS = 3  # bytes at its end that tell of limits
_LOOP_OFFSET = 2
_DELAY_OFFSET = 20
_NO_CALL = 11  # the sketch goes through all of a call, but calls nothing
_MARK_BEGIN, _MARK_END, _MARK_READY, _MARK_MET = 1, 2, 3, 4
_MARK_WITHIN, _MARK_WITHIN_END = 5, 6
_WITHIN_OFFSET = 31
# So long before its moment an exact call is handed over: more than the sketch's loop takes.
APPROACH_CYCLES = 400
_SETUP_CYCLES = 2_000_000
_RECENT_EVENTS = 400
_ANSWER_CYCLES = 1_000_000


class Loop(IntEnum):
    """
    What the sketch does between calls.

    With EXACT it only looks for the next call, and a wait is exact: a call begins to the clock so
    many cycles after the one before has ended, `APPROACH_CYCLES` or more, unless an interrupt
    is running then.
    """

    SLEEP = 0
    BUSY = 1
    HOSTILE = 2
    EXACT = 3


class Context(IntEnum):
    """
    Where the sketch makes a call: in its loop, in a callback of the motor, or in an interrupt.

    For a call in a callback the loop calls the motor's ``...TimerUpdateCheck``; where no callback
    is due, it is not made. The interrupt is compare match A of timer 0, as an example of one that
    a sketch has.
    """

    LOOP = 0
    CALLBACK = 1
    INTERRUPT = 2


class CallKind(IntEnum):
    """
    Which function is called: of a motor or, from 12 to 15, of the library, avr-libc or the sketch.

    From 16 on they are those of an axis, which has READ, INIT, HOLD and RELEASE too, the last two
    as ``EnableOutputs`` and ``DisableOutputs``. SET_PACE is its ``SetSpeed``, in 1/256 clock.

    HOLD_UP keeps interrupts off for four cycles *top* times, 65535 at most, and a few more.
    WATCHDOG is one of the library's functions about it, by *control*: a `Watchdog`.
    DIVIDE_CLOCK sets CLKPR: the clock is divided by 2 to the power of *control*. The last two
    give their result as the position.

    PRESS is no call: from outside, the switches of the axis named in *control* are pressed, 1 the
    low and 2 the high one, and the others let go; never while its step interrupt runs.
    """

    SET_SPEED = 1
    HOLD = 2
    RELEASE = 3
    READ = 4
    INIT = 5
    UPDATE_CHECK = 6
    CALLBACKS = 7
    KEEP_ALIVE = 8
    WATCHDOG = 9
    HOLD_UP = 12
    DIVIDE_CLOCK = 13
    TOP_PER_SECOND = 14
    CLOCKS_PER_SECOND = 15
    MOVE_TO = 16
    MOVE = 17
    RUN_FORWARD = 18
    RUN_BACKWARD = 19
    STOP = 20
    HALT = 21
    SET_PACE = 22
    QUEUE_MOVE_TO = 23
    SET_POSITION = 24
    HOME = 25
    EMERGENCY_STOP = 26
    CLEAR_FAULT = 27
    PRESS = 28


class Watchdog(IntEnum):
    """
    Which function of the watchdog a call is of; FIRED gives its result.
    """

    START = 0
    FEED = 1
    FIRED = 2


SWITCH_BITS = {"low": 1, "high": 2}
"""What the control of PRESS has for the switch of each end, and what is read of them."""

SWITCHING = frozenset({CallKind.HOLD, CallKind.RELEASE})
"""The calls that a motor does not have where nothing can switch its coils."""

OF_NO_MOTOR = frozenset(
    kind
    for kind in CallKind
    if CallKind.HOLD_UP <= kind <= CallKind.CLOCKS_PER_SECOND
    or kind in {CallKind.WATCHDOG, CallKind.PRESS}
)
"""The calls of the library as a whole, of avr-libc or of the sketch, and what is no call."""

OF_LIMITS = frozenset(kind for kind in CallKind if kind >= CallKind.HOME)
"""The calls that only an axis with limits has, and what happens to it."""

OF_AXES = frozenset(kind for kind in CallKind if CallKind.MOVE_TO <= kind < CallKind.HOME)
"""The calls that every axis has, and only an axis."""

OF_EVERY_MOTOR = SWITCHING | {CallKind.READ, CallKind.INIT}
"""The calls that an axis and other motors have."""


def is_axis(motor: MotorPlan) -> bool:
    """
    Tell whether *motor* is moved by the calls of an axis.
    """
    return motor.motion.kind == "trapezoid"


def has_call(motor: MotorPlan, kind: CallKind) -> bool:
    """
    Tell whether the API of *motor* has the call *kind*, if it is one of a motor at all.
    """
    if kind is CallKind.QUEUE_MOVE_TO and is_axis(motor):
        return motor.motion.queue > 0
    if kind in OF_LIMITS:
        return _limits_have(motor.end_stops, kind)
    if kind in OF_EVERY_MOTOR | OF_NO_MOTOR:
        return kind not in SWITCHING or motor.switches_current
    return (kind in OF_AXES) == is_axis(motor)


def _limits_have(stops: EndStops | None, kind: CallKind) -> bool:
    if stops is None:
        return False
    if kind is CallKind.HOME:
        return stops.homing is not None
    return kind is not CallKind.PRESS or bool(stops.switches)


@dataclass(frozen=True)
class Call:
    """
    A call as the scenario asks for it.

    *steps* are those of a call of an axis: a position, or how far it goes.
    """

    kind: CallKind
    motor: int = 0
    control: int = 0
    top: int = 0
    limit: int = 0
    modification: int = 0
    interval: int = 0
    count: int = 0
    steps: int = field(default=0, kw_only=True)
    context: Context = field(default=Context.LOOP, kw_only=True)


@dataclass(frozen=True)
class Answer:
    """
    A call as it happened: when it began and ended, and what it returned.
    """

    call: Call
    begin_cycle: int
    end_cycle: int
    result: int
    status: int
    position: int
    missed: int = 0
    timed_out: int = 0
    target: int = 0
    distance: int = 0
    running: int = 0
    fault: int = 0
    homed: int = 0
    pressed: int = 0


@dataclass
class Bench:
    """
    A simulated chip that runs the bench sketch of a plan.
    """

    plan: Plan
    elf: Path
    simulator: Simulator = SIMAVR
    answers: list[Answer] = field(default_factory=list)

    def __post_init__(self) -> None:
        mcu = self.plan.board.mcu
        self.machine = self.simulator.open(
            self.elf,
            mcu=mcu.name,
            f_cpu_hz=self.plan.board.f_cpu_hz,
            watch=watched_registers(self.plan),
        )
        self._mailbox = self.machine.symbol("mailbox")
        self._loop = Loop.SLEEP
        self._lead_cycles = 0
        self._due_cycle = 0
        # With EXACT nothing depends on when it is noticed that a call is over.
        self._patience_cycles = 1
        if not self.machine.run_until_mark(_MARK_READY, limit_cycles=_SETUP_CYCLES):
            raise StepgenError.of("the sketch never came out of setup()", place=str(self.elf))
        for motor in self.plan.motors:
            drive_switches(self.machine, motor)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.machine.close()

    @property
    def due_cycle(self) -> int:
        """
        Return from when on the next exact wait counts: where the last call or wait ended.
        """
        return self._due_cycle

    def set_loop(self, loop: Loop) -> None:
        """
        Choose what the sketch does between calls.
        """
        self._loop = loop
        self.machine.write_ram(self._mailbox + _LOOP_OFFSET, bytes([loop]))
        if loop is Loop.EXACT:
            self._patience_cycles = 20
            # The shortest of three, since a millisecond interrupt may come in between.
            self._lead_cycles = min(self._measure_lead() for _ in range(3))
            self._due_cycle = self.machine.cycle

    def wait(self, cycles: int) -> None:
        """
        Let the chip run for *cycles* more.
        """
        if self._loop is Loop.EXACT:
            self._due_cycle += cycles
            self.machine.run_until(self._due_cycle - APPROACH_CYCLES)
        else:
            self.machine.run_until(self.machine.cycle + cycles)

    def call(self, call: Call) -> Answer:
        """
        Let the sketch make *call*, and return when it is over.

        Raises:
            StepgenError: The sketch did not get round to it, or did not return.
        """
        if call.kind is CallKind.PRESS:
            return self._press(call)
        self.machine.write_ram(self._mailbox, mail(call, self._loop))
        if self._loop is Loop.EXACT:
            now = self._run_to_mark(_MARK_MET, call)
            self._delay(self._due_cycle - now - self._lead_cycles)
        begin = self._run_to_mark(_MARK_BEGIN, call)
        self.machine.fine = True
        made = call.context is Context.LOOP or self._go_within(call, begin)
        begin = begin if call.context is Context.LOOP else self.machine.cycle
        if made:
            last = _MARK_END if call.context is Context.LOOP else _MARK_WITHIN_END
            end = self._run_to_mark(last, call)
        self.machine.fine = False
        self._run_until_free(call)
        if made:
            self.answers.append(self._answer(call, begin, end))
        self._due_cycle = self.answers[-1].end_cycle
        return self.answers[-1]

    def _press(self, call: Call) -> Answer:
        """
        Press the switches that *call* names, and let go the others, at a moment that is no matter.
        """
        motor = self.plan.motors[call.motor]
        vector = self.plan.board.mcu.vector(motor.timing.vector).number
        while is_running(self.machine.events()[-_RECENT_EVENTS:], vector):
            self.machine.run_until(self.machine.cycle + 1)
        drive_switches(self.machine, motor, call.control)
        now = self.machine.cycle
        # It takes no time, in which an interrupt of the sketch could be masked.
        self.answers.append(Answer(call, now, now - 1, 0, 0, 0))
        return self.answers[-1]

    def _go_within(self, call: Call, begin: int) -> bool:
        """
        Run until a callback or an interrupt makes *call*; return False if no callback was due.
        """
        inside = self._run_to_mark(_MARK_WITHIN, call)
        if call.context is not Context.CALLBACK:
            return True
        self.answers.append(Answer(Call(CallKind.UPDATE_CHECK, call.motor), begin, inside, 0, 0, 0))
        return not self.machine.read_ram(self._mailbox + _WITHIN_OFFSET, 1)[0]

    def _answer(self, call: Call, begin: int, end: int) -> Answer:
        seen = _MAILBOX.unpack(self.machine.read_ram(self._mailbox, _MAILBOX.size))
        state = (*seen[_STEPS + 1 : _TOP_HIGH], *seen[-_LIMITS:])
        return Answer(call, begin, end, *seen[_RESULT:_WITHIN], *state)

    def come_back(self, limit_cycles: int) -> bool:
        """
        Let the chip run until its sketch has come out of setup() again, after a reset.
        """
        self._loop = Loop.SLEEP
        return self.machine.run_until_mark(_MARK_READY, limit_cycles=limit_cycles)

    def events(self) -> Events:
        """
        Return everything that was recorded since reset.
        """
        return self.machine.events()

    def _delay(self, cycles: int) -> None:
        """
        Let the sketch, which has met an exact call, put it off by *cycles*.
        """
        in_range = min(max(cycles, 0), 0xFFFF)
        self.machine.write_ram(self._mailbox + _DELAY_OFFSET, _DELAY.pack(in_range))

    def _measure_lead(self) -> int:
        """
        Return how long an exact call takes at least from when the sketch meets it to its begin.
        """
        call = Call(CallKind.READ)
        self.machine.write_ram(self._mailbox, bytes([_NO_CALL]) + mail(call, self._loop)[1:])
        met = self._run_to_mark(_MARK_MET, call)
        begin = self._run_to_mark(_MARK_BEGIN, call)
        self._run_to_mark(_MARK_END, call)
        self._run_until_free(call)
        return begin - met

    def _run_to_mark(self, mark: int, call: Call) -> int:
        if not self.machine.run_until_mark(mark, limit_cycles=_ANSWER_CYCLES):
            raise StepgenError.of(f"the sketch hangs in {call}", place=str(self.elf))
        return self.machine.cycle

    def _run_until_free(self, call: Call) -> None:
        if not self.machine.run_until_zero(
            self._mailbox, step_cycles=self._patience_cycles, limit_cycles=_ANSWER_CYCLES
        ):
            raise StepgenError.of(f"the sketch hangs after {call}", place=str(self.elf))


def mail(call: Call, loop: Loop) -> bytes:
    """
    Return what the mailbox holds for *call*, with an empty answer, and *loop* between calls.
    """
    update = (call.modification, call.interval, call.count)
    top_high, top = divmod(call.top, 1 << 32)
    arguments = (call.kind, call.motor, loop, call.control, top, call.limit, *update)
    within = 0 if call.context is Context.LOOP else call.kind
    answer = (0,) * (_WITHIN - _RESULT)
    more = (within, call.context, call.steps)
    return _MAILBOX.pack(*arguments, 0, *answer, *more, 0, 0, 0, top_high, *(0,) * _LIMITS)


def drive_switches(machine: Machine, motor: MotorPlan, pressed: int = 0) -> None:
    """
    Press the limit switches of *motor* that *pressed* names, as PRESS does, and let go the others.
    """
    for switch in motor.end_stops.switches if motor.end_stops else ():
        is_pressed = bool(pressed & SWITCH_BITS[switch.end])
        high = is_pressed == switch.active_high
        machine.drive_pin(switch.register.address, switch.pin.bit.bit, high=high)


def is_running(events: Events, vector: int) -> bool:
    """
    Tell whether at the end of *events* the interrupt *vector* runs.
    """
    own = events[events["source"] == vector]
    own = own[(own["kind"] == Kind.ISR_ENTER) | (own["kind"] == Kind.ISR_EXIT)]
    return bool(len(own)) and bool(own["kind"][-1] == Kind.ISR_ENTER)


def watched_registers(plan: Plan) -> list[int]:
    """
    Return the data addresses whose writes tell when a motor's timer or channel is started.
    """
    timers = dict.fromkeys(motor.timing.timer for motor in plan.motors)
    of_timers = [
        address
        for timer in timers
        for address in (
            timer.tccrb.address,
            *(timer.tcnt.address + byte for byte in range(timer.counter_bytes)),
        )
    ]
    channels = (compare_channel(motor.timing) for motor in plan.motors)
    return of_timers + [one.address + byte for one in channels if one for byte in (0, 1)]


def compare_channel(timing: TimerPlan) -> Register | None:
    """
    Return the compare register of the 16-bit timer's channel that *timing* has, if it has one.
    """
    if not timing.channel or not isinstance(timing.timer, Timer16):
        return None
    return timing.timer.compare_channels[timing.channel][0]

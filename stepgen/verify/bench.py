"""
The test bench: a sketch that does what a mailbox in RAM says, on a simulated chip.
"""

from dataclasses import dataclass, field
from enum import IntEnum
from pathlib import Path
from struct import Struct
from typing import Self

from stepgen.errors import StepgenError
from stepgen.plan.model import Plan
from stepgen.verify.events import Events
from stepgen.verify.simulators import SIMAVR, Simulator

_MAILBOX = Struct("<BBBBIIIHHbBi")
_LOOP_OFFSET = 2
_MARK_BEGIN, _MARK_END, _MARK_READY = 1, 2, 3
_SETUP_CYCLES = 2_000_000
_ANSWER_CYCLES = 1_000_000


class Loop(IntEnum):
    """
    What the sketch does between calls.
    """

    SLEEP = 0
    BUSY = 1
    HOSTILE = 2


class CallKind(IntEnum):
    """
    Which function is called: of a motor or, from 13 on, of the library or avr-libc.

    DIVIDE_CLOCK sets CLKPR: the clock is divided by 2 to the power of *control*. The last two
    give their result as the position.
    """

    SET_SPEED = 1
    HOLD = 2
    RELEASE = 3
    READ = 4
    INIT = 5
    UPDATE_CHECK = 6
    CALLBACKS = 7
    DIVIDE_CLOCK = 13
    TOP_PER_SECOND = 14
    CLOCKS_PER_SECOND = 15


SWITCHING = frozenset({CallKind.HOLD, CallKind.RELEASE})
"""The calls that a motor does not have where nothing can switch its coils."""


@dataclass(frozen=True)
class Call:
    """
    A call as the scenario asks for it.
    """

    kind: CallKind
    motor: int = 0
    control: int = 0
    top: int = 0
    limit: int = 0
    modification: int = 0
    interval: int = 0
    count: int = 0


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
        if not self.machine.run_until_mark(_MARK_READY, limit_cycles=_SETUP_CYCLES):
            raise StepgenError.of("the sketch never came out of setup()", place=str(self.elf))

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.machine.close()

    def set_loop(self, loop: Loop) -> None:
        """
        Choose what the sketch does between calls.
        """
        self.machine.write_ram(self._mailbox + _LOOP_OFFSET, bytes([loop]))

    def wait(self, cycles: int) -> None:
        """
        Let the chip run for *cycles* more.
        """
        self.machine.run_until(self.machine.cycle + cycles)

    def call(self, call: Call) -> Answer:
        """
        Let the sketch make *call*, and return when it is over.

        Raises:
            StepgenError: The sketch did not get round to it, or did not return.
        """
        loop = self.machine.read_ram(self._mailbox + _LOOP_OFFSET, 1)[0]
        message = _MAILBOX.pack(*_arguments(call, loop), 0, 0, 0)
        self.machine.write_ram(self._mailbox, message)
        begin = self._run_to_mark(_MARK_BEGIN, call)
        self.machine.fine = True
        end = self._run_to_mark(_MARK_END, call)
        self.machine.fine = False
        self._run_until_free(call)
        *_, result, status, position = _MAILBOX.unpack(
            self.machine.read_ram(self._mailbox, _MAILBOX.size)
        )
        answer = Answer(call, begin, end, result, status, position)
        self.answers.append(answer)
        return answer

    def events(self) -> Events:
        """
        Return everything that was recorded since reset.
        """
        return self.machine.events()

    def _run_to_mark(self, mark: int, call: Call) -> int:
        if not self.machine.run_until_mark(mark, limit_cycles=_ANSWER_CYCLES):
            raise StepgenError.of(f"the sketch hangs in {call}", place=str(self.elf))
        return self.machine.cycle

    def _run_until_free(self, call: Call) -> None:
        start = self.machine.cycle
        while self.machine.read_ram(self._mailbox, 1)[0]:
            if self.machine.cycle > start + _ANSWER_CYCLES:
                raise StepgenError.of(f"the sketch hangs after {call}", place=str(self.elf))
            self.machine.run_until(self.machine.cycle + 1)


def _arguments(call: Call, loop: int) -> tuple[int, ...]:
    """
    Return the fields of the mailbox that come before its answer.
    """
    update = (call.modification, call.interval, call.count)
    return (call.kind, call.motor, loop, call.control, call.top, call.limit, *update)


def watched_registers(plan: Plan) -> list[int]:
    """
    Return the data addresses whose writes tell when a motor's timer is started.
    """
    timers = [motor.timing.timer for motor in plan.motors]
    return [
        address
        for timer in timers
        for address in (
            timer.tccrb.address,
            *(timer.tcnt.address + byte for byte in range(timer.counter_bytes)),
        )
    ]

"""
What verification knows of a motor, taken from the spec and the board, not from the plan.

The oracle must not share the planner's tables: wires and phases are read here once more.
"""

import functools
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from stepgen.devices import PortBit, Register, Timer
from stepgen.plan.model import MotorPlan, Plan
from stepgen.reference.contract import MotionKind, TimingKind
from stepgen.reference.facts import MotorFacts
from stepgen.reference.timer import SLOWEST_CYCLES
from stepgen.spec import LoadedSpec, Motor
from stepgen.verify.bench import compare_channel
from stepgen.verify.drives import DriveFacts, drive_facts
from stepgen.verify.elf import read_firmware
from stepgen.verify.end_stops import end_stop_facts
from stepgen.verify.ladders import ladder_of
from stepgen.verify.trace import ClockStart, PortState, Run, Trace

_VECTOR_BYTES = 4
_RJMP = 0xC000


@dataclass(frozen=True)
class Subject:
    """
    One motor as the oracle sees it.

    Args:
        name: Its name in the spec.
        facts: What the reference model needs.
        drive: Its wires, in the model's order, and what they may show.
        vector: Number of the interrupt that makes its steps.
        timer: Its timer.
        shared: Those of its wires that are another motor's too.
        channel: The compare register that makes its steps on a timer that runs through, else None.
    """

    name: str
    facts: MotorFacts
    drive: DriveFacts
    vector: int
    timer: Timer
    shared: tuple[PortBit, ...] = ()
    channel: Register | None = None

    def clock_starts(self, trace: Trace) -> list[ClockStart]:
        """
        Return when its timer was started in *trace*; of a channel, when a call set it.
        """
        if self.channel is None:
            return trace.clock_starts(self.timer)
        return [
            ClockStart(one.cycle, 1, 0)
            for one in trace.channel_sets(self.channel, self.timer)
            if not one.in_interrupt
        ]

    @property
    def is_axis(self) -> bool:
        """
        Tell whether it is moved by the calls of an axis.
        """
        return self.facts.ladder is not None

    @functools.cached_property
    def masks(self) -> dict[str, int]:
        """
        Return the bits of its wires on each port, by the port's letter.
        """
        return _masks(self.drive.wires)

    @functools.cached_property
    def own_masks(self) -> dict[str, int]:
        """
        Return the same without the wires that it shares.
        """
        return _masks(bit for bit in self.drive.wires if bit not in self.shared)

    def edge(self, run: Run) -> PortState:
        """
        Return the write of *run* that makes the step: the last one, or that which raises STEP.
        """
        if self.drive.pulse is None:
            return run.writes[-1]
        step = self.drive.wires[0]
        rises = (
            write for write in run.writes if write.port == step.port and write.value >> step.bit & 1
        )
        return next(rises, run.writes[-1])

    def pattern(self, ports: dict[str, int]) -> tuple[bool, ...]:
        """
        Return what its wires show when the ports hold *ports*.
        """
        return tuple([ports[port] & mask != 0 for port, mask in self._places])

    @functools.cached_property
    def _places(self) -> tuple[tuple[str, int], ...]:
        return tuple((bit.port, 1 << bit.bit) for bit in self.drive.wires)


def subjects(loaded: LoadedSpec, plan: Plan, elf: Path) -> tuple[Subject, ...]:
    """
    Return the motors of *loaded*, as the program *elf* drives them.

    The planner's choices come from *plan*: timer, range, from which lateness on a step is missed.
    """
    motors = loaded.spec.motors
    drives = {name: drive_facts(motor.drive, plan.board) for name, motor in motors.items()}
    users = Counter(bit for drive in drives.values() for bit in drive.wires)
    image = read_firmware(elf).image
    found = []
    for name, planned in zip(motors, plan.motors, strict=True):
        drive = drives[name]
        shared = tuple(bit for bit in drive.wires if users[bit] > 1)
        channel = compare_channel(planned.timing)
        timing = _timing(motors[name], channel)
        has_ramps = planned.motion.ladder is not None
        pulse = drive.pulse and drive.pulse.with_timing(timing, has_ramps=has_ramps)
        drive = replace(drive, pulse=pulse)
        facts = _facts(motors[name], drive, plan, timing, shares_enables=bool(shared))
        facts = _with_ladder(facts, planned)
        facts = replace(facts, end_stops=end_stop_facts(motors[name], planned, plan.board.f_cpu_hz))
        vector = plan.board.mcu.vector(planned.timing.vector).number
        overrun = planned.hot_path.overrun_cycles
        saved = _jump_saved_cycles(image, vector)
        found.append(
            Subject(
                name=name,
                facts=replace(facts, overrun_cycles=overrun and overrun + saved),
                drive=drive,
                vector=vector,
                timer=planned.timing.timer,
                shared=shared,
                channel=channel,
            )
        )
    return tuple(found)


def _masks(bits: Iterable[PortBit]) -> dict[str, int]:
    masks: dict[str, int] = {}
    for bit in bits:
        masks[bit.port] = masks.get(bit.port, 0) | 1 << bit.bit
    return masks


def _jump_saved_cycles(image: bytes, vector: int) -> int:
    """
    Return the cycle less that the jump at *vector* takes if the linker made an RJMP of the JMP.

    The interrupt then reads the counter that much earlier.
    """
    opcode = int.from_bytes(image[vector * _VECTOR_BYTES :][:2], "little")
    return int(opcode & 0xF000 == _RJMP)


def _timing(motor: Motor, channel: Register | None) -> TimingKind:
    spec: Any = motor.timing
    kind: TimingKind = spec.kind
    return "wide-compare" if channel else kind


def _with_ladder(facts: MotorFacts, planned: MotorPlan) -> MotorFacts:
    """
    Return *facts* with what makes *planned* an axis, if it is one: the ladder is the planner's.
    """
    motion = planned.motion
    return replace(
        facts,
        ladder=ladder_of(motion),
        cruise_256=motion.cruise_interval_256,
        queue=motion.queue,
    )


def _facts(
    motor: Motor, drive: DriveFacts, plan: Plan, timing: TimingKind, *, shares_enables: bool
) -> MotorFacts:
    motion_spec: Any = motor.motion
    motion: MotionKind = motion_spec.kind
    long_period: int | None = getattr(motor.timing, "longest_period_s", None)
    return MotorFacts(
        phases=drive.phases,
        coils_off=drive.coils_off,
        minimum_cycles=plan.minimum_period_cycles,
        at_rest=motor.at_rest,
        motion=motion,
        timing=timing,
        shares_enables=shares_enables,
        has_direction=drive.pulse is not None,
        command_timeout_millis=motor.command_timeout_ms,
        wake_cycles=drive.pulse.wake_cycles(timing) if drive.pulse else 0,
        sees_passed=timing == "wide-compare",
        slowest_cycles=max(SLOWEST_CYCLES, (long_period or 0) * plan.board.f_cpu_hz),
    )

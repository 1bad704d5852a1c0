"""
What verification knows of a motor, taken from the spec and the board, not from the plan.

The oracle must not share the planner's tables: wires and phases are read here once more.
"""

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal

from stepgen.devices import Board, PortBit, Timer
from stepgen.plan.model import Plan
from stepgen.reference.contract import MotionKind, TimingKind
from stepgen.reference.facts import MotorFacts
from stepgen.reference.sequences import coils_off, phases
from stepgen.spec import LoadedSpec, Motor
from stepgen.verify.elf import read_firmware

_VECTOR_BYTES = 4
_RJMP = 0xC000
# PWM A and B, then DIR A and B: of the shield, and of one stacked upon another.
_SHIELD_ENABLES = ("D3", "D11")
_SHIELD_DIRECTIONS = {False: ("D12", "D13"), True: ("D9", "D8")}


@dataclass(frozen=True)
class Subject:
    """
    One motor as the oracle sees it.

    Args:
        name: Its name in the spec.
        facts: What the reference model needs.
        wires: The port bit of each wire, in the model's order.
        vector: Number of the interrupt that makes its steps.
        timer: Its timer.
        is_shield: Whether its wires are the motor shield's enables and directions.
        shared: Those of its wires that are another motor's too.
    """

    name: str
    facts: MotorFacts
    wires: tuple[PortBit, ...]
    vector: int
    timer: Timer
    is_shield: bool
    shared: tuple[PortBit, ...] = ()

    @property
    def masks(self) -> dict[str, int]:
        """
        Return the bits of its wires on each port, by the port's letter.
        """
        return _masks(self.wires)

    @property
    def own_masks(self) -> dict[str, int]:
        """
        Return the same without the wires that it shares.
        """
        return _masks(bit for bit in self.wires if bit not in self.shared)

    def pattern(self, ports: dict[str, int]) -> tuple[bool, ...]:
        """
        Return what its wires show when the ports hold *ports*.
        """
        return tuple(bool(ports[bit.port] >> bit.bit & 1) for bit in self.wires)


def subjects(loaded: LoadedSpec, plan: Plan, elf: Path) -> tuple[Subject, ...]:
    """
    Return the motors of *loaded*, as the program *elf* drives them.

    The planner's choices come from *plan*: timer, range, from which lateness on a step is missed.
    """
    wires = {name: _wires(motor.drive, plan.board) for name, motor in loaded.spec.motors.items()}
    users = Counter(bit for bits in wires.values() for bit in bits)
    image = read_firmware(elf).image
    found = []
    for name, planned in zip(loaded.spec.motors, plan.motors, strict=True):
        motor = loaded.spec.motors[name]
        vector = plan.board.mcu.vector(planned.timing.vector).number
        overrun = planned.hot_path.overrun_cycles
        shared = tuple(bit for bit in wires[name] if users[bit] > 1)
        found.append(
            Subject(
                name=name,
                facts=replace(
                    _facts(motor, plan, shares_enables=bool(shared)),
                    overrun_cycles=overrun and overrun + _jump_saved_cycles(image, vector),
                ),
                wires=wires[name],
                vector=vector,
                timer=planned.timing.timer,
                is_shield=motor.drive.kind == "motor-shield",
                shared=shared,
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


def _facts(motor: Motor, plan: Plan, *, shares_enables: bool) -> MotorFacts:
    drive: Any = motor.drive
    kind: Literal["four-wire", "motor-shield"] = drive.kind
    motion_spec: Any = motor.motion
    motion: MotionKind = motion_spec.kind
    timing_spec: Any = motor.timing
    timing: TimingKind = timing_spec.kind
    sequence: str | Sequence[str] = getattr(drive.sequence, "patterns", drive.sequence)
    return MotorFacts(
        phases=phases(kind, sequence),
        coils_off=coils_off(kind),
        minimum_cycles=plan.minimum_period_cycles,
        at_rest=motor.at_rest,
        motion=motion,
        timing=timing,
        shares_enables=shares_enables,
    )


def _wires(drive: Any, board: Board) -> tuple[PortBit, ...]:  # noqa: ANN401 - any kind of drive
    names = drive.pins if drive.kind == "four-wire" else _shield_names(drive)
    pins = [board.find_pin(name) for name in names]
    return tuple(pin.bit for pin in pins if pin)


def _shield_names(drive: Any) -> tuple[str, ...]:  # noqa: ANN401 - a motor shield
    return (*(drive.enables or _SHIELD_ENABLES), *_SHIELD_DIRECTIONS[drive.stacked])

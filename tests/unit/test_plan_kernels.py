"""
Kernels and the step interrupt: which one is taken, and what each port sees on the way.
"""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from ruamel.yaml import YAML

from stepgen.devices import find_board
from stepgen.errors import StepgenError
from stepgen.plan.coils import CoilDrive
from stepgen.plan.kernels import PortWrite, Ring, Toggle
from stepgen.plan.model import MotorPlan, Plan
from stepgen.plan.planner import make_plan
from stepgen.spec import LoadedSpec, Spec, load_spec
from stepgen.spec.document import Document

SPECS = Path(__file__).resolve().parents[2] / "specs"
TEXT = "motors: {}\n"  # where faults are reported; the specs here come as data
NAMED = ("full", "wave", "half")
Levels = tuple[bool, ...]
Ports = dict[str, int]


def _plan(board: str, **motors: dict[str, Any]) -> Plan:
    spec = Spec.model_validate({"library": "Mine", "board": board, "motors": motors})
    tree = YAML().load(TEXT)
    return make_plan(LoadedSpec(spec, Document(Path("spec.yaml"), TEXT, tree, tree)))


def _coils(motor: MotorPlan) -> CoilDrive:
    assert isinstance(motor.drive, CoilDrive)
    return motor.drive


def _motor(board: str, **motor: object) -> MotorPlan:
    return _plan(board, motor=motor).motors[0]


def _four_wire(pins: Sequence[str], sequence: object = "full") -> dict[str, object]:
    return {"kind": "four-wire", "pins": list(pins), "sequence": sequence}


@pytest.mark.parametrize(
    ("port", "sequence", "kernel"),
    [
        ("owned", "full", Toggle),
        ("shared", "full", Ring),  # a stray write of the sketch must mend itself
        ("owned", "wave", Ring),
        ("owned", "half", Ring),
    ],
)
def test_only_full_steps_on_an_owned_port_toggle(
    port: str, sequence: str, kernel: type[Toggle | Ring]
) -> None:
    """
    Toggling is taken where nobody else writes the port and two groups of bits take turns.
    """
    motor = _motor("uno", drive="motor-shield", sequence=sequence, port=port)

    assert isinstance(motor.kernel, kernel)


def test_full_steps_on_two_ports_do_not_toggle() -> None:
    """
    One write of ones to PINx reaches one port only.
    """
    motor = _motor("uno", drive=_four_wire(["D6", "D7", "D8", "D9"]), port="owned")

    assert isinstance(motor.kernel, Ring)


def test_toggle_masks_of_the_shield() -> None:
    """
    The first step from (DIR A, DIR B) = 00 raises DIR A, PB4; the second one DIR B, PB5.
    """
    kernel = _motor("uno", drive="motor-shield", port="owned").kernel

    assert isinstance(kernel, Toggle)
    assert kernel.masks == (0b01_0000, 0b10_0000)
    assert kernel.values == (0b00_0000, 0b01_0000, 0b11_0000, 0b10_0000)


def _applied(ports: Ports, write: PortWrite, value: int) -> Ports:
    """
    Return *ports* after one write of a ring, as the port's register takes it.
    """
    old = ports[write.port.letter]
    new = {
        "clear": old & value,
        "set": old | value,
        "merge": old & ~write.mask & 0xFF | value,
    }[write.operation]
    return {**ports, write.port.letter: new}


def _levels(drive: CoilDrive, ports: Ports) -> Levels:
    return tuple(bool(ports[w.pin.bit.port] >> w.pin.bit.bit & 1) for w in drive.wires)


def _at_phase(drive: CoilDrive, ring: Ring, phase: int, background: int) -> Ports:
    """
    Return the ports in *phase*; bits that are not the motor's are those of *background*.
    """
    ports = {share.port.letter: background & ~share.mask & 0xFF for share in ring.ports}
    for wire, on in zip(drive.wires, drive.phases[phase], strict=True):
        ports[wire.pin.bit.port] |= on << wire.pin.bit.bit
    return ports


def _is_allowed(drive: CoilDrive, old: Levels, new: Levels, seen: Levels) -> bool:
    """
    Tell whether *seen* only switches coils off on the way from *old* to *new*.
    """
    if drive.kind == "four-wire":
        return any(
            all(not now or was for now, was in zip(seen, known, strict=True))
            for known in (old, new)
        )
    coils = ((0, 2), (1, 3)) if len(old) == 4 else ()
    return all(
        not seen[enable]
        or (seen[enable], seen[sign]) in ((old[enable], old[sign]), (new[enable], new[sign]))
        for enable, sign in coils
    )


def _check_ring(motor: MotorPlan, background: int) -> None:
    ring, drive = motor.kernel, _coils(motor)
    assert isinstance(ring, Ring)
    count = len(drive.phases)
    for phase in range(count):
        for row, way in ((2 * phase, 1), (2 * phase + 1, -1)):
            following = (phase + way) % count
            place = ring.rows[row][0]
            assert place == ring.row_bytes * (2 * following + (way < 0))
            ports = _at_phase(drive, ring, phase, background)
            seen = list(_walk(drive, ring, ports, ring.rows[place // ring.row_bytes][1:]))
            old, new = drive.phases[phase], drive.phases[following]
            assert seen[-1] == (new, _at_phase(drive, ring, following, background))
            assert all(_is_allowed(drive, old, new, levels) for levels, _ in seen)


def _walk(
    drive: CoilDrive, ring: Ring, ports: Ports, values: Sequence[int]
) -> Iterator[tuple[Levels, Ports]]:
    for write, value in zip(ring.writes, values, strict=True):
        ports = _applied(ports, write, value)
        yield _levels(drive, ports), ports


def _pin_labels(board: str) -> list[str]:
    found = find_board(board)
    assert found is not None
    return [pin.label for pin in found.pins]


def _tables() -> st.SearchStrategy[list[str]]:
    patterns = st.integers(0, 15).map(lambda value: f"{value:04b}")
    return st.lists(patterns, min_size=3, max_size=8, unique=True)


@given(
    pins=st.lists(st.sampled_from(_pin_labels("uno")), min_size=4, max_size=4, unique=True),
    sequence=st.sampled_from(NAMED) | _tables(),
    background=st.integers(0, 255),
)
def test_a_ring_on_the_uno_only_switches_off_on_the_way(
    pins: list[str], sequence: object, background: int
) -> None:
    """
    Forward and backward, each write of a step leaves only coils of one of its two phases on.
    """
    _check_ring(_motor("uno", drive=_four_wire(pins, sequence)), background)


@given(
    pins=st.lists(st.sampled_from(_pin_labels("mega")), min_size=4, max_size=4, unique=True),
    sequence=st.sampled_from(NAMED) | _tables(),
    background=st.integers(0, 255),
)
def test_a_ring_on_the_mega_only_switches_off_on_the_way(
    pins: list[str], sequence: object, background: int
) -> None:
    """
    The same holds on up to four of the Mega's eleven ports.
    """
    _check_ring(_motor("mega", drive=_four_wire(pins, sequence)), background)


@pytest.mark.parametrize("board", ["uno", "mega"])
@pytest.mark.parametrize("sequence", ["full", "wave", "half"])
def test_a_ring_of_the_shield_only_switches_off_on_the_way(board: str, sequence: str) -> None:
    """
    No coil of the shield sees a current that it has neither before nor after the step.
    """
    for background in (0x00, 0x5A, 0xFF):
        _check_ring(_motor(board, drive="motor-shield", sequence=sequence), background)


@given(
    enables=st.lists(
        st.sampled_from([pin for pin in _pin_labels("uno") if pin not in ("D8", "D9")]),
        min_size=2,
        max_size=2,
        unique=True,
    ),
    sequence=st.sampled_from(["half", "wave"]),
)
def test_a_ring_of_a_stacked_shield_turns_coils_that_are_off(
    enables: list[str], sequence: str
) -> None:
    """
    Wherever its enables are, the DIR wires D9 and D8 change while their coil is switched off.
    """
    drive = {"kind": "motor-shield", "stacked": True, "enables": enables, "sequence": sequence}
    _check_ring(_motor("uno", drive=drive), 0x5A)


def test_a_ring_lies_in_one_page_of_flash() -> None:
    """
    Its alignment is the power of two that holds it: 16 rows of 2 bytes need 32.
    """
    kernel = _motor("mega", drive=_four_wire(["A8", "A9", "A10", "A11"], "half")).kernel

    assert isinstance(kernel, Ring)
    assert (kernel.row_bytes, kernel.size_bytes, kernel.alignment_bytes) == (2, 32, 32)


def test_a_ring_that_is_too_long_is_refused() -> None:
    """
    32 patterns on four ports need rows of 8 bytes, 512 in all; one byte names 256 at most.
    """
    table = ["1000", "0100"] * 16
    with pytest.raises(StepgenError, match=r"32 patterns on 4 ports are too many, 16 are possible"):
        _motor("mega", drive=_four_wire(["D22", "D37", "D49", "A8"], table))


def test_the_step_of_the_shield_takes_28_cycles() -> None:
    """
    4 response, 3 JMP, 2+1+1 entry, 1+1+1+1 count, 1+1+1+1+1 step, 1+1+2 exit, 4 RETI.
    """
    motor = make_plan(load_spec(SPECS / "uno_motor_shield.yaml")).motors[0]

    assert motor.hot_path.usual_cycles == 28
    assert motor.hot_path.edge_cycles == 17  # up to and with the second instruction of the step


def test_an_extended_port_costs_two_cycles_an_access() -> None:
    """
    Port K is beyond IN and OUT: its load and its store take a cycle more each than port D's.
    """
    near = _motor("mega", drive=_four_wire(["D21", "D20", "D19", "D18"])).hot_path
    far = _motor("mega", drive=_four_wire(["A8", "A9", "A10", "A11"])).hot_path

    assert far.usual_cycles - near.usual_cycles == 2


def test_the_cycles_of_a_path_are_the_sum_of_its_instructions() -> None:
    """
    What is printed beside each instruction adds up to what the contract says.
    """
    for board, arrival in (("uno", 4 + 3), ("mega", 5 + 3)):
        path = _motor(board, drive="motor-shield", sequence="half").hot_path

        assert path.usual_cycles == arrival + sum(line.cycles for line in path.usual)


def test_the_first_motor_gets_the_gpiors() -> None:
    """
    Three GPIORs hold the state of one motor; the next ones keep it in RAM and share the scratch.
    """
    plan = _plan(
        "mega",
        pan={"drive": _four_wire(["A8", "A9", "A10", "A11"]), "timer": 4},
        tilt={"drive": "motor-shield", "timer": 3},
    )
    first, second = (motor.storage for motor in plan.motors)

    assert (first.state.name, first.count.name, first.scratch.name) == (
        "GPIOR0",
        "GPIOR1",
        "GPIOR2",
    )
    assert (second.state.name, second.count.name) == ("tiltState", "tiltCount")
    assert second.state.register is None
    assert second.count.register is None
    assert second.scratch == first.scratch
    # IN and OUT take a cycle, LDS and STS two; a step has four accesses to count and state.
    same = _motor("mega", drive="motor-shield", timer=3).hot_path
    assert plan.motors[1].hot_path.usual_cycles - same.usual_cycles == 4


@pytest.mark.parametrize(
    ("pins", "motion"),
    [("[D6, D14, A8, D49]", "constant"), ("[D6, D14, D7, D15]", "update-events")],
)
def test_the_branch_to_the_boundary_reaches_it(pins: str, motion: str, tmp_path: Path) -> None:
    """
    BREQ reaches 63 words; the longest steps, on far ports with their state in RAM, are shorter.
    """
    spec = tmp_path / "far.yaml"
    spec.write_text(
        "library: Far\nboard: mega\nmotors:\n"
        "  near: {drive: {kind: four-wire, pins: [D22, D23, D24, D25]}}\n"
        f"  far: {{drive: {{kind: four-wire, pins: {pins}}}, motion: {motion}}}\n",
        encoding="utf-8",
    )

    path = make_plan(load_spec(spec)).motors[1].hot_path

    lines = [*path.usual, *path.clock]
    start = next(index for index, line in enumerate(lines) if line.text == "breq  1f")
    assert 40 < sum(line.words for line in lines[start + 1 :]) <= 63

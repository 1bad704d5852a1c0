"""
The wiring test finds how a motor is wired, whatever the order of its four wires.
"""

import re
from collections.abc import Callable
from itertools import pairwise, permutations
from pathlib import Path

import pytest

from stepgen import api
from stepgen.plan.coils import CoilDrive
from stepgen.verify.compilers import default_compiler
from stepgen.verify.events import Kind
from tests.sim.example_builds import build_example, example_names
from tests.sim.rotor import turned
from tests.sim.terminal import Terminal

SPECS = Path(__file__).parents[2] / "specs"
SPEC = SPECS / "uno_uln2003_28byj48.yaml"
WITH_COILS = [
    path.stem
    for path in sorted(SPECS.glob("*.yaml"))
    if "WiringTest" in example_names(api.plan(path))
]
PINS = ("D8", "D9", "D10", "D11")  # bits 0 to 3 of port B
STEPS = 256
SETTLING = 2  # phases: the rotor may stand right opposite to the first coil
# A simulated rotor needs no time: a tenth of the waits, so that each test takes a second.
HASTE = (("kStepMillis = 10;", "kStepMillis = 1;"), ("delay(500);", "delay(50);"))
QUESTION = "Which one was smooth"
DIRECTION = "Was that forward"
Phases = list[frozenset[int]]


def switched(board: Terminal) -> Phases:
    """
    Return the pins that were on, one set for each time that any was: 0 for D8 to 3 for D11.
    """
    rows = board.machine.events()
    address = api.plan(SPEC).board.mcu.port("B").port.address
    values = rows[(rows["kind"] == Kind.PORT) & (rows["source"] == address)]["value"]
    found = [frozenset(bit for bit in range(4) if int(value) >> bit & 1) for value in values]
    return [
        pins for before, pins in pairwise([frozenset[int](), *found]) if pins != before and pins
    ]


def wired(phases: Phases, wiring: tuple[int, ...]) -> Phases:
    """
    Return the coils that are on where the pin *n* goes to the coil ``wiring[n]``.
    """
    return [frozenset(wiring[pin] for pin in pins) for pins in phases]


def turns_evenly(phases: Phases) -> int:
    """
    Return by how many degrees each step turns the rotor, 0 if not all by the same.
    """
    ways = set(list(turned(phases))[SETTLING:])
    return ways.pop() if len(ways) == 1 else 0


@pytest.fixture(scope="module")
def tries() -> list[Phases]:
    """
    Return what the sketch switches in each of its tries.
    """
    board = begun()
    board.until(QUESTION, seconds=15)
    phases = switched(board)
    assert len(phases) == 3 * STEPS
    return [phases[first : first + STEPS] for first in range(0, len(phases), STEPS)]


@pytest.fixture(scope="module")
def advice() -> Callable[..., tuple[str, ...]]:
    """
    Return a function: from the number of the smooth try, and whether it was forward, the pins.
    """
    known: dict[tuple[int, bool], tuple[str, ...]] = {}

    def ask(number: int, *, forward: bool) -> tuple[str, ...]:
        if (number, forward) not in known:
            board = begun()
            board.until(QUESTION, seconds=15)
            board.type(f"{number}\r\n".encode())
            board.until(DIRECTION, seconds=5)
            board.type(b"y\r\n" if forward else b"n\r\n")
            printed = board.until("That is all", seconds=1)
            (pins,) = re.findall(r"^  pins: \[(.*)\]\r$", printed, re.MULTILINE)
            known[number, forward] = tuple(pins.split(", "))
        return known[number, forward]

    return ask


def begun(edits: tuple[tuple[str, str], ...] = HASTE) -> Terminal:
    """
    Return the board with the sketch, just out of reset.
    """
    return Terminal(build_example(SPEC, "WiringTest", default_compiler(), edits), api.plan(SPEC))


@pytest.mark.parametrize("wiring", list(permutations(range(4))), ids=str)
def test_one_try_is_smooth_and_its_order_mends_the_wiring(
    wiring: tuple[int, ...],
    tries: list[Phases],
    advice: Callable[..., tuple[str, ...]],
    tmp_path: Path,
) -> None:
    """
    With the pins that the sketch prints, each half step of the library turns the rotor forward.

    In the two other tries the rotor ends where it began.
    """
    evenly = [turns_evenly(wired(phases, wiring)) for phases in tries]
    (smooth,) = [number for number, way in enumerate(evenly) if way]
    for number, phases in enumerate(tries):
        if number != smooth:
            assert (
                abs(sum(list(turned(wired(phases, wiring)))[1:])) <= 180
            )  # half an electrical turn

    pins = advice(smooth + 1, forward=evenly[smooth] > 0)

    mended = tmp_path / "mended.yaml"
    text = SPEC.read_text(encoding="utf-8")
    mended.write_text(text.replace(", ".join(PINS), ", ".join(pins)), encoding="utf-8")
    drive = api.plan(mended).motors[0].drive
    assert isinstance(drive, CoilDrive)
    labels = [wire.pin.label for wire in drive.wires]
    library = [
        frozenset(PINS.index(label) for label, on in zip(labels, phase, strict=True) if on)
        for phase in drive.phases
    ]
    assert turns_evenly(wired(library * 3, wiring)) == 45


def test_a_rightly_wired_motor_is_told_so() -> None:
    """
    Order 1, forward: the pins are those of the spec. Each try takes 2.56 s.
    """
    board = begun(edits=())
    board.until("order 2", seconds=4)
    assert board.machine.cycle / 16_000_000 == pytest.approx(2.56 + 0.5, abs=0.1)
    board.until(QUESTION, seconds=15)
    board.enter("1", "Was that forward for you: y or n?", seconds=5)
    board.type(b"y")

    assert "All is as the spec has it:\r\n  pins: [D8, D9, D10, D11]\r\n" in board.until(
        "That is all", seconds=1
    )


@pytest.mark.parametrize("stem", WITH_COILS)
def test_every_wiring_test_ends_with_the_pins_of_its_spec(stem: str) -> None:
    """
    Motor after motor, with 1 and y typed, over a UART or over USB.
    """
    path = SPECS / f"{stem}.yaml"
    plan = api.plan(path)
    board = Terminal(build_example(path, "WiringTest", default_compiler(), HASTE), plan)
    for motor in plan.motors:
        if not isinstance(motor.drive, CoilDrive) or motor.drive.kind != "four-wire":
            continue
        board.until(f"motor {motor.name}\r\n", seconds=1)
        board.until(QUESTION, seconds=15)
        board.type(b"1")
        board.until(DIRECTION, seconds=5)
        board.type(b"y")
        board.until("All is as the spec has it:\r\n  pins: [", seconds=1)
        printed = board.until("]").removesuffix("]").split(", ")
        coils = [wire.pin.label for wire in motor.drive.wires]
        assert printed == coils
    board.until("That is all", seconds=1)


def test_over_usb_nothing_is_asked_until_somebody_listens() -> None:
    """
    The motor stands still until the Serial Monitor is open; then the first try begins.
    """
    path = SPECS / "micro_slider.yaml"
    plan = api.plan(path)
    port = plan.board.mcu.port("F").port.address

    def coil_writes(board: Terminal) -> int:
        rows = board.machine.events()
        return int(((rows["kind"] == Kind.PORT) & (rows["source"] == port)).sum())

    elf = build_example(path, "WiringTest", default_compiler(), HASTE)
    board = Terminal(elf, plan, opened=False)
    board.wait(1)
    still = not coil_writes(board)
    board.type(b"")
    board.until("motor head\r\norder 1\r\n", seconds=0.2)
    board.wait(0.3)

    assert still
    assert coil_writes(board) > STEPS


def test_no_smooth_order_gives_advice_and_another_try() -> None:
    """
    Anything else than an answer is asked again; 0 says what to check, and r begins again.
    """
    board = begun()
    board.until(QUESTION, seconds=15)
    board.type(b"7")
    board.until(QUESTION)
    board.enter("0", "A wire is loose, or one of the four goes to no coil.", seconds=1)
    board.until("then type r\r\n")
    board.type(b"r")
    board.until("order 1\r\n")

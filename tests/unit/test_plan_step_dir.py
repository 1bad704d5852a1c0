"""
Drive step-dir: which pins, times and instructions the planner decides on.
"""

from collections.abc import Callable
from pathlib import Path

import pytest

from stepgen.devices import DRIVERS, SHIELDS, boards
from stepgen.plan.model import MotorPlan
from stepgen.plan.planner import make_plan
from stepgen.plan.pulses import Pulse, PulseDrive
from stepgen.spec import load_spec

Motors = Callable[..., list[MotorPlan]]
PLAIN = "driver: a4988, step: D2, dir: D5, enable: D8"
FAR = "driver: a4988, step: D46, dir: D48, enable: D62"


@pytest.fixture
def motors(tmp_path: Path) -> Motors:
    """
    Return a function that plans motors with the given drives.
    """

    def plan(*drives: str, board: str = "uno", rest: str = "") -> list[MotorPlan]:
        path = tmp_path / "spec.yaml"
        lines = [
            f"  m{index}: {{drive: {{kind: step-dir, {drive}}}, at_rest: hold{rest}"
            f"{', timing: compare' if index else ''}}}\n"
            for index, drive in enumerate(drives)
        ]
        text = f"library: Mine\nboard: {board}\nmotors:\n{''.join(lines)}"
        path.write_text(text, encoding="utf-8")
        return list(make_plan(load_spec(path)).motors)

    return plan


def _drive(motor: MotorPlan) -> PulseDrive:
    assert isinstance(motor.drive, PulseDrive)
    return motor.drive


def _kernel(motor: MotorPlan) -> Pulse:
    assert isinstance(motor.kernel, Pulse)
    return motor.kernel


def _texts(motor: MotorPlan) -> list[str]:
    return [" ".join(line.text.split()) for line in motor.hot_path.usual]


@pytest.mark.parametrize(
    ("socket", "pins"),
    [
        # RepRap wiki, RAMPS 1.4: STEP, DIR and ENABLE as Arduino numbers them.
        ("ramps-1.4 X", (54, 55, 38)),
        ("ramps-1.4 Y", (60, 61, 56)),
        ("ramps-1.4 Z", (46, 48, 62)),
        ("ramps-1.4 E0", (26, 28, 24)),
        ("ramps-1.4 E1", (36, 34, 30)),
        ("cnc-shield X", (2, 5, 8)),
        ("CNC-Shield y", (3, 6, 8)),
        ("cnc-shield Z", (4, 7, 8)),
        ("cnc-shield A", (12, 13, 8)),
    ],
)
def test_a_socket_stands_for_its_pins(
    motors: Motors, socket: str, pins: tuple[int, int, int]
) -> None:
    """
    STEP, DIR and ENABLE of each socket; ENABLE is active LOW.
    """
    (motor,) = motors(f"driver: a4988, socket: {socket}", board="mega")

    assert [wire.pin.number for wire in motor.drive.every_wire] == list(pins)
    assert [wire.active_low for wire in motor.drive.every_wire] == [False, False, True]


def test_every_shield_fits_the_boards_that_it_names() -> None:
    """
    The boards are known, and each has all pins of all sockets.
    """
    known = {board.name: board for board in boards()}
    for shield in SHIELDS.values():
        for name in shield.boards:
            for socket in shield.sockets.values():
                pins = (socket.step, socket.direction, socket.enable)
                assert all(known[name].find_pin(pin) for pin in pins), (shield.title, name)


@pytest.mark.parametrize("name", sorted(DRIVERS))
def test_a_driver_times_become_cycles_that_are_no_shorter(motors: Motors, name: str) -> None:
    """
    At 16 MHz a cycle is 62.5 ns; times are rounded up to whole ones.
    """
    (motor,) = motors(PLAIN.replace("a4988", name))

    times, cycles = DRIVERS[name].times, _drive(motor).cycles
    pairs = (
        (cycles.high, times.step_high_ns),
        (cycles.low, times.step_low_ns),
        (cycles.setup, times.dir_setup_ns),
        (cycles.hold, times.dir_hold_ns),
        (cycles.enable, times.enable_ns),
    )
    assert all(0 <= cycles * 62.5 - nanoseconds < 62.5 for cycles, nanoseconds in pairs)


def test_times_of_the_spec_win(motors: Motors) -> None:
    """
    A time that is given replaces the driver's; the others stay.
    """
    (motor,) = motors(f"{PLAIN}, times: {{step_high_us: 2.5}}")

    assert (_drive(motor).cycles.high, _drive(motor).cycles.low) == (40, 16)


@pytest.mark.parametrize(
    ("drive", "rest", "rise", "fall"),
    [
        (PLAIN, "", "sbi %[port0], 2", "cbi %[port0], 2"),
        (PLAIN, ", port: owned", "sbi %[port0], 2", "cbi %[port0], 2"),
        (FAR, "", "ori r24, 0x08", "andi r24, 0xf7"),
        (FAR, ", port: owned", "ldi r24, 0x08", "ldi r24, 0x08"),
    ],
)
def test_step_rises_and_falls_as_its_port_allows(
    motors: Motors, drive: str, rest: str, rise: str, fall: str
) -> None:
    """
    SBI and CBI in reach; elsewhere ones to PINx of an owned port, or load, change and store.
    """
    (motor,) = motors(drive, board="mega" if drive is FAR else "uno", rest=rest)

    texts = _texts(motor)
    assert rise in texts
    assert fall in texts
    assert _kernel(motor).registers[0].name[:3] == ("PIN" if rise == fall else "POR")


@pytest.mark.parametrize("name", sorted(DRIVERS))
@pytest.mark.parametrize("drive", [PLAIN, FAR], ids=["near", "far"])
def test_the_pulse_is_long_enough_and_so_is_the_pause(
    motors: Motors, name: str, drive: str
) -> None:
    """
    Counted in the instructions, from the end of a write to STEP to that of the next.

    The pause goes on through RETI, an instruction of the sketch, the response and the way in.
    """
    board = "mega" if drive is FAR else "uno"
    (motor,) = motors(drive.replace("a4988", name), board=board)

    lines, cycles = motor.hot_path.usual, _drive(motor).cycles
    store = ("sbi", "cbi", "sts")
    rise, fall = (
        index
        for index, line in enumerate(lines)
        if line.text.startswith(store) and "%[port0]" in line.text
    )
    high = sum(line.cycles for line in lines[rise + 1 : fall + 1])
    rest = sum(line.cycles for line in lines[fall + 1 :])
    assert cycles.high <= high <= cycles.high + 6
    assert rest + 1 + motor.hot_path.edge_cycles >= cycles.low


def test_what_the_interrupt_does_anyhow_is_part_of_the_pulse(motors: Motors) -> None:
    """
    An A4988's pulse of 16 cycles on a port in reach costs no more than 12 cycles of waiting.
    """
    (motor,) = motors(PLAIN)

    texts = _texts(motor)
    assert texts[-2:] == ["cbi %[port0], 2", "reti"]
    assert texts.index("pop r24") == len(texts) - 3


@pytest.mark.parametrize(
    ("times", "hold_wait", "setup_wait"),
    [
        ("dir_setup_us: 0.2, dir_hold_us: 0.2", 0, 0),
        # 5 us are 80 cycles; 16 + 4 + 1 pass after STEP rose, 4 + 12 + 2 before it rises.
        ("dir_setup_us: 5, dir_hold_us: 5", 80 - 21, 80 - 18),
    ],
)
def test_a_call_waits_only_where_its_own_way_is_too_short(
    motors: Motors, times: str, hold_wait: int, setup_wait: int
) -> None:
    """
    DIR needs time after a step and before one; the way through RETI and into the interrupt counts.
    """
    (motor,) = motors(f"{PLAIN}, times: {{{times}}}")

    kernel = _kernel(motor)
    assert (kernel.hold_wait_cycles, kernel.setup_wait_cycles) == (hold_wait, setup_wait)
    assert kernel.handler.masked >= hold_wait + setup_wait


def test_a_driver_that_wakes_up_slowly_gets_a_long_first_interval(motors: Motors) -> None:
    """
    200 ms of a DM542T are 3.2 million cycles; an A4988 is quicker than any interval.
    """
    (slow,) = motors(PLAIN.replace("a4988", "dm542t"))
    (quick,) = motors(PLAIN)

    assert 3_200_000 <= slow.wake_cycles <= 3_200_000 + 2 * 1024
    assert quick.wake_cycles == 0


def test_two_drivers_on_one_enable_share_it(motors: Motors) -> None:
    """
    By their sockets or by the pin that both name; a driver with an ENABLE of its own does not.
    """
    both = motors(
        "driver: a4988, socket: cnc-shield X", "driver: tmc2209, step: D9, dir: D10, enable: 8"
    )
    own = motors("driver: a4988, socket: cnc-shield X", "driver: tmc2209, step: D9, dir: D10")

    assert [motor.drive.shared_enables for motor in both] == [True, True]
    assert [motor.drive.shared_enables for motor in own] == [False, False]


def test_microsteps_count_as_steps(motors: Motors) -> None:
    """
    200 full steps a turn at 1/16 are 3200 pulses.
    """
    (motor,) = motors(f"{PLAIN}, microsteps: 16", rest=", steps_per_turn: 200")

    assert motor.steps_per_turn == 3200

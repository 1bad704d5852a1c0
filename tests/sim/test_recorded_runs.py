"""
System 1's recorded runs on real hardware, done again by the generated library on a simulated chip.

The literals are those of the log in the source's chapter 10: the virtual TOP and the modification
as they were printed about once a second, and the steps left.
"""

from dataclasses import dataclass
from pathlib import Path

import pytest

from stepgen import api
from stepgen.reference.contract import Status
from stepgen.verify.bench import Bench, Call, CallKind, Loop
from stepgen.verify.events import Kind
from stepgen.verify.firmware import build_firmware
from stepgen.verify.toolchain import default_compiler

SPEC = Path(__file__).parents[2] / "specs" / "uno_variable_speed.yaml"
F_CPU_HZ = 16_000_000
CALLBACK_MARK = 0x10  # the bench writes it to EEDR when the end point is told

CASE_1 = (  # seconds after the call, steps left, TOP, modification
    (1.16, 7656, 15064, 128),
    (2.15, 6594, 15192, 256),
    (3.16, 5543, 15448, 512),
    (4.16, 4512, 15960, 1024),
    (5.16, 3519, 16984, 2048),
    (6.16, 2593, 19032, 4096),
    (7.22, 1777, 23128, 8192),
    (8.22, 1116, 31320, 16384),
    (9.22, 634, 47704, 32768),
)
CASE_2_TOPS = (
    2415000, 1222500, 626250, 328125, 179063, 104532, 67267, 48635, 39319, 34661, 32332,
)  # fmt: skip
CASE_2_MODIFICATIONS = (1192500, 596250, 298125, 149062, 74531, 37265, 18632, 9316, 4658, 2329)


# Where VariableMotion keeps them: three bytes, wake (2), rest, target, start, limit (4 each),
# next (3) come first; nothing is aligned on an AVR.
TOP_OFFSET = 3 + 2 + 4 * 4 + 3
MODIFICATION_OFFSET = TOP_OFFSET + 4


@dataclass(frozen=True)
class Seen:
    """
    What the debugger sees of the motor at one moment.
    """

    top: int
    modification: int
    position: int
    status: Status


@pytest.fixture(scope="module")
def firmware() -> Path:
    """
    Build the bench of the spec with update events.
    """
    loaded = api.load(SPEC)
    return build_firmware(api.plan(SPEC), loaded.document.text, default_compiler()).bench


def look(bench: Bench) -> Seen:
    """
    Read the library's variables from the chip's RAM, and ask it for status and position.
    """
    state = bench.machine.symbol("_ZL11motorMotion")
    top, modification = (
        int.from_bytes(bench.machine.read_ram(state + offset, 4), "little")
        for offset in (TOP_OFFSET, MODIFICATION_OFFSET)
    )
    answer = bench.call(Call(CallKind.READ))
    return Seen(top, modification, answer.position, Status(answer.status))


def run_to(bench: Bench, start_cycle: int, seconds: float) -> None:
    """
    Let the chip run until *seconds* after the call at *start_cycle*.
    """
    bench.wait(start_cycle + round(seconds * F_CPU_HZ) - bench.machine.cycle)


def test_slowing_down_shows_the_recorded_columns(firmware: Path) -> None:
    """
    Case 1: each TOP and modification; steps left within 155 ms, one dump and one stamp.
    """
    with Bench(api.plan(SPEC), firmware) as bench:
        start = bench.call(Call(CallKind.SET_SPEED, 0, 0xF0, 15000, 8900, 64, 1000, 19)).begin_cycle
        for seconds, left, top, modification in CASE_1:
            run_to(bench, start, seconds)
            seen = look(bench)

            assert (seen.top, seen.modification) == (top, modification)
            assert abs(8900 - seen.position - left) <= 0.155 * F_CPU_HZ / top + 1


def test_slowing_down_halts_when_the_recorded_motor_did(firmware: Path) -> None:
    """
    Case 1 halts 12.8 to 13.0 s after the call, with 8900 steps.
    """
    with Bench(api.plan(SPEC), firmware) as bench:
        start = bench.call(Call(CallKind.SET_SPEED, 0, 0xF0, 15000, 8900, 64, 1000, 19)).begin_cycle
        run_to(bench, start, 12.8)
        before = look(bench)
        run_to(bench, start, 13.0)
        after = look(bench)

    assert Status.REACHED not in before.status
    assert Status.REACHED in after.status
    assert after.position == 8900


def test_speeding_up_shows_the_recorded_columns(firmware: Path) -> None:
    """
    Case 2: one TOP a second, 11 updates, then constant at 32332.
    """
    with Bench(api.plan(SPEC), firmware) as bench:
        start = bench.call(
            Call(CallKind.SET_SPEED, 0, 0xF2, 4800000, 0, 2385000, 1000, 11)
        ).begin_cycle
        seen = []
        for second in range(1, 13):
            # A step of the slow first interval comes up to 0.3 s after the event is due.
            run_to(bench, start, second + 0.45)
            seen.append(look(bench))

    assert tuple(one.top for one in seen) == (*CASE_2_TOPS, 32332)
    assert tuple(one.modification for one in seen[:10]) == CASE_2_MODIFICATIONS
    assert Status.SPIN_FIXED in seen[-1].status
    assert Status.SPIN_FIXED not in seen[0].status


def test_the_callback_comes_when_it_was_recorded(firmware: Path) -> None:
    """
    Case 3: timed from loop() each 50 ms, the end point is told 27.5 to 28.2 s after the call.
    """
    with Bench(api.plan(SPEC), firmware) as bench:
        bench.set_loop(Loop.SLEEP)
        bench.call(Call(CallKind.CALLBACKS, 0, 1))
        start = bench.call(
            Call(CallKind.SET_SPEED, 0, 0xE2, 4800000, 10000, 2385000, 1000, 11)
        ).begin_cycle
        for check in range(1, 570):
            run_to(bench, start, check * 0.05)
            bench.call(Call(CallKind.UPDATE_CHECK))
        events = bench.events()
        marks = events[(events["kind"] == Kind.MARK) & (events["value"] == CALLBACK_MARK)]

    assert len(marks) == 1
    assert 27.5 <= (int(marks["cycle"][0]) - start) / F_CPU_HZ <= 28.2


def test_a_running_motor_leaves_the_sketch_its_time(firmware: Path) -> None:
    """
    At 495 steps/s a step takes at most 75 cycles from loop(); the source's took about 220.
    """
    with Bench(api.plan(SPEC), firmware) as bench:
        bench.set_loop(Loop.BUSY)
        bench.call(Call(CallKind.SET_SPEED, 0, 0xD2, 32332, 0, 1, 60000, 2))
        bench.wait(F_CPU_HZ)
        bench.machine.clear_events()
        bench.wait(10 * F_CPU_HZ)
        events = bench.events()
        vector = bench.plan.board.mcu.vector("TIMER1_OVF_vect").number
        runs = events[(events["kind"] == Kind.ISR_EXIT) & (events["source"] == vector)]

    assert len(runs) in {4948, 4949}  # 10 s / (32332 / 16 MHz)
    assert float((runs["cycle"] - runs["since"]).mean()) <= 75

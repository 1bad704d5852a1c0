"""
Every board that stepgen knows: its clock, its milliseconds, and a motor on it.

A board is found here as it is everywhere else, so that a new one is tested as soon as it exists.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from pathlib import Path

import pytest

from stepgen import api
from stepgen.devices import Board, boards
from stepgen.plan.model import Plan
from stepgen.reference.contract import Control
from stepgen.reference.core_clock import millis_after
from stepgen.verify.bench import Bench, Call, CallKind, Loop
from stepgen.verify.events import Kind
from stepgen.verify.firmware import build_firmware
from stepgen.verify.toolchain import default_compiler
from stepgen.verify.trace import Trace

SPEC = """
library: BoardTest
board: {board}
motors:
  motor: {{drive: motor-shield, timer: 1, steps_per_turn: 200}}
"""
# One board of each chip, clock and wiring: the others of its kind run the very same code.
KINDS = {
    (board.mcu.name, board.f_cpu_hz, tuple(pin.bit for pin in board.pins)): board
    for board in boards()
}
CLKPS = range(9)  # datasheet, "Clock Prescaler Select": divided by 2 to the power of 0 to 8
RATE_SPS = 400


@dataclass(frozen=True)
class OnBoard:
    """
    The test's motor on one board: its spec, what was planned, and the bench's program.
    """

    spec: Path
    plan: Plan
    elf: Path


@pytest.fixture(scope="module", params=boards(), ids=lambda board: board.name)
def on_board(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> OnBoard:
    """
    Return a motor on each board in turn.
    """
    board: Board = request.param
    spec = tmp_path_factory.mktemp(board.name) / "spec.yaml"
    spec.write_text(SPEC.format(board=board.name), encoding="utf-8")
    loaded, plan = api.load(spec), api.plan(spec)
    return OnBoard(spec, plan, build_firmware(plan, loaded.document.text, default_compiler()).bench)


@pytest.fixture
def bench(on_board: OnBoard) -> Iterator[Bench]:
    """
    Return the bench on each board in turn, just out of setup().
    """
    with Bench(on_board.plan, on_board.elf) as bench:
        yield bench


@pytest.mark.parametrize(
    "on_board", KINDS.values(), indirect=True, ids=lambda board: str(board.name)
)
def test_a_motor_moves_as_the_model_says(on_board: OnBoard) -> None:
    """
    The motor shield passes every scenario on each kind of board, built by the IDE's compiler.
    """
    report = api.verify(on_board.spec, compiler="gcc-7.3")

    assert [check for check in report.checks if not check.passed] == []


def test_the_core_counts_milliseconds_as_the_model_does(bench: Bench) -> None:
    """
    The core's own variables, at 300 moments of a second: millis() follows its overflows.

    It is behind by an overflow at most, 2.048 ms at 8 MHz, and by less than 1 ms not yet counted.
    """
    machine, f_cpu_hz = bench.machine, bench.plan.board.f_cpu_hz
    for _ in range(300):
        bench.wait(f_cpu_hz // 300)
        while is_in_interrupt(bench):
            bench.wait(1)
        overflows, millis = (
            int.from_bytes(machine.read_ram(machine.symbol(name), 4), "little")
            for name in ("timer0_overflow_count", "timer0_millis")
        )

        assert millis == millis_after(overflows, f_cpu_hz)
        assert 0 <= Fraction(machine.cycle * 1000, f_cpu_hz) - millis < 4


def is_in_interrupt(bench: Bench) -> bool:
    """
    Tell whether an interrupt has begun that has not ended.
    """
    kinds = bench.events()["kind"]
    return int((kinds == Kind.ISR_ENTER).sum()) != int((kinds == Kind.ISR_EXIT).sum())


def test_the_clock_functions_follow_clkpr(bench: Bench) -> None:
    """
    With each divider: f_cpu / 2^CLKPS clocks a second, and a TOP is that by the rate, cut off.
    """
    board = bench.plan.board
    for clkps in CLKPS:
        bench.call(Call(CallKind.DIVIDE_CLOCK, control=clkps))
        clocks = board.f_cpu_hz // 2**clkps

        assert bench.machine.register(board.mcu.clkpr.address) == clkps
        assert bench.call(Call(CallKind.CLOCKS_PER_SECOND)).position == clocks
        for rate, top in ((0, 0), (1, clocks), (7, clocks // 7), (65_535, clocks // 65_535)):
            assert bench.call(Call(CallKind.TOP_PER_SECOND, top=rate)).position == top


def test_a_motor_has_its_rate_on_a_divided_clock(bench: Bench) -> None:
    """
    A rate asked for after a change of CLKPR comes out in seconds, not in clocks of before.
    """
    board = bench.plan.board
    bench.set_loop(Loop.BUSY)  # one that sleeps would make the last call only when a step wakes it
    for clkps in (0, 3):
        bench.call(Call(CallKind.DIVIDE_CLOCK, control=clkps))
        top = bench.call(Call(CallKind.TOP_PER_SECOND, top=RATE_SPS)).position
        began = bench.machine.cycle
        bench.call(Call(CallKind.SET_SPEED, control=Control.DRV_EN, top=top))
        bench.wait(20 * board.f_cpu_hz // 2**clkps // RATE_SPS)
        bench.call(Call(CallKind.SET_SPEED))

        # The CPU's clock and the timer's are divided alike, so a cycle is 2^CLKPS / f_cpu.
        steps = [cycle for cycle in step_cycles(bench) if cycle > began]
        seconds = {Fraction((b - a) * 2**clkps, board.f_cpu_hz) for a, b in pairwise(steps)}
        assert len(steps) == 20
        assert seconds == {Fraction(1, RATE_SPS)}


def test_dividing_the_clock_loses_no_step(bench: Bench) -> None:
    """
    While the motor runs a change of CLKPR makes every step slower and drops none.
    """
    bench.call(Call(CallKind.SET_SPEED, control=Control.DRV_EN, top=10_000))
    for clkps in (1, 8, 0):
        bench.wait(75_000)
        bench.call(Call(CallKind.DIVIDE_CLOCK, control=clkps))
    bench.wait(75_000)
    bench.call(Call(CallKind.SET_SPEED))

    steps = step_cycles(bench)
    assert {b - a for a, b in pairwise(steps)} == {10_000}
    assert bench.call(Call(CallKind.READ)).position == len(steps) >= 30


def step_cycles(bench: Bench) -> list[int]:
    """
    Return the cycles at which the motor's timer raised its interrupt.
    """
    mcu = bench.plan.board.mcu
    trace = Trace(bench.events(), mcu)
    vector = mcu.vector(bench.plan.motors[0].timing.vector).number
    return [run.raised for run in trace.runs(vector)]

"""
The watchdog of a library on a simulated chip: what a sketch that hangs comes to.

The period is that of the chip's oscillator at its nominal 128 kHz; the reset takes no time here,
where a chip waits for its start-up time.
"""

from collections.abc import Iterator
from pathlib import Path

from stepgen.plan.model import Plan
from stepgen.spec import LoadedSpec
from stepgen.verify.bench import Bench, Call, CallKind, Loop, Watchdog
from stepgen.verify.events import Events, Kind
from stepgen.verify.resets import restless_wires
from stepgen.verify.scenarios import DRIVE
from stepgen.verify.simulators import SIMAVR, Simulator
from stepgen.verify.subject import subjects

# Oscillator cycles of each period, by the datasheet's table "Watchdog Timer Prescale Select"; the
# names of the periods are avr-libc's.
OSCILLATOR_TICKS = {
    15: 2048,
    30: 4096,
    60: 8192,
    120: 16_384,
    250: 32_768,
    500: 65_536,
    1000: 131_072,
    2000: 262_144,
    4000: 524_288,
    8000: 1_048_576,
}
_OSCILLATOR_HZ = 128_000
_INSTRUCTION_CYCLES = 8  # the longest, and the one in which the reset is seen
_SETUP_CYCLES = 2_000_000
_FEEDS = 2


def period_cycles(plan: Plan) -> int:
    """
    Return the CPU cycles of the period of the watchdog of *plan*; 0 without one.
    """
    ticks = OSCILLATOR_TICKS[plan.watchdog_ms] if plan.watchdog_ms is not None else 0
    return ticks * plan.board.f_cpu_hz // _OSCILLATOR_HZ


def run_cycles(plan: Plan) -> int:
    """
    Return about how long `judge_watchdog` lets the chip run.
    """
    return (_FEEDS + 1) * period_cycles(plan) + _SETUP_CYCLES


def judge_watchdog(
    loaded: LoadedSpec, plan: Plan, elf: Path, simulator: Simulator = SIMAVR
) -> tuple[str, ...]:
    """
    Let the bench *elf* hang while its motors run; return what differs from the datasheet.

    Before, it is fed late but in time, and nothing may happen.

    Raises:
        StepgenError: The sketch crashed.
    """
    period = period_cycles(plan)
    with Bench(plan, elf, simulator) as bench:
        bench.set_loop(Loop.BUSY)
        for index, motor in enumerate(plan.motors):
            top = 4 * plan.minimum_period_cycles + motor.wake_cycles
            bench.call(Call(CallKind.SET_SPEED, index, DRIVE, top))
        fed = bench.call(Call(CallKind.WATCHDOG, control=Watchdog.START))
        for _ in range(_FEEDS):
            bench.wait(period * 9 // 10)
            fed = bench.call(Call(CallKind.WATCHDOG, control=Watchdog.FEED))
        window = (fed.begin_cycle + period, fed.end_cycle + period + _INSTRUCTION_CYCLES)
        bench.wait(window[1] - bench.machine.cycle)
        resets = _resets(bench.events())
        if len(resets) != 1 or not window[0] <= resets[0] <= window[1]:
            return (f"resets at {resets}, but the period ends at {window[0]} to {window[1]}",)
        findings = tuple(_come_back(bench, resets[0]))
        since = bench.events()[bench.events()["cycle"] > resets[0]]
        motors = subjects(loaded, plan, elf)
        return (*findings, *restless_wires(motors, since, plan.board.mcu))


def _come_back(bench: Bench, reset_cycle: int) -> Iterator[str]:
    """
    Yield what is wrong with the sketch after the reset: that it does not come back, and stay.
    """
    shortest = OSCILLATOR_TICKS[15] * bench.plan.board.f_cpu_hz // _OSCILLATOR_HZ
    if not bench.come_back(_SETUP_CYCLES):
        yield "the sketch never comes out of setup() after the reset"
        return
    bench.wait(2 * shortest)
    again = [cycle for cycle in _resets(bench.events()) if cycle > reset_cycle]
    if again:
        yield f"the chip resets again, {again[0] - reset_cycle} cycles later"
    fired = bench.call(Call(CallKind.WATCHDOG, control=Watchdog.FIRED)).result
    if fired != 1:
        yield f"motorWatchdogFired() returns {fired} after a reset by the watchdog"


def _resets(events: Events) -> list[int]:
    return [int(row["cycle"]) for row in events[events["kind"] == Kind.RESET]]

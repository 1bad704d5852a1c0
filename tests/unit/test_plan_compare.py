"""
Timing compare: which timer it takes, how fast it may be, and what it does on the way to a step.
"""

from collections.abc import Callable

import pytest

from stepgen.errors import StepgenError
from stepgen.plan.instructions import Gate
from stepgen.plan.model import Plan
from stepgen.plan.timings.compare import LONGEST_OVERRUN_CYCLES, LONGEST_WAIT_CYCLES

Planner = Callable[[str], Plan]
SHIELD = "{drive: motor-shield, timing: compare}"


@pytest.mark.parametrize("timing", ["compare", "{kind: compare, timer: 2}"])
def test_it_takes_timer_2_beside_servo(planned: Planner, timing: str) -> None:
    """
    The way out of system 1's weakness 1: Servo has timer 1, the motor timer 2.
    """
    text = f"board: uno\nuses: [Servo]\nmotors:\n  m: {{drive: motor-shield, timing: {timing}}}\n"

    (motor,) = planned(text).motors

    assert motor.timing.timer.number == 2
    assert motor.timing.vector == "TIMER2_COMPA_vect"


def test_a_shield_beside_pwm_on_its_timer_lacks_both(planned: Planner) -> None:
    """
    D3 is an enable of the shield and PWM of timer 2: pin and timer are reported.
    """
    shield = SHIELD.replace("compare", "{kind: compare, timer: 2}")
    with pytest.raises(StepgenError) as error:
        planned(f"board: uno\nuses: [analogWrite D3]\nmotors:\n  m: {shield}\n")

    pin, timer = error.value.faults
    assert pin.reason.startswith("pin D3 (PD3) is taken by analogWrite")
    assert timer.reason.startswith("timer 2 is taken by analogWrite on D3")


def test_its_shortest_period_is_a_lap_for_the_whole_library(planned: Planner) -> None:
    """
    256 ticks of 8 clocks; the constants of a library are there once, so all its motors share it.
    """
    other = "{drive: {kind: four-wire, pins: [D4, D5, D6, D7]}}"
    plan = planned(f"board: uno\nmotors:\n  a: {SHIELD}\n  b: {other}\n")

    assert plan.minimum_period_cycles == 256 * 8
    assert plan.largest_period_cycles == 65_535 * 1024


def _walk(gate: Gate, taken: dict[str, bool]) -> tuple[int, bool]:
    """
    Return the cycles through *gate*, where *taken* says which branches are, and if to the step.

    It names a branch by its instruction alone, or where that is not enough with its target.

    By the instruction set manual: a branch that is taken and a skip cost one cycle more.
    """
    lines = list(gate.instructions)
    labels = {line.label: index for index, line in enumerate(lines) if line.label}
    place = cycles = 0
    while place < len(lines):
        text = lines[place].text
        name, _, rest = text.partition(" ")
        cycles += lines[place].cycles
        if name == "reti":
            return cycles, False
        if name == "rjmp" or taken.get(text, taken.get(name, False)):
            cycles += name != "rjmp"
            place = place + 2 if name == "sbrs" else labels[rest.strip("fb ")]
        else:
            place += 1
    return cycles, True


def test_the_ways_through_its_gate_take_what_is_stated(planned: Planner) -> None:
    """
    A lap, 256 laps, the last lap and the step, followed instruction by instruction.
    """
    (motor,) = planned(f"board: uno\nmotors:\n  m: {SHIELD}\n").motors
    gate = motor.gate
    lap = {"breq": False}
    laps256 = {"breq": True, "brpl": True}
    last = {"breq": True, "brpl": False, "sbrs": True}
    step = {"breq": True, "brpl": False, "sbrs": False}

    assert _walk(gate, lap) == (gate.lap_cycles[0], False)
    assert _walk(gate, last) == (gate.lap_cycles[1], False)
    assert _walk(gate, laps256)[0] < gate.lap_cycles[1]
    assert _walk(gate, step) == (gate.step_cycles, True)


def test_the_ways_of_what_is_late_take_no_longer_than_stated(planned: Planner) -> None:
    """
    The longest: a step in place of the last lap, so late that a lap has passed, the only one.
    """
    (motor,) = planned(f"board: uno\nmotors:\n  m: {SHIELD}\n").motors
    gate = motor.gate
    late_step = {"breq": True, "brpl": False, "sbrs": False, "brsh  9b": True}
    both = {**late_step, "sbrs": True, "brsh  8f": True}
    until_gate = 4 + 3 + 4  # response, jump, prologue

    assert _walk(gate, both) == (gate.step_cycles + gate.late_cycles, True)
    assert _walk(gate, {**late_step, "brsh  10f": True})[0] < gate.step_cycles + gate.late_cycles
    # OCR2A is right again before the counter is back where it was when the step was due.
    assert until_gate + _walk(gate, late_step)[0] < 2_048 - LONGEST_OVERRUN_CYCLES


@pytest.mark.parametrize(("board", "overrun_cycles"), [("uno", 976), ("mega", 975)])
def test_a_step_is_missed_beyond_what_an_interrupt_may_wait(
    planned: Planner, board: str, overrun_cycles: int
) -> None:
    """
    From 126 ticks of 8 cycles on when TCNT2 is read, 32 cycles after the response began.

    4 of response (5 on the Mega), JMP 3, prologue 4, laps 5 and a branch 2, their upper byte 9,
    PUSH and LDS 4, and the first of the two cycles of the LDS that reads.
    """
    (motor,) = planned(f"board: {board}\nmotors:\n  m: {SHIELD}\n").motors
    response = {"uno": 4, "mega": 5}[board]

    assert motor.hot_path.overrun_cycles == 126 * 8 - (response + 3 + 4 + 5 + 2 + 9 + 4 + 1)
    assert motor.hot_path.overrun_cycles == overrun_cycles > LONGEST_WAIT_CYCLES

"""
A call within an interrupt of the sketch is as short as the header says, whatever its arguments.
"""

from pathlib import Path

import pytest

from stepgen import api
from stepgen.library.api_view import call_cycles, function_names
from stepgen.library.render import render_library
from stepgen.plan.model import Plan
from stepgen.verify.bounds.worst_case import WorstCase
from stepgen.verify.toolchain import Target, build, default_compiler

SPECS = Path(__file__).parents[2] / "specs"
STEMS = sorted(path.stem for path in SPECS.glob("*.yaml"))
# What an interrupt does not call: constant expressions, what runs functions of the sketch, and
# what prints. The SetSpeed of an axis takes longer, as its header says.
NOT_WITHIN = (
    "Interval",
    "StepsForTurns",
    "StepsForMicrometres",
    "TimerUpdateCheck",
    "DebugDump",
    "debugDump",
)
ARGUMENTS = {
    "SetSpeed": "a, b, c",
    "MoveTo": "b",
    "Move": "b",
    "SetCurrentPosition": "b",
    "TimerCalcPerSecond": "a",
    "TimerCalcNanometresPerSecond": "b",
    "IntervalForNanometresPerSecond": "b",
    "CallBackPositionReached": "nullptr",
    "CallBackFault": "nullptr",
}


def calls(plan: Plan) -> list[str]:
    """
    Return a call of each function, with arguments that the compiler does not know.
    """
    changing = {motor.name for motor in plan.motors if motor.motion.changes_speed}
    searching = {f"{motor.name}SetSpeed" for motor in plan.motors if motor.motion.ladder}
    found = []
    for name in function_names(plan):
        if name.endswith(NOT_WITHIN) or name in searching:
            continue
        arguments = next((args for end, args in ARGUMENTS.items() if name.endswith(end)), "")
        if name.endswith("SetSpeed") and name.removesuffix("SetSpeed") in changing:
            arguments += ", b, a, a"
        found.append(f"{name}({arguments})")
    return found


def sketch(plan: Plan) -> str:
    """
    Return a sketch whose interrupt makes one call, nobody knows which.
    """
    # Each asks a variable of its own: no table of jumps, whose ways nobody could tell.
    cases = "".join(
        f"  if (asked == {at}) {{ {call}; return; }}\n" for at, call in enumerate(calls(plan))
    )
    return (
        f"#include <Arduino.h>\n#include <{plan.library.name}.h>\n"
        "volatile uint8_t asked, a;\nvolatile uint32_t b, c;\n"
        f"ISR(TIMER0_COMPA_vect) {{\n{cases}}}\n"
        "void setup() { TIMSK0 |= _BV(OCIE0A); }\nvoid loop() {}\n"
    )


@pytest.mark.parametrize("stem", STEMS)
def test_a_call_within_an_interrupt_is_as_short_as_stated(stem: str, tmp_path: Path) -> None:
    """
    The longest way through an interrupt that chooses a call and makes it, response through RETI.
    """
    plan = api.plan(SPECS / f"{stem}.yaml")
    for path, text in {**render_library(plan, ""), "sketch.cpp": sketch(plan)}.items():
        file = tmp_path / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
    sources = [tmp_path / "sketch.cpp", tmp_path / f"src/{plan.library.name}.cpp"]
    target, compiler = Target.from_fqbn(plan.board.fqbn), default_compiler()
    made = build(sources, [tmp_path / "src"], target, compiler, tmp_path / "build")

    worst = WorstCase(made.elf, plan.board.mcu, compiler)
    assert worst.interrupt_cycles("TIMER0_COMPA_vect") <= call_cycles(plan)

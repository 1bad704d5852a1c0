"""
What the step interrupt of a motor is made of: what its own motor asks for, nothing else.
"""

import re
from pathlib import Path

from stepgen import api
from stepgen.library.render import render_library

PAN = "  pan: {drive: {kind: four-wire, pins: [A8, A9, A10, A11], sequence: half}, timer: 4%s}\n"
TILT = "  tilt: {drive: {kind: four-wire, pins: [D22, D23, D24, D25]}, timer: 5, motion: %s}\n"
ISR = re.compile(r"^ISR\(TIMER4_OVF_vect, ISR_NAKED\) \{\n.*?^\}\n", re.MULTILINE | re.DOTALL)


def step_interrupt(folder: Path, *motors: str) -> str:
    """
    Return the step interrupt of the motor on timer 4, which is assembler from end to end.
    """
    folder.mkdir()
    spec = folder / "spec.yaml"
    spec.write_text("library: L\nboard: mega\nmotors:\n" + "".join(motors), encoding="utf-8")
    [isr] = ISR.findall(render_library(api.plan(spec), "")["src/L.cpp"])
    return str(isr)


def test_constant_speed_pays_for_nothing_that_it_does_not_use(tmp_path: Path) -> None:
    """
    The interrupt of a constant motor is the same whatever the motor beside it can do.
    """
    alone = step_interrupt(tmp_path / "alone", PAN % "")

    for motion in ("constant", "update-events"):
        assert step_interrupt(tmp_path / motion, PAN % "", TILT % motion) == alone
    assert step_interrupt(tmp_path / "events", PAN % ", motion: update-events") != alone


def test_constant_speed_is_these_instructions() -> None:
    """
    The usual way of full steps on an owned port is 16 instructions; none looks at the clock.
    """
    spec = Path(__file__).parents[2] / "specs/uno_motor_shield.yaml"
    source = render_library(api.plan(spec), "")["src/ShieldMotor.cpp"]
    usual = source[source.index("ISR(TIMER1_OVF_vect") :].split("reti")[0]

    instructions = re.findall(r'^ +"(?:\d:)? +([a-z]+) ', usual, re.MULTILINE)

    assert instructions == (
        [
            "push",
            "in",
            "out",
            "in",
            "dec",
            "out",
            "breq",
            "in",
            "out",
            "com",
            "andi",
            "out",
            "in",
            "out",
            "pop",
        ]  # and reti
    )


def test_the_way_out_is_within_reach(tmp_path: Path) -> None:
    """
    A conditional branch reaches 63 words, and what it leaps over is longest here.

    Four ports beyond SBI and CBI, state in RAM, and a look at the clock. Words: registers 6, state
    and next row 8, seven writes of LPM, LDS, one operation and STS 6 each with one operation more
    where a port is written once, leaving 3, RETI 1.
    """
    spec = tmp_path / "spec.yaml"
    far = PAN.replace("A8, A9, A10, A11", "D6, D14, A8, D49") % ", motion: update-events"
    motors = TILT % "constant" + "  top: {drive: motor-shield, timer: 3}\n" + far
    spec.write_text(f"library: L\nboard: mega\nmotors:\n{motors}", encoding="utf-8")

    path = api.plan(spec).motors[-1].hot_path

    texts = [instruction.text for instruction in path.usual]
    leapt_over = path.usual[texts.index("breq  1f") + 1 :]
    assert path.boundary[0].label == "1"
    assert sum(instruction.words for instruction in leapt_over) == 6 + 8 + 7 * 6 + 1 + 3 + 1

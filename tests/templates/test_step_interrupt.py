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

"""
The integer arithmetic of the generated code is proven for every input, and the proof can fail.

Motions, timings and kernels meet in a few specs; the campaign proves every spec whole.
"""

import shutil
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import pytest

from stepgen import api
from stepgen.library.render import render_library, template_dir
from stepgen.verify.compilers import default_compiler
from stepgen.verify.proof.library import read_library
from stepgen.verify.proof.meant import MEANT, for_motor
from stepgen.verify.proof.prove import Proof, prove_library

SPECS = Path(__file__).resolve().parents[2] / "specs"
EVERY_SPEC = sorted(SPECS.glob("*.yaml"))


@dataclass(frozen=True)
class Quick:
    """
    Functions of one spec whose proof takes seconds.
    """

    spec: str
    functions: tuple[str, ...]


QUICK = (
    Quick(
        "uno_motor_shield",
        (
            "chooseSetting",
            "motorTimerCalcPerSecond",
            "proofmotorStepsForTurns",
            "motorShieldInit",
            "motorReadPosition",
            "motorReadStatus",
            "motorHold",
            "__vector_motor_boundary",
        ),
    ),
    Quick("uno_servo_beside_variable", ("chooseInterval", "motorMillisLeft", "motorUntilEvent")),
    Quick(
        "mega_ramps_z",
        (
            "zReadStatus",
            "__vector_z_boundary",
            "zReadNanometres",
            "zTimerCalcNanometresPerSecond",
            "proofzStepsForMicrometres",
        ),
    ),
    Quick("uno_uln2003_28byj48", ("proofmotorStepsForTurns",)),
    Quick(
        "uno_trapezoid",
        (
            "slideInit",
            "slideHalt",
            "slideCurrentPosition",
            "slideTargetPosition",
            "slideDistanceToGo",
            "slideIsRunning",
            "slideReadMissed",
            "slideSetCurrentPosition",
            "slideEnableOutputs",
            "slideDisableOutputs",
            "slideStop",
            "positionOf",
            "endLevel",
            "nextDue",
            "levelsIn",
            "slopeOf",
            "the step interrupt by itself",
        ),
    ),
    Quick(
        "uno_homing",
        (
            "slideInit",
            "slideHalt",
            "slideStop",
            "slideMoveTo",
            "slideRunForward",
            "slideHome",
            "slideSetCurrentPosition",
            "slideEmergencyStop",
            "slideReadFault",
            "slideClearFault",
            "slideIsHomed",
            "__vector_slide_limit",
            "the step interrupt by itself",
        ),
    ),
)


@dataclass(frozen=True)
class Mutant:
    """
    An overflow: one text of one template replaced by another, and the function that has it then.
    """

    name: str
    template: str
    old: str
    new: str
    spec: str
    function: str


MUTANTS = (
    Mutant(
        "a TOP of 17 bits just below 2**22 clocks",
        "macros/wide_timer.j2",
        "high >= 8)",
        "high > 8)",
        "uno_motor_shield",
        "chooseSetting",
    ),
    Mutant(
        "a first lap of more than 255 ticks",
        "timings/compare.j2",
        "(rest >> 1) + 128",
        "rest + 128",
        "uno_servo_beside",
        "chooseInterval",
    ),
    Mutant(
        "a time limit that is over 65 s beyond a lap",
        "motions/constant.j2",
        "    wait += 0x4000;\n",
        "    wait += 0xD000;\n",
        "uno_motor_shield",
        "motorSetSpeed",
    ),
    Mutant(
        "256 laps too many where their lower byte is 0",
        "motions/constant.j2",
        "motion.lapsHigh = (laps - 1) >> 8;",
        "motion.lapsHigh = laps >> 8;",
        "uno_servo_beside",
        "motorSetSpeed",
    ),
    Mutant(
        "a lap that is counted when none is over",
        "motions/constant.j2",
        "} else if (lapOver) {",
        "} else {",
        "mega_ramps_z",
        "__vector_z_boundary",
    ),
    Mutant(
        "a change that is larger than what is left of the range",
        "motions/update_events.j2",
        "if (change > room) {",
        "if (change > room + 1) {",
        "uno_variable_speed",
        "motorUpdate",
    ),
    Mutant(
        "a count of what is left that is one too many for 255 steps",
        "motions/constant.j2",
        "motion.rest = rest - run;",
        "motion.rest = rest - run + 1;",
        "uno_motor_shield",
        "__vector_motor_boundary",
    ),
    Mutant(
        "a lap too many in an interval of a ramp",
        "timings/ladder_compare.j2",
        "laps = (high >> 6) - 1;",
        "laps = high >> 6;",
        "uno_trapezoid",
        "slideAdvance",
    ),
    Mutant(
        "a halt that leaves the destination",
        "motions/trapezoid.j2",
        "motion.end = motion.destination = {{ motor.name }}Position();",
        "motion.end = {{ motor.name }}Position();",
        "uno_trapezoid",
        "slideHalt",
    ),
    Mutant(
        "a climb without room to come down again",
        "motions/trapezoid.j2",
        "if (room / 2 < way) way = room / 2;",
        "if (room < way) way = room;",
        "uno_trapezoid",
        "decide",
    ),
    Mutant(
        "an end that a run without one comes to while its speed changes again and again",
        "motions/trapezoid.j2",
        "  putOff(motion);\n  bool climbs;",
        "  bool climbs;",
        "uno_trapezoid",
        "slideSetSpeed",
    ),
    Mutant(
        "a way back that begins where it turned",
        "motions/trapezoid.j2",
        "  motion.row = 0;\n  motion.rung = 0;",
        "  motion.rung = 0;",
        "uno_trapezoid",
        "__vector_slide_boundary",
    ),
    Mutant(
        "a switch that takes a step from what is left of the way",
        "macros/guard.j2",
        "  ++{{ motor.count }};\n",
        "",
        "uno_homing",
        "__vector_slide_limit",
    ),
    Mutant(
        "an emergency stop after which homing goes on",
        "motions/trapezoid.j2",
        "StopAtOnce() {\n{{- limits.ends_homing(motor) | more(2) }}\n",
        "StopAtOnce() {\n",
        "uno_homing",
        "slideEmergencyStop",
    ),
)


def _prove(
    spec: str, folder: Path, functions: Iterable[str] = (), templates: Path | None = None
) -> list[Proof]:
    plan = api.plan(SPECS / f"{spec}.yaml")
    for path, text in render_library(plan, "", templates).items():
        file = folder / "library" / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
    compiler = default_compiler().bin_dir / "avr-g++"
    library = read_library(folder / "library", compiler, plan, folder)
    return prove_library(library, functions)


def _violations(proofs: list[Proof]) -> list[str]:
    return [str(violation) for proof in proofs for violation in proof.violations]


@pytest.mark.parametrize("quick", QUICK, ids=lambda quick: quick.spec)
def test_no_bit_is_lost(quick: Quick, tmp_path: Path) -> None:
    """
    On all ways through each function the invariant stays, and the results are the model's.
    """
    proofs = _prove(quick.spec, tmp_path, quick.functions)

    assert _violations(proofs) == []
    assert {proof.function for proof in proofs} == set(quick.functions)
    assert all(proof.proven for proof in proofs)


@pytest.mark.campaign
@pytest.mark.parametrize("spec", [path.stem for path in EVERY_SPEC])
def test_no_library_loses_a_bit(spec: str, tmp_path: Path) -> None:
    """
    The same for every function of every spec.
    """
    proofs = _prove(spec, tmp_path)

    assert _violations(proofs) == []


@pytest.mark.campaign
@pytest.mark.parametrize("mutant", MUTANTS, ids=lambda mutant: mutant.name)
def test_a_planted_overflow_is_found(mutant: Mutant, tmp_path: Path) -> None:
    """
    The proof of the function with the overflow fails, and shows values that overflow.
    """
    templates = tmp_path / "templates"
    shutil.copytree(template_dir(), templates)
    file = templates / mutant.template
    text = file.read_text(encoding="utf-8")
    assert mutant.old in text
    file.write_text(text.replace(mutant.old, mutant.new), encoding="utf-8")

    (proof,) = _prove(mutant.spec, tmp_path, [mutant.function], templates)

    assert proof.violations
    assert all(violation.example for violation in proof.violations)


def test_what_is_meant_is_there() -> None:
    """
    Each statement that may lose bits is one of a library; none is left of an older one.
    """
    written = ""
    for path in EVERY_SPEC:
        plan = api.plan(path)
        motors = tuple(motor.name for motor in plan.motors)
        files = render_library(plan, "")
        sources = (text for name, text in files.items() if name.endswith(".cpp"))
        written += "".join(for_motor(text, motors) for text in sources)
    code = " ".join(line.partition("//")[0].strip() for line in written.splitlines())
    left = [text for text in MEANT if text not in code]

    assert left == []

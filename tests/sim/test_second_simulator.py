"""
The generated library in a second simulator: the same scenarios, the same model.
"""

import shutil
from pathlib import Path

import pytest

from stepgen import api
from stepgen.library.render import template_dir
from stepgen.reference.sequences import Pattern
from stepgen.reference.stimuli import Edge, EdgeKind
from stepgen.spec import load_spec
from stepgen.verify.compare import within_tolerance
from stepgen.verify.simulators import AVR8JS, SIMAVR, YASIMAVR, Simulator
from stepgen.verify.toolchain import default_compiler
from stepgen.verify.trace import Run
from stepgen.verify.verification import verify_spec

SPECS = Path(__file__).parents[2] / "specs"
EVERY_SPEC = sorted(path.stem for path in SPECS.glob("*.yaml"))
ATMEGA328P = [name for name in EVERY_SPEC if not name.startswith(("mega", "leonardo", "micro"))]
# Speeds that change across prescalers, by calls and by update events; scenarios of theirs.
BY_EVENTS = "motor: events each few milliseconds, by the interrupt, across prescalers"
ACROSS_PRESCALERS = {
    "uno_motor_shield": "restart while running",
    "uno_variable_speed": BY_EVENTS,
}


@pytest.mark.parametrize(
    "name", [*ACROSS_PRESCALERS, "uno_mixed_ports", "mega_pan_tilt", "uno_servo_beside_variable"]
)
def test_avr8js_moves_the_motors_as_the_model_says(name: str) -> None:
    """
    Each scenario that is short enough gives the model's edges, to the cycle.
    """
    report = api.verify(SPECS / f"{name}.yaml", simulator="avr8js")

    assert AVR8JS.tolerance_cycles == 0
    assert [check for check in report.checks if not check.passed] == []
    assert ACROSS_PRESCALERS.get(name, "stop while running") in {
        check.name for check in report.checks
    }
    assert len(report.checks) > 10


def test_what_a_simulator_leaves_out_is_named_with_the_reason() -> None:
    """
    Long scenarios and the example, and those whose outcome hangs on a cycle that it reads wrong.
    """
    report = api.verify(SPECS / "uno_servo_beside.yaml", simulator="avr8js")

    run = {check.name for check in report.checks}
    late = {name for name in report.left_out if "interrupts held up" in name}
    assert len(late) > 5
    assert "the example sketch" in report.left_out
    assert any("s of simulated time, avr8js is slow" in why for why in report.left_out.values())
    assert not run & {*report.left_out}
    assert report.as_json()["left_out"] == report.left_out


@pytest.mark.campaign
@pytest.mark.parametrize("compiler", ["gcc-5.4", "gcc-7.3"])
@pytest.mark.parametrize("name", EVERY_SPEC)
@pytest.mark.parametrize("simulator", [SIMAVR, AVR8JS], ids=lambda one: one.name)
def test_every_spec_agrees_with_the_model(simulator: Simulator, name: str, compiler: str) -> None:
    """
    No spec is refused by simavr or avr8js, which give the model's edges to the cycle.
    """
    report = api.verify(SPECS / f"{name}.yaml", compiler=compiler, simulator=simulator.name)

    assert simulator.tolerance_cycles == 0
    assert [check for check in report.checks if not check.passed] == []


@pytest.mark.yasimavr
@pytest.mark.parametrize("name", ATMEGA328P)
def test_yasimavr_moves_the_motors_as_the_model_says(name: str) -> None:
    """
    It is refused for no spec of the ATmega328P; its edges are the model's, within a cycle.
    """
    report = api.verify(SPECS / f"{name}.yaml", simulator="yasimavr")

    assert YASIMAVR.tolerance_cycles == 1
    assert [check for check in report.checks if not check.passed] == []
    assert len(report.checks) > 7


@pytest.mark.yasimavr
@pytest.mark.parametrize("name", sorted({*EVERY_SPEC} - {*ATMEGA328P}))
def test_yasimavr_is_refused_for_a_chip_that_it_lacks(name: str) -> None:
    """
    A spec for another chip names that as the reason, and no other.
    """
    reason = api.usable_simulators(SPECS / f"{name}.yaml")["yasimavr"]

    assert reason in {f"yasimavr 0.1.6 has no ATmega{number}" for number in (1280, 2560, "32U4")}


@pytest.mark.parametrize("simulator", [SIMAVR, AVR8JS], ids=lambda one: one.name)
def test_the_slow_step_of_a_wrong_library_is_seen(simulator: Simulator, tmp_path: Path) -> None:
    """
    A library that leaves out mode 12 runs a period with the old TOP; both simulators show it.
    """
    templates = altered("timings/fast_pwm.j2", "  {{ timer.tccra }} = 0;\n", "", tmp_path)

    failed = failed_checks("uno_motor_shield", simulator, templates)

    assert "restart while running" in failed


def test_a_match_that_is_a_tick_late_is_seen(tmp_path: Path) -> None:
    """
    A library that starts timer 2 without allowing for its first tick: avr8js shows 8 cycles.
    """
    right, late = "motion.next.first - 1;", "motion.next.first;"
    templates = altered("timings/compare.j2", right, late, tmp_path)

    assert "stop while running" in failed_checks("uno_servo_beside", AVR8JS, templates)


def altered(name: str, old: str, new: str, folder: Path) -> Path:
    """
    Return a copy of the templates in which the one called *name* has *new* in place of *old*.
    """
    templates = folder / "templates"
    shutil.copytree(template_dir(), templates)
    template = templates / name
    text = template.read_text(encoding="utf-8")
    assert old in text
    template.write_text(text.replace(old, new), encoding="utf-8")
    return templates


def failed_checks(spec: str, simulator: Simulator, templates: Path) -> set[str]:
    """
    Return the names of the checks that fail with *templates*.
    """
    loaded = load_spec(SPECS / f"{spec}.yaml")
    report = verify_spec(loaded, default_compiler(), simulator=simulator, templates=templates)
    return {check.name for check in report.checks if not check.passed}


def test_the_tolerance_is_no_wider_than_it_says() -> None:
    """
    An interrupt one cycle off counts as the edge's with a tolerance of one, two cycles off not.
    """
    edge = Edge(1000, Pattern((True, False), (True, True)), 1, EdgeKind.STEP, 0)
    raised = [998, 999, 1000, 1001, 1002]
    runs = [Run(cycle, cycle, cycle, cycle + 40, ()) for cycle in raised]

    assert [run.raised for run in within_tolerance(runs, [edge], 0)] == raised
    assert [run.raised for run in within_tolerance(runs, [edge], 1)] == [
        998,
        1000,
        1000,
        1000,
        1002,
    ]

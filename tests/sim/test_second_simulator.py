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
# Speeds that change across prescalers, by calls and by update events; scenarios of theirs.
BY_EVENTS = "motor: events each few milliseconds, by the interrupt, across prescalers"
ACROSS_PRESCALERS = {
    "uno_motor_shield": "restart while running",
    "uno_variable_speed": BY_EVENTS,
}


@pytest.mark.parametrize("name", [*ACROSS_PRESCALERS, "uno_mixed_ports", "mega_pan_tilt"])
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


@pytest.mark.yasimavr
@pytest.mark.parametrize("name", [*ACROSS_PRESCALERS, "uno_mixed_ports"])
def test_yasimavr_moves_the_motors_as_the_model_says(name: str) -> None:
    """
    Each scenario that is short enough gives the model's edges, within a cycle.
    """
    report = api.verify(SPECS / f"{name}.yaml", simulator="yasimavr")

    assert YASIMAVR.tolerance_cycles == 1
    assert [check for check in report.checks if not check.passed] == []
    assert len(report.checks) > 7


@pytest.mark.parametrize("simulator", [SIMAVR, AVR8JS], ids=lambda one: one.name)
def test_the_slow_step_of_a_wrong_library_is_seen(simulator: Simulator, tmp_path: Path) -> None:
    """
    A library that leaves out mode 12 runs a period with the old TOP; both simulators show it.
    """
    templates = tmp_path / "templates"
    shutil.copytree(template_dir(), templates)
    timing = templates / "timings/fast_pwm.j2"
    text = timing.read_text(encoding="utf-8")
    direct = "  {{ timer.tccra }} = 0;\n"
    assert direct in text
    timing.write_text(text.replace(direct, ""), encoding="utf-8")

    report = verify_spec(
        load_spec(SPECS / "uno_motor_shield.yaml"),
        default_compiler(),
        simulator=simulator,
        templates=templates,
    )

    assert "restart while running" in {check.name for check in report.checks if not check.passed}


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

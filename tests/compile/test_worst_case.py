"""
What the planner assumes of the longest step interrupt is proven for each library it makes.
"""

import shutil
from pathlib import Path

import pytest

from stepgen.library.render import template_dir
from stepgen.plan.planner import make_plan
from stepgen.spec import LoadedSpec, load_spec
from stepgen.verify.bounds.judge import judge_worst_case
from stepgen.verify.compilers import Compiler, default_compiler, find_compilers
from stepgen.verify.firmware import build_firmware
from stepgen.verify.report import Check, MotorFigures, SpecReport

SPECS = sorted((Path(__file__).parents[2] / "specs").glob("*.yaml"))
SHIELD = next(path for path in SPECS if path.stem == "uno_motor_shield")
OTHER_COMPILERS = [one for one in find_compilers() if one != default_compiler()]
# Motors that no spec has: update events with tables, on far ports, several of them.
UPDATE_EVENTS = """\
library: Changing
board: mega
motors:
  pan: {drive: {kind: four-wire, pins: [A8, A9, A10, D6]}, motion: update-events}
  tilt:
    drive: {kind: four-wire, pins: [D22, D23, D24, D25]}
    motion: update-events
    port: owned
"""


def judge(
    loaded: LoadedSpec,
    compiler: Compiler,
    templates: Path | None = None,
    report: SpecReport | None = None,
) -> SpecReport:
    """
    Return the report with nothing but the worst case in it.
    """
    plan = make_plan(loaded)
    report = report or SpecReport(str(loaded.document.path), compiler.name, "")
    report.motors = report.motors or {motor.name: MotorFigures() for motor in plan.motors}
    firmware = build_firmware(plan, loaded.document.text, compiler, templates)
    judge_worst_case(loaded, plan, firmware, compiler, report)
    return report


def only_check(report: SpecReport) -> Check:
    """
    Return the one check of *report*.
    """
    (check,) = report.checks
    return check


@pytest.mark.parametrize("compiler", OTHER_COMPILERS, ids=lambda compiler: compiler.name)
@pytest.mark.parametrize("path", SPECS, ids=lambda path: path.stem)
def test_the_plan_of_each_spec_is_proven(path: Path, compiler: Compiler) -> None:
    """
    No interrupt and no call can take longer than the shortest period was worked out from.

    With the usual compiler that is a check of `stepgen verify`: tests/sim/test_verify.py.
    """
    report = judge(load_spec(path), compiler)

    assert only_check(report).passed, only_check(report).detail
    # Neither is the bound so far off that it says nothing: a fifth over it is planned at most.
    for motor in make_plan(load_spec(path)).motors:
        assert motor.isr_bound_cycles < 1.2 * report.motors[motor.name].bound


@pytest.mark.parametrize("compiler", find_compilers(), ids=lambda compiler: compiler.name)
def test_motors_that_no_spec_has_are_proven_too(compiler: Compiler, tmp_path: Path) -> None:
    """
    The plan's cycles also hold for combinations that are built by nobody else here.
    """
    file = tmp_path / "changing.yaml"
    file.write_text(UPDATE_EVENTS, encoding="utf-8")

    report = judge(load_spec(file), compiler)

    assert only_check(report).passed, only_check(report).detail


@pytest.fixture
def shield() -> SpecReport:
    """
    Return the worst case of the motor shield's library.
    """
    return judge(load_spec(SHIELD), default_compiler())


def with_budget(cycles: int, folder: Path) -> LoadedSpec:
    """
    Return the motor shield's spec with a budget of *cycles*.
    """
    file = folder / "budget.yaml"
    text = SHIELD.read_text(encoding="utf-8")
    file.write_text(f"{text.rstrip()}\n    budget: {{isr_cycles: {cycles}}}\n", encoding="utf-8")
    return load_spec(file)


def test_a_budget_is_kept_or_the_check_fails(shield: SpecReport, tmp_path: Path) -> None:
    """
    A budget that is one cycle too small fails, and the longest way is named.
    """
    bound = shield.motors["motor"].bound

    kept = only_check(judge(with_budget(bound, tmp_path), default_compiler()))
    exceeded = only_check(judge(with_budget(bound - 1, tmp_path), default_compiler()))

    assert kept.passed
    assert not exceeded.passed
    assert f"can take {bound} cycles, over the budget of {bound - 1}" in exceeded.detail
    assert "__vector_motor_boundary" in exceeded.detail
    assert "ShieldMotor.cpp:" in exceeded.detail


def test_a_measurement_over_its_bound_is_noticed(shield: SpecReport) -> None:
    """
    If anything was ever measured beyond its bound, the bound is none.
    """
    figures = shield.motors["motor"]
    measured = SpecReport("", "", "", motors={"motor": MotorFigures(figures.bound + 1)})
    measured.stack_bytes = shield.stack_bound_bytes + 1

    check = only_check(judge(load_spec(SHIELD), default_compiler(), report=measured))

    assert not check.passed
    assert f"took {figures.bound + 1} of {figures.bound} cycles" in check.detail
    assert "bytes of stack" in check.detail


@pytest.mark.parametrize(
    ("old", "new", "why"),
    [
        (
            "  motion.endMillis += 0x4000;",
            "  motion.endMillis += 0x4000; __builtin_avr_delay_cycles(100);",
            "a step interrupt can take",
        ),
        (
            "  motion.rest = rest;",
            "  motion.rest = rest; __builtin_avr_delay_cycles(60);",
            "a call can have interrupts off for",
        ),
        (
            "    {{ motor.name }}Step();",
            "    while (millisCount() & 1) {}\n    {{ motor.name }}Step();",
            "nobody has stated a bound",
        ),
    ],
    ids=["the interrupt", "a call", "a loop"],
)
def test_code_that_takes_longer_is_noticed(tmp_path: Path, old: str, new: str, why: str) -> None:
    """
    It does not matter how seldom it happens: a lap of a millisecond limit ends each 16 s.
    """
    templates = tmp_path / "templates"
    shutil.copytree(template_dir(), templates)
    file = templates / "motions/constant.j2"
    text = file.read_text(encoding="utf-8")
    assert text.count(old) == 1
    file.write_text(text.replace(old, new), encoding="utf-8")

    check = only_check(judge(load_spec(SHIELD), default_compiler(), templates))

    assert not check.passed
    assert why in check.detail

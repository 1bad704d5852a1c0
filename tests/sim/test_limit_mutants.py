"""
Bugs planted where an axis keeps to its limits: the scenario for each sees it.
"""

from dataclasses import replace
from pathlib import Path

import pytest

from stepgen.plan import polls
from stepgen.plan.instructions import Instruction
from stepgen.plan.model import Plan
from stepgen.plan.planner import make_plan
from stepgen.spec import LoadedSpec, load_spec
from stepgen.verify.axis_scenarios import axis_scenarios
from stepgen.verify.compilers import default_compiler
from stepgen.verify.firmware import build_firmware
from stepgen.verify.runner import run_scenario
from tests.sim.mutant import Mutant

SPECS = Path(__file__).parents[2] / "specs"
HOMING, NOTHING, DISTURBED = "homing", "homing that finds nothing", "calls while homing"
SWITCHES, POINTS = "switches that are run into", "a switch at every point of a step"
RANGE, EMERGENCY = "moves beyond the range", "emergency stops"


def mutant(name: str, template: str, old: str, new: str, check: str) -> Mutant:
    """
    Return a bug of the slide that finds home, which the scenario *check* must see.
    """
    return Mutant(name, template, old, new, f"slide: {check}", "slide: ", "uno_homing")


MUTANTS = (
    mutant(
        "a step that is not asked for again where homing has met the switch",
        "limits/homing.j2",
        "    {{ motor.timer.ocr }} = {{ motor.timer.tcnt }} + kSoonTicks;"
        "  // the step that was due comes now\n",
        "",
        HOMING,
    ),
    mutant(
        "a place of the switch that is not where it was seen",
        "limits/homing.j2",
        "motion.end += {{ homing.prefix }}Home - {{ motor.name }}Contact;",
        "motion.end = {{ homing.prefix }}Home;",
        HOMING,
    ),
    mutant(
        "a switch that stops homing a second time",
        "limits/homing.j2",
        "    motion.mode |= kTouched;\n",
        "",
        HOMING,
    ),
    mutant(
        "an approach as fast as the way there",
        "limits/homing.j2",
        "{{ motor.name }}HomeAt({{ homing.prefix }}SlowHeight, {{ homing.prefix }}SlowInterval);",
        "{{ motor.name }}HomeAt({{ homing.prefix }}HomeHeight, {{ homing.prefix }}HomeInterval);",
        HOMING,
    ),
    mutant(
        "a speed of the sketch that homing forgets",
        "limits/homing.j2",
        "  motion.goal = {{ motor.name }}Goal;\n  motion.cruise = {{ motor.name }}Cruise;\n}",
        "  {{ motor.name }}Cruise = motion.cruise;\n}",
        HOMING,
    ),
    mutant(
        "a home that an emergency leaves known",
        "limits/homing.j2",
        "{{ guard.cease_begin(motor) | block }}\n  {{ motor.name }}Homed = false;\n",
        "{{ guard.cease_begin(motor) | block }}\n",
        HOMING,
    ),
    mutant(
        "a switch that stays pressed and is taken for one that works",
        "limits/homing.j2",
        "way == kBackingOff ? {{ homing.pressed }} : !seen",
        "way == kBackingOff ? false : !seen",
        NOTHING,
    ),
    mutant(
        "a search that ends as if it had found the switch",
        "limits/homing.j2",
        "way == kBackingOff ? {{ homing.pressed }} : !seen",
        "seen && way == kBackingOff",
        NOTHING,
    ),
    mutant(
        "moves that go on while homing",
        "limits/homing.j2",
        "%% macro refuse(motor, destination)\n"
        "if ({{ motor.name }}Homing) return MOTOR_ERROR_HOMING;\n",
        "%% macro refuse(motor, destination)\n",
        DISTURBED,
    ),
    mutant(
        "a speed that is accepted while homing",
        "limits/homing.j2",
        "%% macro refuse_speed(motor)\nif ({{ motor.name }}Homing) return MOTOR_ERROR_HOMING;\n",
        "%% macro refuse_speed(motor)\n",
        DISTURBED,
    ),
    mutant(
        "a stop after which homing goes on",
        "motions/trapezoid.j2",
        "Stop() {\n  const Masked masked;\n{{- limits.ends_homing(motor) | more(2) }}\n",
        "Stop() {\n  const Masked masked;\n",
        DISTURBED,
    ),
    mutant(
        "a fault of the other switch that homing takes for its own",
        "limits/homing.j2",
        "if ({{ motor.name }}Homing & 1) {",
        "if ({{ motor.name }}Homing) {",
        DISTURBED,
    ),
    mutant(
        "a step that was counted and not made",
        "macros/guard.j2",
        "  ++{{ motor.count }};\n",
        "",
        POINTS,
    ),
    mutant(
        "a switch that stops the motor and leaves no fault",
        "macros/guard.j2",
        "{{ motor.name }}Cease(MOTOR_FAULT_LIMIT);",
        "{{ motor.name }}StopAtOnce();",
        SWITCHES,
    ),
    mutant(
        "moves that go on after a fault",
        "macros/guard.j2",
        "if ({{ motor.name }}Fault) return MOTOR_ERROR_FAULT;\n",
        "",
        SWITCHES,
    ),
    mutant(
        "a range that ends a step too early",
        "macros/guard.j2",
        "if ({{ destination }} < {{ motor.limits.lowest }} ||",
        "if ({{ destination }} <= {{ motor.limits.lowest }} ||",
        RANGE,
    ),
    mutant(
        "a position that may be set beyond the range",
        "macros/guard.j2",
        "if (position < {{ motor.limits.lowest }} || position > {{ motor.limits.highest }})",
        "if (position < {{ motor.limits.lowest }})",
        RANGE,
    ),
    mutant(
        "an emergency stop without cli",
        "macros/guard.j2",
        "EmergencyStop() {\n  const Masked masked;\n",
        "EmergencyStop() {\n",
        EMERGENCY,
    ),
    mutant(
        "an emergency stop that nothing is told of",
        "macros/guard.j2",
        "  {{ motor.name }}Fault = fault;\n",
        "  if (fault != MOTOR_FAULT_EMERGENCY) {{ motor.name }}Fault = fault;\n",
        EMERGENCY,
    ),
)
# What the look in the step interrupt does instead: an instruction, another one, and the scenario.
LOOKS = {
    "a switch that is seen when it is not": (
        "sbis  %[low], 1",
        "sbic  %[low], 1",
        SWITCHES,
    ),
    "a switch that is never seen": ("rjmp  20f", "rjmp  21f", SWITCHES),
    "a switch that stops whoever goes away from it": (
        "cpi   r24, %[back]",
        "cpi   r24, 0",
        SWITCHES,
    ),
    "a step that is made when it leads into the switch": ("breq  19f", "brne  19f", POINTS),
}


def findings(plan: Plan, loaded: LoadedSpec, check: str, templates: Path | None) -> tuple[str, ...]:
    """
    Return what the scenario *check* of the axis says of the library that is made.
    """
    bench = build_firmware(plan, loaded.document.text, default_compiler(), templates).bench
    (scenario,) = (one for one in axis_scenarios(plan) if one.name == check)
    return run_scenario(loaded, plan, bench, scenario).findings


@pytest.mark.parametrize("bug", MUTANTS, ids=lambda bug: bug.name)
def test_a_planted_bug_of_the_limits_is_caught_by_its_scenario(bug: Mutant, tmp_path: Path) -> None:
    """
    The library with the bug compiles, and the scenario for it says what is wrong.
    """
    loaded = load_spec(SPECS / f"{bug.spec}.yaml")

    found = findings(make_plan(loaded), loaded, bug.check, bug.plant(tmp_path))

    assert bug.finding in "; ".join(found), bug.name


@pytest.mark.parametrize("name", LOOKS)
def test_a_planted_bug_of_the_look_is_caught(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """
    The interrupt looks at a switch in the wrong way, and a scenario sees that.
    """
    old, new, check = LOOKS[name]
    kinds = {part: getattr(polls, part) for part in ("_look", "_pressed")}

    def wrong(part: str) -> None:
        def planted(*arguments: object) -> tuple[Instruction, ...]:
            made = kinds[part](*arguments)
            return tuple(replace(one, text=new) if one.text == old else one for one in made)

        monkeypatch.setattr(polls, part, planted)

    loaded = load_spec(SPECS / "uno_homing.yaml")
    right = make_plan(loaded)
    for part in kinds:
        wrong(part)
    plan = make_plan(loaded)

    assert plan.motors[0].hot_path != right.motors[0].hot_path
    assert findings(plan, loaded, f"slide: {check}", None), name


def test_the_scenarios_come_home() -> None:
    """
    What is compared with the model is worth something: homing ends at home, each time.
    """
    loaded = load_spec(SPECS / "uno_homing.yaml")
    plan = make_plan(loaded)
    bench = build_firmware(plan, loaded.document.text, default_compiler()).bench
    (scenario,) = (one for one in axis_scenarios(plan) if one.name == f"slide: {HOMING}")

    answers = run_scenario(loaded, plan, bench, scenario).answers
    homed = [answer for answer in answers if answer.homed and answer.position == 0]

    assert len(homed) == 4

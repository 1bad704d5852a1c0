"""
Every example compiles, as strictly as the library itself.
"""

from pathlib import Path

import pytest

from stepgen import api
from stepgen.verify.compilers import Compiler, find_compilers
from tests.sim.example_builds import build_example, example_names

SPECS = Path(__file__).parents[2] / "specs"
COMPILERS = find_compilers()
# Among them they have every example: for one motor and for two, with ramps, beside others.
STEMS = (
    "uno_motor_shield",
    "mega_pan_tilt",
    "mega_stacked_shields_variable",
    "pro-mini-8mhz_28byj48",
    "uno_servo_beside_variable",
    "uno_drv8825",
    "uno_cnc_shield",
    "uno_28byj48_ramp",
    "uno_homing",
)
BESIDE_ALL = """
library: BesideAll
board: mega
uses: [Servo, SoftwareSerial, SPI, Wire, tone D22, analogWrite D3, Serial, Serial1, Serial3]
motors:
  motor: {drive: {kind: four-wire, pins: [D4, D5, D6, D7]}, timer: 4}
"""
BESIDE_AN_AXIS = """
library: BesideAnAxis
board: uno
uses: [Serial]
motors:
  slide:
    drive: motor-shield
    timing: {kind: compare, timer: 1}
    motion: {kind: trapezoid, cruise_speed: 400, acceleration: 400}
"""
# Of its axes one homes, one has a switch, one neither; a motor of constant speed is beside them.
WITH_AND_WITHOUT_LIMITS = """
library: WithAndWithout
board: mega
watchdog_ms: 500
motors:
  x:
    drive: {kind: step-dir, driver: a4988, socket: ramps-1.4 X}
    timing: {kind: compare, timer: 1, channel: A}
    motion: {kind: trapezoid, cruise_speed: 4000, acceleration: 20000}
    limits: {low: D3, homing: {speed: 1000, slow_speed: 100, back_off: 200, travel: 20000}}
  y:
    drive: {kind: step-dir, driver: a4988, socket: ramps-1.4 Y}
    timing: {kind: compare, timer: 1, channel: B}
    motion: {kind: trapezoid, cruise_speed: 4000, acceleration: 20000}
    limits: {high: {pin: D15, active: high}}
  z:
    drive: {kind: step-dir, driver: a4988, socket: ramps-1.4 Z}
    timing: {kind: compare, timer: 3, channel: A}
    motion: {kind: trapezoid, cruise_speed: 1000, acceleration: 2000}
  feed: {drive: {kind: four-wire, pins: [D40, D42, D44, D59]}, timer: 4}
"""


def _compile_all(spec: Path, compiler: Compiler) -> None:
    for name in set(example_names(api.plan(spec))) - {"Turn"}:
        assert build_example(spec, name, compiler).is_file()


@pytest.mark.parametrize(("number", "stem"), list(enumerate(STEMS)))
def test_examples_of_some_specs_compile_without_a_warning(number: int, stem: str) -> None:
    """
    All examples of a few specs, with the compilers by turns; verify compiles Turn of all.
    """
    _compile_all(SPECS / f"{stem}.yaml", COMPILERS[number % len(COMPILERS)])


@pytest.mark.parametrize("text", [BESIDE_ALL, BESIDE_AN_AXIS], ids=["all", "axis"])
@pytest.mark.parametrize("compiler", COMPILERS, ids=lambda compiler: compiler.name)
def test_a_sketch_with_every_other_library_compiles(
    compiler: Compiler, text: str, tmp_path: Path
) -> None:
    """
    Together uses all that `uses` can name, on pins of the spec or of its own choice.
    """
    spec = tmp_path / "spec.yaml"
    spec.write_text(text, encoding="utf-8")

    assert build_example(spec, "Together", compiler).is_file()


@pytest.mark.parametrize("compiler", COMPILERS, ids=lambda compiler: compiler.name)
def test_examples_of_motors_with_and_without_limits_compile(
    compiler: Compiler, tmp_path: Path
) -> None:
    """
    Console has words that not every motor knows, and Home is for those alone that find home.
    """
    spec = tmp_path / "spec.yaml"
    spec.write_text(WITH_AND_WITHOUT_LIMITS, encoding="utf-8")

    for name in ("Console", "Home"):
        assert build_example(spec, name, compiler).is_file()


@pytest.mark.campaign
@pytest.mark.parametrize("compiler", COMPILERS, ids=lambda compiler: compiler.name)
@pytest.mark.parametrize("path", sorted(SPECS.glob("*.yaml")), ids=lambda path: path.stem)
def test_every_example_compiles_without_a_warning(path: Path, compiler: Compiler) -> None:
    """
    All examples of all specs, with each compiler.
    """
    _compile_all(path, compiler)

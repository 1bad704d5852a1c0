"""
The engine of the Arduino IDE builds what users copy into their libraries folder.
"""

from pathlib import Path

import pytest

from stepgen import api
from stepgen.verify.arduino_builder import build_with_ide
from stepgen.verify.example import run_example
from stepgen.verify.toolchain import Compiler, find_compilers

STEMS = (
    "uno_motor_shield",
    "uno_mixed_ports",
    "mega_pan_tilt",
    "mega1280_two_motors",
    "pro-mini-8mhz_28byj48",
)
SPECS = Path(__file__).parents[2] / "specs"


@pytest.mark.parametrize("compiler", find_compilers(), ids=lambda compiler: compiler.name)
@pytest.mark.parametrize("stem", STEMS)
def test_the_example_built_by_the_ide_steps_as_the_model_says(
    stem: str, compiler: Compiler, tmp_path: Path
) -> None:
    """
    A library in a libraries folder builds without a warning, and its ELF passes the comparison.
    """
    path = SPECS / f"{stem}.yaml"
    (written,) = api.generate(path, tmp_path / "libraries")
    plan = api.plan(path)

    built = build_with_ide(
        written.target / "examples/Turn",
        tmp_path / "libraries",
        plan.board.fqbn,
        compiler,
        tmp_path / "build",
    )

    assert built.warnings == ()
    assert run_example(api.load(path), plan, built.elf) == ()


@pytest.mark.parametrize(
    ("stem", "name"),
    [
        ("uno_uln2003_28byj48", "WiringTest"),
        ("uno_variable_speed", "Console"),
        ("mega_stacked_shields_variable", "Console"),
        ("uno_28byj48_ramp", "Console"),
    ],
)
def test_the_ide_builds_the_examples_that_have_functions(
    stem: str, name: str, tmp_path: Path
) -> None:
    """
    The IDE puts prototypes before the first function: they must not come before the types.
    """
    path = SPECS / f"{stem}.yaml"
    (written,) = api.generate(path, tmp_path / "libraries")

    built = build_with_ide(
        written.target / "examples" / name,
        tmp_path / "libraries",
        api.plan(path).board.fqbn,
        find_compilers()[0],
        tmp_path / "build",
    )

    assert built.warnings == ()

"""
What a library takes of the chip when a sketch uses all of it.
"""

from pathlib import Path

import pytest

from stepgen import api
from stepgen.library.api_view import function_names
from stepgen.library.render import render_library
from stepgen.verify.toolchain import Build, Compiler, Target, build, empty_sketch, find_compilers

SPECS = Path(__file__).parents[2] / "specs"
INLINE = ("StepsForTurns",)


def everything_in_use(spec: Path, compiler: Compiler, folder: Path) -> Build:
    """
    Build a sketch that keeps every function as it stands: none is fitted to one caller.
    """
    plan = api.plan(spec)
    for path, text in render_library(plan, "").items():
        file = folder / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
    names = [name for name in function_names(plan) if not name.endswith(INLINE)]
    kept = " ".join(f'asm volatile("" : : "i"({name}));' for name in names)
    sketch = folder / "everything.cpp"
    sketch.write_text(
        f"#include <Arduino.h>\n#include <{plan.library.name}.h>\n"
        f"void setup() {{ {kept} }}\nvoid loop() {{}}\n",
        encoding="utf-8",
    )
    source = folder / f"src/{plan.library.name}.cpp"
    target = Target.from_fqbn(plan.board.fqbn)
    return build([sketch, source], [folder / "src"], target, compiler, folder / "build")


@pytest.mark.parametrize("compiler", find_compilers(), ids=lambda compiler: compiler.name)
def test_system_1_is_small_with_everything_in_use(compiler: Compiler, tmp_path: Path) -> None:
    """
    With update events it takes at most 2500 bytes of flash and 60 of RAM over an empty sketch.
    """
    made = everything_in_use(SPECS / "uno_variable_speed.yaml", compiler, tmp_path)
    empty = empty_sketch(Target.from_fqbn("arduino:avr:uno"), compiler)

    assert 1500 < made.flash_bytes - empty.flash_bytes <= 2500
    assert 20 < made.ram_bytes - empty.ram_bytes <= 60

"""
Sketches of a test's own, with the library of a spec.
"""

from collections.abc import Callable
from pathlib import Path

import pytest

from stepgen import api
from stepgen.library.render import render_library
from stepgen.verify.simavr import Machine
from stepgen.verify.toolchain import Target, build, default_compiler

SPECS = Path(__file__).parents[2] / "specs"

MachineWith = Callable[..., Machine]


@pytest.fixture(scope="session")
def machine_with(tmp_path_factory: pytest.TempPathFactory) -> MachineWith:
    """
    Return a function that puts a sketch, with the library of a spec, into a simulated chip.

    The spec is the name of one of specs/, or a path.

    Other *templates* than stepgen's own show what a test is good for.
    """

    def make(spec: str | Path, sketch: str, templates: Path | None = None) -> Machine:
        path = SPECS / f"{spec}.yaml" if isinstance(spec, str) else spec
        folder = tmp_path_factory.mktemp(path.stem)
        plan = api.plan(path)
        for name, text in {**render_library(plan, "", templates), "sketch.cpp": sketch}.items():
            file = folder / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text, encoding="utf-8")
        sources = [folder / "sketch.cpp", *(folder / "src").glob("*.cpp")]
        target = Target.from_fqbn(plan.board.fqbn)
        made = build(sources, [folder / "src"], target, default_compiler(), folder / "build")
        return Machine(made.elf, mcu=plan.board.mcu.name, f_cpu_hz=plan.board.f_cpu_hz)

    return make

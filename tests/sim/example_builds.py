"""
The examples of a library, compiled with the libraries of the Arduino core that they use.
"""

import re
from collections.abc import Iterator
from pathlib import Path

from stepgen import api
from stepgen.library.render import render_library
from stepgen.plan.model import Plan
from stepgen.verify.cache import build_once, content_key
from stepgen.verify.recipes import platform_dir
from stepgen.verify.toolchain import Compiler, Target, build

STUBS = Path(__file__).parents[1] / "libraries/Servo/src"


def example_names(plan: Plan) -> list[str]:
    """
    Return the examples of the library of *plan*.
    """
    paths = (Path(path) for path in render_library(plan, ""))
    return sorted(path.stem for path in paths if path.suffix == ".ino")


def build_example(
    spec: Path, name: str, compiler: Compiler, edits: tuple[tuple[str, str], ...] = ()
) -> Path:
    """
    Return the program of the example *name*, compiled without a warning unless it was before.

    Each of *edits* replaces a text that the sketch must have by another.
    """
    plan = api.plan(spec)
    files = render_library(plan, "")
    sketch = files[f"examples/{name}/{name}.ino"]
    for old, new in edits:
        assert old in sketch
        sketch = sketch.replace(old, new)
    parts = {f"{name}.ino": sketch, **{path: files[path] for path in files if path[:4] == "src/"}}
    stub = "".join(path.read_text(encoding="utf-8") for path in sorted(STUBS.iterdir()))
    key = content_key([compiler.name, compiler.version, plan.board.fqbn, stub, *parts.values()])

    def make(folder: Path) -> None:
        for path, text in parts.items():
            (folder / path).parent.mkdir(exist_ok=True)
            (folder / path).write_text(text, encoding="utf-8")
        libraries = list(_library_folders(sketch))
        code = [path for root in libraries for path in sorted(root.rglob("*.c*"))]
        sources = [folder / f"{name}.ino", *(folder / "src").glob("*.cpp"), *code]
        includes = [folder / "src", STUBS, *libraries, *(root / "utility" for root in libraries)]
        target = Target.from_fqbn(plan.board.fqbn)
        build(sources, includes, target, compiler, folder / "build")

    return build_once("example", key, make) / "build" / f"{name}.ino.elf"


def _library_folders(sketch: str) -> Iterator[Path]:
    """
    Yield the sources of the core's own libraries that *sketch* includes.
    """
    for header in re.findall(r"#include <(\w+)\.h>", sketch):
        folder = platform_dir() / "libraries" / header / "src"
        if folder.is_dir():
            yield folder

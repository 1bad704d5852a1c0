"""
docs/library.md: files, functions, constants and examples of a library are those that it has.
"""

import re
from pathlib import Path

from stepgen import api
from stepgen.library.api_view import function_names
from tests.docs.pages import DOCS, ROOT, Page, all_pages

PAGE = Page(DOCS / "library.md")
OF_ALL = {"debugDump", "motorInterval"}
SPECS = sorted((ROOT / "specs").glob("*.yaml"))


def test_the_files_of_a_library_are_listed(tmp_path: Path) -> None:
    """
    Each file that generate writes is in the table of what comes out, each example in its own.
    """
    api.generate(PAGE.lay_out(tmp_path) / "my_motor.yaml", tmp_path)
    library = tmp_path / "MyMotor"

    for path in library.rglob("*"):
        if path.is_file():
            name = path.relative_to(library).as_posix() if path.suffix != ".ino" else path.stem
            assert f"`{name}`" in PAGE.text


def test_every_function_of_every_library_has_a_row() -> None:
    """
    The table has each function that a library of specs/ has, by the name for a motor `motor`.
    """
    cells = "".join(row[0] for row in PAGE.table("function", "is there", "does"))
    named = set(re.findall(r"`(\w+)\(", cells))
    there = set()
    for spec in SPECS:
        plan = api.plan(spec)
        names = sorted((motor.name for motor in plan.motors), key=len, reverse=True)
        for function in function_names(plan):
            prefix = next((name for name in names if re.match(rf"{name}[A-Z]", function)), "motor")
            is_of_all = function.startswith("motorTimer") or function in OF_ALL
            there.add(function if is_of_all else f"motor{function.removeprefix(prefix)}")

    assert there <= named
    assert named <= there | {"panDebugDump", "motorTimerCalcNanometresPerSecond"}


def test_every_constant_exists() -> None:
    """
    Each MOTOR_... that a page names is in the header of a spec of specs/.
    """
    headers = "".join(
        text for spec in SPECS for path, text in api.render(spec).items() if path.endswith(".h")
    )
    words = (word for page in all_pages() for word in re.findall(r"\bMOTOR_[A-Z_]+", page.text))

    assert {word for word in words if word.rstrip("_") not in headers} == set()

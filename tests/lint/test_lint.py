"""
Each rule of the linter: a library that keeps it, and one that breaks it.

The rules' names and what they demand are those of Arduino Lint (its page "Library", compliance
strict); LK and LJ are stepgen's own.
"""

import os
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from stepgen import api
from stepgen.lint import lint

ROOT = Path(__file__).resolve().parents[2]
GENERATED = sorted((ROOT / "generated").iterdir())
Break = Callable[[Path], None]


@pytest.fixture
def library(tmp_path: Path) -> Path:
    """
    Return the folder of a library that keeps every rule.
    """
    spec = tmp_path / "pan.yaml"
    spec.write_text(
        "library: Pan\nboard: uno\nmotors:\n  motor: {drive: motor-shield, timer: 1}\n",
        encoding="utf-8",
    )
    api.generate(spec, tmp_path)
    return tmp_path / "Pan"


def write(name: str, text: str = "") -> Break:
    """
    Return what writes *text* into the file *name*.
    """

    def act(folder: Path) -> None:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")

    return act


def move(old: str, new: str) -> Break:
    """
    Return what renames *old* to *new*.
    """

    def act(folder: Path) -> None:
        (folder / old).rename(folder / new)

    return act


def drop(name: str) -> Break:
    """
    Return what removes the file *name*.
    """
    return lambda folder: (folder / name).unlink()


def put(field: str, value: str | None) -> Break:
    """
    Return what sets *field* of library.properties to *value*, or removes it.
    """

    def act(folder: Path) -> None:
        path = folder / "library.properties"
        lines = path.read_text(encoding="utf-8").splitlines()
        kept = [line for line in lines if not line.startswith(f"{field}=")]
        added = [] if value is None else [f"{field}={value}"]
        path.write_text("\n".join([*kept, *added, ""]), encoding="utf-8")

    return act


def keyword(line: str) -> Break:
    """
    Return what adds *line* to keywords.txt.
    """

    def act(folder: Path) -> None:
        path = folder / "keywords.txt"
        path.write_text(path.read_text(encoding="utf-8") + line + "\n", encoding="utf-8")

    return act


def flat(*more: Break) -> Break:
    """
    Return what moves the sources beside library.properties, and then does *more*.
    """

    def act(folder: Path) -> None:
        for source in (folder / "src").iterdir():
            source.rename(folder / source.name)
        (folder / "src").rmdir()
        for one in more:
            one(folder)

    return act


def both(first: Break, second: Break) -> Break:
    """
    Return what does one after the other.
    """

    def act(folder: Path) -> None:
        first(folder)
        second(folder)

    return act


def nothing(folder: Path) -> None:
    """
    Leave the *folder* as it is: the rule is about its own name.
    """
    assert folder.is_dir()


def link(folder: Path) -> None:
    """
    Put a symbolic link into *folder*.
    """
    (folder / "also.h").symlink_to(folder / "src" / "Pan.h")


BROKEN: list[tuple[str, Break]] = [
    ("LS001", drop("src/Pan.h")),
    ("LS002", nothing),
    ("LS003", nothing),
    ("LS004", write(".gitmodules", "[submodule]")),
    ("LS005", link),
    ("LS006", write(".development")),
    ("LS007", write("extras/setup.exe")),
    ("LS008", move("src/Pan.h", "src/Tilt.h")),
    ("LS009", move("src", "Src")),
    ("LS010", write("utility/more.cpp")),
    ("LS011", write("Extra/spec.txt")),
    ("LS012", move("extras", "Extras")),
    ("LP001", drop("library.properties")),
    ("LP002", write("library.property")),
    ("LP003", move("library.properties", "Library.properties")),
    ("LP004", write("src/library.properties")),
    ("LP005", write("library.properties", "name=Pan\nfrom me\n")),
    ("LP006", put("depend", "Servo")),
    ("LP007", put("name", None)),
    ("LP008", put("name", "")),
    ("LP009", put("name", "P" * 64)),
    ("LP010", put("name", "P" * 33)),
    ("LP011", put("name", "Pan&Tilt")),
    ("LP012", put("name", "ArduinoPan")),
    ("LP014", put("name", "PanArduino")),
    ("LP015", put("name", "Pan Tilt")),
    ("LP016", put("name", "PanLibrary")),
    ("LP019", put("version", None)),
    ("LP020", put("version", "1.0.0.0")),
    ("LP021", put("version", "1.0")),
    ("LP023", put("author", None)),
    ("LP024", put("author", "")),
    ("LP025", put("maintainer", None)),
    ("LP026", put("maintainer", "")),
    ("LP027", put("maintainer", "Arduino Friends")),
    ("LP028", both(put("maintainer", None), put("email", "a@b.example"))),
    ("LP029", put("email", "")),
    ("LP031", put("sentence", None)),
    ("LP032", put("sentence", "")),
    ("LP034", put("paragraph", None)),
    ("LP036", both(put("sentence", "Turns."), put("paragraph", "Turns. Well."))),
    ("LP037", put("category", None)),
    ("LP038", put("category", "Motors")),
    ("LP039", put("category", "Uncategorized")),
    ("LP040", put("url", None)),
    ("LP041", put("url", "on the shelf")),
    ("LP043", put("architectures", None)),
    ("LP044", put("architectures", "")),
    ("LP045", put("architectures", "atmelavr")),
    ("LP046", put("architectures", "AVR")),
    ("LP047", put("depends", "Ser,vo, $x")),
    ("LP049", put("dot_a_linkage", "yes")),
    ("LP050", flat(put("dot_a_linkage", "true"))),
    ("LP051", put("includes", "")),
    ("LP052", put("includes", "Servo.h")),
    ("LP053", put("precompiled", "maybe")),
    ("LP054", flat(put("precompiled", "full"))),
    ("LP055", put("ldflags", "")),
    ("LP056", put("url", "")),
    ("LP057", put("maintainer", "Friends of Arduino")),
    ("LP058", put("depends", "Servo (>=one)")),
    ("LC001", write("src/more.cpp", "#include <arduino.h>\n")),
    ("LD001", drop("README.md")),
    ("LD002", drop("LICENSE")),
    ("LD003", write("Turn/Turn.ino")),
    ("LD004", lambda folder: shutil.rmtree(folder / "examples")),
    ("LD005", write("demo/readme.txt")),
    ("LD006", move("examples", "Examples")),
    ("LJ001", write("library.json", "{")),
    ("LJ002", write("library.json", '{"name": "Pan", "version": "1.0.0"}')),
    ("LJ003", put("version", "1.0.1")),
    ("LK001", drop("keywords.txt")),
    ("LK002", keyword("turn    KEYWORD2")),
    ("LK003", keyword("turn\tKEYWORD9")),
    ("LK004", keyword("turn()\tKEYWORD2")),
    ("LK005", keyword("motorHold\tKEYWORD2")),
    ("SS001", move("examples/Turn/Turn.ino", "examples/Turn/Run.ino")),
    ("SS003", write("examples/Turn/Turn.pde")),
    ("SS004", write("examples/Turn/a b.ino")),
]


def rules(folder: Path) -> set[str]:
    """
    Return the rules that *folder* breaks.
    """
    return {finding.rule for finding in lint(folder).findings}


@pytest.mark.parametrize("folder", GENERATED, ids=lambda path: path.name)
def test_every_generated_library_keeps_every_rule(folder: Path) -> None:
    """
    What stepgen writes could go to the library manager as it is.
    """
    assert lint(folder).findings == ()


@pytest.mark.parametrize(("rule", "breaks"), BROKEN, ids=[rule for rule, _ in BROKEN])
def test_a_broken_rule_is_found(rule: str, breaks: Break, library: Path) -> None:
    """
    The library keeps every rule; one change, and the rule is named with a place and a fix.
    """
    assert rules(library) == set()
    breaks(library)
    names = {"LS002": "P" * 64, "LS003": "Pan Tilt"}
    folder = library.rename(library.with_name(names.get(rule, library.name)))

    found = [finding for finding in lint(folder).findings if finding.rule == rule]

    assert found
    assert all(finding.place and finding.reason and finding.fix for finding in found)


def test_every_rule_is_tried() -> None:
    """
    No rule is without a library that breaks it.
    """
    assert [rule.name for rule in api.lint_rules()] == sorted(rule for rule, _ in BROKEN)


def test_a_field_is_named_with_its_line(library: Path) -> None:
    """
    The place is one that an editor can go to.
    """
    put("version", "one")(library)
    lines = (library / "library.properties").read_text(encoding="utf-8").splitlines()

    (finding,) = (one for one in lint(library).findings if one.rule == "LP020")

    assert finding.place == f"library.properties:{lines.index('version=one') + 1}"


@pytest.mark.parametrize("constraint", ["=1.0.0", ">=1.1.0", "^1.0", ">1.0 && <2.0", "!=1.0.1"])
def test_constraints_of_the_specification_are_fine(constraint: str, library: Path) -> None:
    """
    What the specification gives as examples of a constraint is none of the findings.
    """
    put("depends", f"Servo, Stepper ({constraint})")(library)

    assert "LP058" not in rules(library)


@pytest.mark.parametrize("version", ["1.0.0", "1.2.3-beta.1", "1.2.3+build.5", "0.1.0-rc.1+x"])
def test_versions_of_semver_are_fine(version: str, library: Path) -> None:
    """
    What semver.org calls a version is one.
    """
    put("version", version)(library)

    assert not {"LP020", "LP021"} & rules(library)


def test_a_binary_file_is_no_keywords_file(library: Path) -> None:
    """
    What cannot be read is reported, and stops nothing.
    """
    (library / "keywords.txt").write_bytes(os.urandom(64) + b"\xff")

    assert "LK001" in rules(library)

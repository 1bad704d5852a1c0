"""
The README: every command in it runs, every spec loads, every sketch compiles, every name exists.
"""

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, get_args

import pytest
from pydantic import BaseModel
from ruamel.yaml import YAML

from stepgen import api
from stepgen.devices import Board, boards
from stepgen.spec import Library, Motor, Spec
from stepgen.spec.drives import KINDS as DRIVES
from stepgen.spec.motions import KINDS as MOTIONS
from stepgen.spec.timings import KINDS as TIMINGS
from stepgen.spec.turns import StepsPerTurn
from stepgen.verify.recipes import platform_dir
from stepgen.verify.toolchain import Target, build, default_compiler

ROOT = Path(__file__).resolve().parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")

# Commands that set up, need hours or are tested elsewhere: here only that they exist.
NAMED_ONLY = ("make ", ". .venv/bin/activate", "stepgen matrix")


def blocks(language: str) -> list[str]:
    """
    Return the fenced blocks of *language* in the README, in their order.
    """
    return re.findall(rf"^```{language}\n(.*?)^```$", README, re.MULTILINE | re.DOTALL)


@dataclass(frozen=True)
class Command:
    """
    A command of a console block, and the output that the README shows below it.
    """

    line: str
    shown: str

    @property
    def is_refused(self) -> bool:
        """
        Tell whether the README shows an error, for which the exit code is 2.
        """
        return ": error: " in self.shown

    def shows(self, output: str) -> bool:
        """
        Tell whether *output* is what the README shows, in which ``...`` stands for any lines.
        """
        parts = (re.escape(part) for part in re.split(r"^\.\.\.\n", self.shown, flags=re.MULTILINE))
        return not self.shown or re.fullmatch(r"(?s:.*)".join(parts), output) is not None


def commands() -> list[Command]:
    """
    Return every command of the README, in its order.
    """
    found = []
    for block in blocks("console"):
        for entry in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
            line, _, shown = entry.partition("\n")
            found.append(Command(line, shown))
    return found


def files() -> dict[str, str]:
    """
    Return the README's YAML files: name, from the first line -> text.
    """
    return {block.split()[1]: block for block in blocks("yaml")}


def specs() -> list[str]:
    """
    Return the names of those files that are specs; the others are scenarios.
    """
    return [name for name, text in files().items() if "\nlibrary:" in text]


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """
    Return a copy of the checkout's specs and Makefile, with the README's files beside them.
    """
    folder = tmp_path / "stepgen"
    shutil.copytree(ROOT / "specs", folder / "specs")
    for name in ("Makefile", "pyproject.toml"):
        shutil.copy(ROOT / name, folder)
    for name, text in files().items():
        (folder / name).write_text(text, encoding="utf-8")
    (tmp_path / "Arduino" / "libraries").mkdir(parents=True)
    return folder


def test_it_opens_with_the_two_commands() -> None:
    """
    The first commands that a newcomer sees are make demo and make test.
    """
    assert [command.line for command in commands()[:2]] == ["make demo", "make test"]


def test_every_command_runs_and_prints_what_is_shown(tree: Path) -> None:
    """
    The console blocks, run in their order in one folder, are the truth.
    """
    environment = os.environ | {
        "HOME": str(tree.parent),
        "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
        "COLUMNS": "100",
    }

    for command in commands():
        if command.line.startswith(NAMED_ONLY):
            continue
        done = subprocess.run(
            ["bash", "-c", command.line],
            cwd=tree,
            env=environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            check=False,
            encoding="utf-8",
            timeout=300,
        )
        assert done.returncode == (2 if command.is_refused else 0), (command.line, done.stdout)
        assert command.shows(done.stdout), (command.line, done.stdout)


def test_the_make_targets_that_documents_name_exist(tree: Path) -> None:
    """
    `make -n` knows each target that README.md and CONTRIBUTING.md mention.
    """
    contributing = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    targets = set(re.findall(r"(?:`|\$ )make ([a-z]+)", README + contributing))

    assert {"demo", "test"} <= targets
    for target in sorted(targets):
        subprocess.run(["make", "-n", target], cwd=tree, check=True, stdout=subprocess.DEVNULL)


@pytest.mark.parametrize("name", specs())
def test_every_spec_can_be_planned(tree: Path, name: str) -> None:
    """
    Each YAML block is a whole spec that stepgen accepts.
    """
    assert api.plan(tree / name).motors


def sketches() -> list[str]:
    """
    Return the C++ blocks that are whole sketches.
    """
    return [block for block in blocks("cpp") if "#include" in block]


@pytest.mark.parametrize("sketch", sketches(), ids=lambda text: text.split()[1])
def test_every_sketch_compiles(tree: Path, sketch: str) -> None:
    """
    Each sketch builds without a warning against the library of the README's spec of that name.
    """
    (library,) = re.findall(r"#include <(\w+)\.h>", sketch)
    (spec,) = (
        tree / name for name in specs() if api.load(tree / name).spec.library.name == library
    )
    api.write(spec, tree)
    (tree / "sketch.ino").write_text(sketch, encoding="utf-8")
    source = tree / library / "src"

    built = build(
        [tree / "sketch.ino", source / f"{library}.cpp"],
        [source],
        Target.from_fqbn(api.plan(spec).board.fqbn),
        default_compiler(),
        tree / "out",
    )

    assert built.elf.is_file()


def test_the_declarations_are_those_of_the_header(tree: Path) -> None:
    """
    All declarations of a block stand in one generated header, but for line breaks.
    """
    texts = [api.generate(tree / name) for name in ("my_motor.yaml", "variable_speed.yaml")]
    headers = [
        one_line(text) for files in texts for path, text in files.items() if path.endswith(".h")
    ]
    declared = [block for block in blocks("cpp") if "#include" not in block]

    assert len(declared) == len(headers)
    for block, header in zip(declared, headers, strict=True):
        for declaration in block.split(";"):
            assert one_line(declaration) in header


def one_line(code: str) -> str:
    """
    Return *code* without its line breaks and the spaces around them.
    """
    return " ".join(code.split()).replace("( ", "(")


def test_every_name_of_the_api_exists(tree: Path) -> None:
    """
    Each function and constant that the README mentions is in a header of one of its specs.
    """
    headers = (
        "".join(text for name in specs() for text in api.generate(tree / name).values())
        + "MOTOR_... MOTOR_CTRL_... MOTOR_STAT_... motorTimer..."
    )
    named = set(re.findall(r"\b(?:MOTOR_[A-Z_]+|(?:motor|pan|tilt)[A-Z]\w+)", README))

    assert {name for name in named if name not in headers} == set()


def test_the_files_of_a_library_are_listed(tree: Path) -> None:
    """
    Each file that generate writes is in the table of what comes out, each example in its own.
    """
    api.write(tree / "my_motor.yaml", tree)
    library = tree / "MyMotor"

    for path in library.rglob("*"):
        if path.is_file():
            name = path.relative_to(library).as_posix() if path.suffix != ".ino" else path.stem
            assert f"`{name}`" in README


def fields(model: type[BaseModel]) -> set[str]:
    """
    Return the names of the fields that a spec may hold in *model*.
    """
    return set(model.model_fields)


@pytest.mark.parametrize(
    "model",
    [Spec, Library, Motor, StepsPerTurn, *DRIVES, *TIMINGS, *MOTIONS],
    ids=lambda m: m.__name__,
)
def test_every_field_of_a_spec_is_described(model: type[BaseModel]) -> None:
    """
    The spec reference has each field, and each value of those with a fixed choice.
    """
    reference = README[README.index("## The spec") :]
    choices = {value for field in model.model_fields.values() for value in _texts(field.annotation)}

    assert {name for name in fields(model) if not re.search(rf"\b{name}\b", reference)} == set()
    if model is not Library:  # its categories are Arduino's
        assert {value for value in choices if value not in reference} == set()


def _texts(annotation: Any) -> Iterator[str]:  # noqa: ANN401 - any type of a field
    for argument in get_args(annotation):
        if isinstance(argument, str):
            yield argument
        else:
            yield from _texts(argument)


@pytest.mark.parametrize("board", boards(), ids=lambda board: board.name)
def test_every_board_is_listed_with_its_place_in_the_ides_menus(board: Board) -> None:
    """
    Each board has a row with its chip, its clock, and the words of the core's boards.txt.
    """
    target = Target.from_fqbn(board.fqbn)
    lines = (platform_dir() / "boards.txt").read_text(encoding="utf-8").splitlines()
    words = dict(line.split("=", 1) for line in lines if "=" in line)
    menu = words[f"{target.board_id}.name"]
    if target.cpu:
        menu += f", processor {words[f'{target.board_id}.menu.cpu.{target.cpu}']}"
    clock = f"{board.f_cpu_hz // 1_000_000} MHz"

    assert f"\n| `{board.name}` | {board.mcu.title} | {clock} | {menu} |\n" in README


def test_every_command_of_stepgen_is_listed(tree: Path) -> None:
    """
    The table of commands is that of `stepgen --help`.
    """
    help_text = subprocess.run(
        [sys.executable, "-m", "stepgen", "--help"],
        cwd=tree,
        check=True,
        capture_output=True,
        encoding="utf-8",
    ).stdout
    offered = set(re.findall(r"^│ ([a-z]+) ", help_text, re.MULTILINE))

    assert offered == set(re.findall(r"^\| `stepgen ([a-z]+)", README, re.MULTILINE))


def test_ci_verifies_each_spec_once() -> None:
    """
    The board matrix of CI has a job for every spec, by the start of its name.
    """
    text = (ROOT / ".github" / "workflows" / "ci.yml").read_text(encoding="utf-8")
    workflow = YAML(typ="safe", pure=True).load(text)
    boards = workflow["jobs"]["verify"]["strategy"]["matrix"]["board"]

    assert sorted(path.name for path in (ROOT / "specs").glob("*.yaml")) == sorted(
        path.name for board in boards for path in (ROOT / "specs").glob(f"{board}_*.yaml")
    )

"""
docs/spec: a page for each field, with what it may hold and its default, as the models have them.
"""

import re
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any, get_args

import pytest
from pydantic import BaseModel
from pydantic.fields import FieldInfo

from stepgen.devices import SKETCH_LIBRARIES, Board, boards
from stepgen.devices.drivers import DRIVERS
from stepgen.devices.sockets import SHIELDS
from stepgen.spec import Library, Motor, Spec
from stepgen.spec.base import KindModel
from stepgen.spec.drives import KINDS as DRIVES
from stepgen.spec.motions import KINDS as MOTIONS
from stepgen.spec.timings import KINDS as TIMINGS
from stepgen.verify.recipes import platform_dir
from stepgen.verify.toolchain import Target
from tests.docs.pages import DOCS, Page

FOLDER = DOCS / "spec"
PARTS = {"drive": DRIVES, "timing": TIMINGS, "motion": MOTIONS}
OF_KINDS = [(part, kind) for part, kinds in PARTS.items() for kind in kinds]
FIELDS = {**Spec.model_fields, **Motor.model_fields}


def of_kind(part: str, kind: type[KindModel]) -> Path:
    """
    Return the file of the page about *kind* of the field *part*.
    """
    return FOLDER / part / f"{kind.model_fields['kind'].default}.md"


def described(page: Page) -> dict[str, tuple[str, str]]:
    """
    Return the fields of the tables of *page*: name -> values and default.
    """
    rows = page.table("field", "values", "default")
    return {row[0].strip("`"): (row[1], row[2]) for row in rows}


def nested(annotation: Any) -> Iterator[type[BaseModel]]:  # noqa: ANN401 - any type of a field
    """
    Yield the models within *annotation* that are no kind, which has a page of its own.
    """
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        if not issubclass(annotation, KindModel | Motor):
            yield annotation
        return
    for argument in get_args(annotation):
        yield from nested(argument)


def within(fields: dict[str, FieldInfo]) -> dict[str, FieldInfo]:
    """
    Return *fields*, and those of the models in them.
    """
    found = dict(fields)
    for field in fields.values():
        for model in nested(field.annotation):
            found |= within(model.model_fields)
    return found


def choices(annotation: Any) -> Iterator[str]:  # noqa: ANN401 - any type of a field
    """
    Yield the words of a fixed choice in *annotation*, but for those of a model in it.
    """
    for argument in get_args(annotation):
        if isinstance(argument, str):
            yield argument
        elif not isinstance(argument, type):
            yield from choices(argument)


def shown_default(field: FieldInfo) -> str:
    """
    Return how a page writes the default of *field*; "none" where any words may say what holds then.
    """
    default = field.get_default(call_default_factory=True)
    if field.is_required():
        return "required"
    if default is None or isinstance(default, BaseModel):
        return "none"
    if isinstance(default, bool):
        return f"`{str(default).lower()}`"
    return f"`{list(default) if isinstance(default, tuple) else default}`"


def check(page: Page, fields: dict[str, FieldInfo]) -> None:
    """
    Compare the tables of *page* with *fields*.
    """
    found = described(page)
    assert set(found) == set(fields)
    for name, field in fields.items():
        values, default = found[name]
        wanted = shown_default(field)
        assert default == wanted or (wanted == "none" and "`" not in default), (name, default)
        assert {word for word in choices(field.annotation) if f"`{word}`" not in values} == set()


@pytest.mark.parametrize("name", FIELDS)
def test_each_field_has_a_page_with_its_values_and_default(name: str) -> None:
    """
    A field of the spec or of a motor has a page, with the fields of what it may hold.
    """
    page = Page(FOLDER / f"{name}.md")

    assert page.text.startswith(f"# `{name}`\n")
    check(page, within({name: FIELDS[name]}))


@pytest.mark.parametrize(("part", "kind"), OF_KINDS, ids=lambda one: getattr(one, "__name__", one))
def test_each_kind_has_a_page_with_its_fields(part: str, kind: type[KindModel]) -> None:
    """
    A kind of drive, timing or motion has a page with its fields, and the page of all has its name.
    """
    page = Page(of_kind(part, kind))
    fields = {name: field for name, field in kind.model_fields.items() if name != "kind"}

    assert page.text.startswith(f"# {part} `{page.path.stem}`\n")
    check(page, within(fields))
    values, _ = described(Page(FOLDER / f"{part}.md"))[part]
    assert f"`{page.path.stem}`" in values


def test_there_is_no_other_page() -> None:
    """
    A page about something that a spec cannot say is left over.
    """
    wanted = {FOLDER / f"{name}.md" for name in (*FIELDS, "README")}
    wanted |= {of_kind(part, kind) for part, kind in OF_KINDS}

    assert set(FOLDER.rglob("*.md")) == wanted


@pytest.mark.parametrize("path", sorted(FOLDER.rglob("*.md")), ids=lambda path: path.stem)
def test_each_page_has_an_example_with_what_it_is_about(path: Path) -> None:
    """
    A spec of the page has the field, or the kind; other tests plan it.
    """
    page = Page(path)
    word = re.compile(rf"\b{re.escape(path.stem)}\b" if path.stem != "README" else "library")

    assert any(word.search(page.files[name]) for name in page.specs)


def test_names_of_other_libraries_drivers_and_sockets_are_listed() -> None:
    """
    What `uses`, `driver` and `socket` may say is decided by tables, and the pages have all of it.
    """
    uses = Page(FOLDER / "uses.md").text
    step_dir = described(Page(FOLDER / "drive" / "step-dir.md"))

    assert {name for name in (*SKETCH_LIBRARIES, "analogWrite") if f"`{name}`" not in uses} == set()
    assert re.findall(r"`(\w+)`", step_dir["driver"][0].split(":")[0]) == list(DRIVERS)
    for shield, socket in SHIELDS.items():
        first, *others = socket.sockets
        assert f"`{shield} {first}`" in step_dir["socket"][0]
        assert all(f"`{other}`" in step_dir["socket"][0] for other in others)


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

    text = Page(FOLDER / "board.md").text
    assert f"\n| `{board.name}` | {board.mcu.title} | {clock} | {menu} |\n" in text


def test_the_index_has_every_field() -> None:
    """
    docs/spec/README.md has a row for each field of a spec and of a motor.
    """
    rows = Page(FOLDER / "README.md").table("field", "is")

    assert {row[0] for row in rows} == {f"[`{name}`]({name}.md)" for name in FIELDS}


def test_ratios_are_written_as_numbers() -> None:
    """
    A default that is a fraction stands in the page as the user would write it.
    """
    assert shown_default(FieldInfo(default=Fraction(1))) == "`1`"
    assert shown_default(Library.model_fields["version"]) == "`1.0.0`"

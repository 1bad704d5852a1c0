"""
docs/commands: a page for each command, with the options that it has, and no others.
"""

import re
from typing import Any

import pytest
import typer

from stepgen import api
from stepgen.cli import app
from tests.docs.pages import DOCS, Page

FOLDER = DOCS / "commands"
COMMANDS: dict[str, Any] = dict(typer.main.get_command(app).commands)  # type: ignore[attr-defined]


def test_each_command_has_a_page_and_a_row() -> None:
    """
    The pages, and the table of the index, are the commands of `stepgen --help`.
    """
    rows = Page(FOLDER / "README.md").table("command", "does")

    assert {path.stem for path in FOLDER.glob("*.md")} - {"README"} == set(COMMANDS)
    assert [row[0] for row in rows] == [f"[`stepgen {name}`]({name}.md)" for name in COMMANDS]


@pytest.mark.parametrize("name", COMMANDS)
def test_each_page_names_every_option(name: str) -> None:
    """
    The first column of its table has each option but --help, long and short, and no other.
    """
    rows = Page(FOLDER / f"{name}.md").table("option", "does")
    described = {option for row in rows for option in re.findall(r"`(--?[a-z-]+)", row[0])}

    assert described == {
        option
        for parameter in COMMANDS[name].params
        if parameter.param_type_name == "option"
        for option in (*parameter.opts, *parameter.secondary_opts)
    } - {"--help"}


@pytest.mark.parametrize("name", COMMANDS)
def test_each_page_shows_the_command_at_work(name: str) -> None:
    """
    It begins with what the command is given, and has an example that is run.
    """
    page = Page(FOLDER / f"{name}.md")
    lines = [command.line for command in page.commands]

    assert page.text.startswith(f"# `stepgen {name}`\n\n`stepgen {name}")
    assert any(line.startswith(f"stepgen {name}") for line in lines)


@pytest.mark.parametrize("name", COMMANDS)
def test_each_command_is_a_function_too(name: str) -> None:
    """
    stepgen.api exports a function of that name with a docstring, and docs/python.md has its row.
    """
    row = re.compile(rf"^\| `{name}\(.*commands/{name}\.md", re.MULTILINE)

    assert name in api.__all__
    assert getattr(api, name).__doc__
    assert row.search(Page(DOCS / "python.md").text)


def test_every_function_of_the_api_is_described() -> None:
    """
    docs/python.md names each function that stepgen.api exports, with a docstring; none besides.
    """
    text = Page(DOCS / "python.md").text
    functions = {name for name in api.__all__ if name.islower()}

    assert all(getattr(api, name).__doc__ for name in functions)
    assert set(re.findall(r"`([a-z_]+)\(", text)) == functions
    assert set(re.findall(r"api\.([A-Za-z_]+)", text)) <= set(api.__all__)

"""
The templates print and decide nothing.
"""

import re
from collections import defaultdict
from pathlib import Path

import pytest
from jinja2 import UndefinedError, nodes

from stepgen.library.render import environment, template_dir

TEMPLATES = sorted(path for path in template_dir().rglob("*.j2"))
PARTIALS = (
    *("addressees", "apis", "consoles", "kernels", "motions", "others", "timeouts", "timings"),
    "watchdogs",
)
MOST_IFS_PER_100_LINES = 6
ARITHMETIC = (
    nodes.Add,
    nodes.Sub,
    nodes.Mul,
    nodes.Div,
    nodes.FloorDiv,
    nodes.Mod,
    nodes.Pow,
    nodes.Neg,
    nodes.Pos,
)
DECISIONS = (nodes.Compare, nodes.And, nodes.Or, nodes.Not, nodes.Test, nodes.CondExpr)


def _name(path: Path) -> str:
    return path.relative_to(template_dir()).as_posix()


def _parsed(path: Path) -> nodes.Template:
    made = environment()
    return made.parse(made.preprocess(path.read_text(encoding="utf-8")))


@pytest.mark.parametrize("path", TEMPLATES, ids=_name)
def test_a_template_calculates_nothing(path: Path) -> None:
    """
    Every number comes from the plan: no template adds or multiplies.
    """
    assert list(_parsed(path).find_all(ARITHMETIC)) == []


@pytest.mark.parametrize("path", TEMPLATES, ids=_name)
def test_a_template_compares_nothing(path: Path) -> None:
    """
    A template asks whether a part is there, by its name alone; it judges no value.
    """
    tree = _parsed(path)

    assert list(tree.find_all(DECISIONS)) == []
    assert all(isinstance(choice.test, nodes.Getattr) for choice in tree.find_all(nodes.If))


@pytest.mark.parametrize("path", TEMPLATES, ids=_name)
def test_a_template_is_no_forest_of_choices(path: Path) -> None:
    """
    A few if-statements per 100 lines, no chains of them, and none inside another.
    """
    choices = list(_parsed(path).find_all(nodes.If))
    lines = path.read_text(encoding="utf-8").count("\n")

    assert len(choices) * 100 <= MOST_IFS_PER_100_LINES * max(lines, 100)
    assert all(not choice.elif_ for choice in choices)
    assert all(not list(part.find_all(nodes.If)) for choice in choices for part in choice.body)


@pytest.mark.parametrize("path", TEMPLATES, ids=_name)
def test_control_lines_begin_with_percent_signs(path: Path) -> None:
    """
    Only %% and {{ }} are used, and the text itself has no blanks at line ends and no tabs.
    """
    text = path.read_text(encoding="utf-8")

    assert not re.search(r"\{%|%\}|\{#|#\}", text)
    assert not re.search(r"[ \t]$", text, re.MULTILINE)
    assert "\t" not in text or path.name == "keywords.txt.j2"  # whose columns are tabs


@pytest.mark.parametrize("folder", PARTIALS)
def test_all_partials_of_a_choice_offer_the_same_macros(folder: str) -> None:
    """
    No caller has to ask which kernel, timing, motion or other library it has.
    """
    offers: dict[tuple[tuple[str, tuple[str, ...]], ...], list[str]] = defaultdict(list)
    for path in sorted((template_dir() / folder).glob("*.j2")):
        macros = _parsed(path).find_all(nodes.Macro)
        offer = sorted((macro.name, tuple(arg.name for arg in macro.args)) for macro in macros)
        offers[tuple(offer)].append(path.name)

    assert len(offers) == 1, dict(offers)


def test_a_name_that_the_view_lacks_is_an_error() -> None:
    """
    A misspelt name stops the generator instead of printing nothing.
    """
    template = environment().from_string("{{ library.nmae }}")

    with pytest.raises(UndefinedError, match="nmae"):
        template.render(library={"name": "Mine"})


def test_an_empty_line_after_a_control_line_is_printed() -> None:
    """
    What a template shows is what it prints: Jinja alone would swallow that line.
    """
    template = environment().from_string("a\n%% if shown\n\nb\n%% endif\n\nc\n")

    assert template.render(shown=True) == "a\n\nb\n\nc\n"

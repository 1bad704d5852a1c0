"""
What every library looks like: deterministic, clean, and safe from the text of its spec.
"""

import getpass
import json
import re
import socket
from pathlib import Path
from typing import Any

import pytest
from markdown_it import MarkdownIt
from ruamel.yaml import YAML

from stepgen import api
from stepgen.errors import StepgenError
from stepgen.library.text import (
    c_comment,
    c_string,
    comment_lines,
    frequency,
    listed,
    properties_value,
    tidy,
)

ROOT = Path(__file__).resolve().parents[2]
SPECS = sorted((ROOT / "specs").glob("*.yaml"))
PROPERTY = re.compile(r"[a-z]+=.*")
HOSTILE = (
    "ends a comment */ int evil(); /*",
    "a line goes on \\",
    "a trigraph goes on ??/",
    "has \"quotes\" and 'more' of them",
    "{{ library.name }} %% for x in y {% raw %}",
    "%% set evil = 1",
    "name=Evil",
    'R"(raw)" \\u000a \\n %s ${HOME} `id` $(id) <b>&amp;</b>',
    "in between \\ " * 12,
    "??/ ??/ ??/ " * 12,
    "#define evil",
    "long " * 60,
    "# a heading",
    "[link](javascript:alert(1)) ![picture](https://example.org/pixel.png)",
    "<script>alert(1)</script> <!-- <?php <img src=x onerror=alert(1)>",
    "```",
    "1. a list",
    "- another | with | bars",
    "ada@example.org, https://example.org and <ada@example.org>",
)
HIDDEN = (
    "tab\tnewline\nreturn\rnull\0bell\a",
    "escape\x1b[2J",
    "\u2028\u2029 separators of lines elsewhere",
    "\x85 another",
    "\u202e direction of writing",
    "\u2066 another\u2069",
    "zero\u200bwidth",
    "\ufeff mark in the middle",
)
TAGS = re.compile(r"<[A-Za-z/!?](?![\w.+-]*@[\w.-]+>)")


def _spec(**library: str) -> dict[str, Any]:
    return {
        "library": {"name": "Mine", **library},
        "board": "mega",
        "motors": {
            "pan": {"drive": "motor-shield", "timer": 3},
            "tilt": {"drive": {"kind": "four-wire", "pins": ["A8", "A9", "A10", "A11"]}},
        },
    }


def _generate(folder: Path, spec: dict[str, Any]) -> dict[str, str]:
    path = folder / "spec.yaml"
    with path.open("w", encoding="utf-8") as stream:
        YAML(typ="safe").dump(spec, stream)
    return api.render(path)


@pytest.mark.parametrize("path", SPECS, ids=lambda path: path.stem)
def test_the_text_of_a_library_is_clean(path: Path) -> None:
    """
    No blanks at line ends, no two empty lines in a row, one line end at the end.
    """
    for name, text in api.render(path).items():
        if name == "extras/spec.yaml":
            continue
        assert not re.search(r"[ \t]$", text, re.MULTILINE), name
        assert "\n\n\n" not in text, name
        assert text.endswith("\n"), name
        assert not text.endswith("\n\n"), name


@pytest.mark.parametrize("path", SPECS, ids=lambda path: path.stem)
def test_lines_of_code_fit_100_columns(path: Path) -> None:
    """
    Header, source and example can be read side by side.
    """
    files = api.render(path)
    long = [
        f"{name}:{number}: {line}"
        for name, text in files.items()
        if name.endswith((".h", ".cpp", ".ino"))
        for number, line in enumerate(text.splitlines(), start=1)
        if len(line) > 100
    ]

    assert long == []


@pytest.mark.parametrize("path", SPECS, ids=lambda path: path.stem)
def test_the_header_begins_with_what_is_called_first(path: Path) -> None:
    """
    Of each motor it names the init before all other functions, and the units last.
    """
    plan = api.plan(path)
    files = api.render(path)
    sections = files[f"src/{plan.library.name}.h"].split("\n// ---- ")[1:]

    assert len(sections) == len(plan.motors)
    for section, motor in zip(sections, plan.motors, strict=True):
        declared = re.findall(rf"^\w+ (?:\w+ )?{motor.name}(\w+)\(", section, re.MULTILINE)
        units = [name for name in declared if re.search("Turns|metre", name)]
        assert declared[0] in {"Init", "ShieldInit"}
        assert declared[len(declared) - len(units) :] == units


@pytest.mark.parametrize("path", SPECS, ids=lambda path: path.stem)
def test_output_tells_nothing_of_time_and_place(path: Path, tmp_path: Path) -> None:
    """
    The same spec gives the same bytes, from any folder, and none names a date or the machine.
    """
    copy = tmp_path / "elsewhere.yaml"
    copy.write_text(path.read_text(encoding="utf-8"), encoding="utf-8")
    files = api.render(path)

    assert files == api.render(copy)
    written = "\n".join(text for name, text in files.items() if name != "extras/spec.yaml")
    assert not re.search(r"\b20\d\d-\d\d-\d\d\b|\b\d\d:\d\d:\d\d\b", written)
    for place in (str(ROOT), str(Path.home()), str(tmp_path), socket.gethostname()):
        assert place not in written
    assert f"/{getpass.getuser()}/" not in written


@pytest.mark.parametrize("text", HOSTILE)
def test_hostile_metadata_stays_text(tmp_path: Path, text: str) -> None:
    """
    Author, sentence and the rest are data in every file, whatever they hold.
    """
    fields = ("author", "maintainer", "sentence", "paragraph")
    plain = _generate(tmp_path, _spec(**dict.fromkeys(fields, "plain")))
    files = _generate(tmp_path, _spec(**dict.fromkeys(fields, text)))

    assert files.keys() == plain.keys()
    _check_properties(files["library.properties"], plain["library.properties"])
    assert json.loads(files["library.json"])["authors"][0]["name"] == text.strip()
    assert _shown(files["README.md"]) == _shown(plain["README.md"])
    assert files["LICENSE"].count("\n") == plain["LICENSE"].count("\n")
    assert files["keywords.txt"] == plain["keywords.txt"]
    for name in (file for file in files if file.endswith((".h", ".cpp", ".ino"))):
        assert _code(files[name]) == _code(plain[name]), name


def _check_properties(text: str, plain: str) -> None:
    """
    Check that there is one line for each key, that the keys are those of *plain*, and no HTML.
    """
    assert not TAGS.search(text)
    lines = text.removesuffix("\n").split("\n")
    assert all(PROPERTY.fullmatch(line) for line in lines)
    assert [line.split("=")[0] for line in lines] == [
        line.split("=")[0] for line in plain.removesuffix("\n").split("\n")
    ]


def _shown(markdown: str) -> list[str]:
    """
    Return what *markdown* is made of, but for the words of its first paragraph.

    Of that remains that it is nothing but text.
    """
    tokens = MarkdownIt().enable("table").parse(markdown)
    first = next(token for token in tokens[3:] if token.type == "inline")
    assert {child.type for child in first.children or ()} == {"text"}
    return [token.type for token in tokens]


def _code(text: str) -> list[str]:
    """
    Return the lines that the compiler sees: a comment that goes on in the next line hides one.
    """
    joined = re.sub(r"(\\|\?\?/)[ \t]*\n", "", text)
    return [line for line in joined.split("\n") if line and not line.startswith("//")]


@pytest.mark.parametrize("text", HIDDEN)
def test_hidden_characters_are_refused_in_metadata(tmp_path: Path, text: str) -> None:
    """
    Text with control characters or marks that nobody sees does not even reach the doors.
    """
    with pytest.raises(StepgenError, match="which nobody sees; remove it"):
        _generate(tmp_path, _spec(author=text))


@pytest.mark.parametrize("url", ["javascript:alert(1)", "file:///etc/passwd", "https://a b", "x"])
def test_a_link_leads_to_a_page(tmp_path: Path, url: str) -> None:
    """
    The IDE opens `url` when it is clicked, so that it is http or https and nothing else.
    """
    with pytest.raises(StepgenError, match="is no address of a page; write one that begins"):
        _generate(tmp_path, _spec(url=url))
    page = "https://example.org/~ada/?a=1&b=%20#top"
    assert f"url={page}\n" in _generate(tmp_path, _spec(url=page))["library.properties"]


@pytest.mark.parametrize("text", [*HOSTILE, *HIDDEN])
def test_each_door_gives_one_harmless_line(text: str) -> None:
    """
    Each filter keeps text within its comment, its string or its line.
    """
    comment = c_comment(text)
    inside = c_string(text)

    assert not re.search(r"[\x00-\x1f\x7f]", comment + inside + properties_value(text))
    assert not TAGS.search(properties_value(text))
    assert not comment.endswith(("\\", "??/"))
    assert re.fullmatch(r'(?:[^"\\]|\\.)*', inside)
    assert "??" not in inside
    assert all(len(line) <= 97 and line == c_comment(line) for line in comment_lines(text))


def test_comments_wrap_between_words() -> None:
    """
    A sentence that is too long goes on in the next line of the comment.
    """
    assert comment_lines("word " * 20 + "end") == ("word " * 18 + "word", "word end")


def test_tidy_text() -> None:
    """
    Blanks at line ends go, empty lines come one at a time and never first or last.
    """
    assert tidy("\n\na \t\n\n\n\nb\n\n") == "a\n\nb\n"


def test_prose() -> None:
    """
    Lists and frequencies read as people write them.
    """
    assert [listed(names) for names in (["B"], ["B", "E"], ["B", "E", "H"])] == [
        "B",
        "B and E",
        "B, E and H",
    ]
    assert listed(["D9", "D10"], "or") == "D9 or D10"
    assert [frequency(hertz) for hertz in (16_000_000, 128_000, 12_500_000, 50)] == [
        "16 MHz",
        "128 kHz",
        "12.5 MHz",
        "50 Hz",
    ]

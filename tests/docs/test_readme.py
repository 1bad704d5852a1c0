"""
The README: what a newcomer sees first, short and true.
"""

from pathlib import Path

from tests.docs.pages import DOCS, ROOT, Page, run

README = Page(ROOT / "README.md")


def test_it_opens_with_the_two_commands() -> None:
    """
    The first commands that a newcomer sees are make demo and make test.
    """
    assert [command.line for command in README.commands][:2] == ["make demo", "make test"]


def test_it_is_short() -> None:
    """
    It is read to its end: 160 lines at most; what is longer has a page in docs/.
    """
    assert len(README.text.splitlines()) <= 160


def test_its_picture_is_what_the_command_draws(tmp_path: Path) -> None:
    """
    docs/first_run.svg is, byte for byte, what the README's simulation draws.
    """
    tree = README.lay_out(tmp_path)
    (picture,) = DOCS.glob("*.svg")
    lines = [one.line for one in README.commands if one.line.startswith("stepgen init")]
    lines += [one.line for one in README.commands if one.line.endswith(f"--plot {picture.name}")]

    for line in lines:
        assert run(line, tree).returncode == 0

    assert len(lines) == 2
    assert (tree / picture.name).read_bytes() == picture.read_bytes()
    assert f"](docs/{picture.name})" in README.text

"""
Every page: commands run, specs can be planned, sketches compile, links lead somewhere.
"""

import doctest
import re
from pathlib import Path

import pytest

from stepgen import api
from stepgen.verify.toolchain import Target, build, default_compiler
from tests.docs.pages import NAMED_ONLY, ROOT, Page, all_pages, run

PAGES = all_pages()
OTHERS = [
    Page(ROOT / name)
    for name in ("CONTRIBUTING.md", "SECURITY.md", "CHANGELOG.md", "specs/refused/README.md")
]
by_name = pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)


@pytest.mark.parametrize(
    "page", [page for page in PAGES if page.blocks("console")], ids=lambda page: page.name
)
def test_every_command_runs_and_prints_what_is_shown(page: Page, tmp_path: Path) -> None:
    """
    The console blocks of a page, run in their order in one folder, are the truth.
    """
    tree = page.lay_out(tmp_path)

    for command in page.commands:
        if command.line.startswith(NAMED_ONLY):
            continue
        done = run(command.line, tree)
        assert done.returncode == (2 if command.is_refused else 0), (command.line, done.stdout)
        assert command.shows(done.stdout), (command.line, done.stdout)


@by_name
def test_every_spec_can_be_planned(page: Page, tmp_path: Path) -> None:
    """
    Each YAML block with a library is a whole spec that stepgen accepts.
    """
    tree = page.lay_out(tmp_path)

    for name in page.specs:
        assert api.plan(tree / name).motors


def sketches() -> list[tuple[Page, str]]:
    """
    Return the C++ blocks that are whole sketches, with their pages.
    """
    return [(page, text) for page in PAGES for text in page.blocks("cpp") if "#include" in text]


@pytest.mark.parametrize(("page", "sketch"), sketches(), ids=lambda part: getattr(part, "name", ""))
def test_every_sketch_compiles(page: Page, sketch: str, tmp_path: Path) -> None:
    """
    Each sketch builds without a warning against the library of that name: of its page, or `init`'s.
    """
    tree = page.lay_out(tmp_path)
    api.init(api.Draft(), tree / "first.yaml")
    (library,) = re.findall(r"#include <(\w+)\.h>", sketch)
    (spec,) = (
        tree / name
        for name in (*page.specs, "first.yaml")
        if api.load(tree / name).spec.library.name == library
    )
    api.generate(spec, tree)
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


@by_name
def test_every_declaration_is_that_of_a_header(page: Page, tmp_path: Path) -> None:
    """
    C++ that is no sketch stands in the header of a spec of the same page, but for line breaks.
    """
    tree = page.lay_out(tmp_path)
    declared = [block for block in page.blocks("cpp") if "#include" not in block]
    headers = [
        _one_line(text)
        for name in page.specs
        if declared
        for path, text in api.render(tree / name).items()
        if path.endswith(".h")
    ]

    for block in declared:
        parts = [_one_line(part) for part in block.split(";")]
        assert any(all(part in header for part in parts) for header in headers), block


def _one_line(code: str) -> str:
    """
    Return *code* without its line breaks and the spaces around them.
    """
    return " ".join(code.split()).replace("( ", "(")


@pytest.mark.parametrize("page", [*PAGES, *OTHERS], ids=lambda page: page.name)
def test_every_link_leads_somewhere(page: Page) -> None:
    """
    Each link within the project names a file that is there, and a heading of it.
    """
    for file, anchor in page.links:
        assert file.resolve().exists(), file
        assert not anchor or anchor in Page(file.resolve()).anchors, (file, anchor)


@pytest.mark.parametrize("page", [*PAGES, *OTHERS], ids=lambda page: page.name)
def test_every_row_of_a_table_has_its_cells(page: Page) -> None:
    """
    As many as the heading: a bar within a cell would have to be escaped.
    """
    for heading, *rows in page.tables:
        assert {len(row) for row in rows} <= {len(heading)}, heading


def test_every_page_is_reached_from_the_index() -> None:
    """
    From README.md each page of docs/ can be reached by links, and from docs/README.md as well.
    """
    for start in (ROOT / "README.md", ROOT / "docs" / "README.md"):
        seen, ahead = set(), [start]
        while ahead:
            path = ahead.pop()
            if path not in seen and path.suffix == ".md":
                seen.add(path)
                ahead += [file.resolve() for file, _ in Page(path).links]
        assert {page.path for page in PAGES} <= seen


@pytest.mark.parametrize(
    "page", [page for page in PAGES if page.blocks("pycon")], ids=lambda page: page.name
)
def test_every_python_example_gives_what_is_shown(
    page: Page, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """
    The Python sessions of a page, run in their order in one folder, are the truth.
    """
    monkeypatch.chdir(page.lay_out(tmp_path))
    session = "\n".join(page.blocks("pycon"))
    parsed = doctest.DocTestParser().get_doctest(session, {}, page.name, page.name, 0)
    printed: list[str] = []

    doctest.DocTestRunner(optionflags=doctest.ELLIPSIS).run(parsed, out=printed.append)

    assert parsed.examples
    assert printed == []


def test_the_make_targets_that_documents_name_exist(tmp_path: Path) -> None:
    """
    `make -n` knows each target that a document mentions.
    """
    tree = PAGES[0].lay_out(tmp_path)
    texts = "".join(page.text for page in (*PAGES, *OTHERS))
    targets = set(re.findall(r"(?:`|\$ )make ([a-z]+)", texts))

    assert {"demo", "test"} <= targets
    for target in sorted(targets):
        done = run(f"make -n {target}", tree)
        assert done.returncode == 0, done.stdout

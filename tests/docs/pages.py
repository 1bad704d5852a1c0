"""
The pages of the documentation: their blocks, commands, files, tables and links.
"""

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from stepgen.verify.cache import cache_dir

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"

# Commands that set up, need hours or are tested elsewhere: here only that they exist.
NAMED_ONLY = ("make ", ". .venv/bin/activate", "stepgen matrix")


@dataclass(frozen=True)
class Command:
    """
    A command of a console block, and the output that the page shows below it.
    """

    line: str
    shown: str

    @property
    def is_refused(self) -> bool:
        """
        Tell whether the page shows an error, for which the exit code is 2.
        """
        return "error: " in self.shown

    def shows(self, output: str) -> bool:
        """
        Tell whether *output* is what the page shows, in which ``...`` stands for any lines.

        Spaces at the ends of lines count for nothing.
        """
        stripped = "".join(f"{line.rstrip()}\n" for line in output.splitlines())
        parts = (re.escape(part) for part in re.split(r"^\.\.\.\n", self.shown, flags=re.MULTILINE))
        return not self.shown or re.fullmatch(r"(?s:.*)".join(parts), stripped) is not None


@dataclass(frozen=True)
class Page:
    """
    One Markdown file.
    """

    path: Path

    @property
    def name(self) -> str:
        """
        Return its path in the checkout.
        """
        return self.path.relative_to(ROOT).as_posix()

    @cached_property
    def text(self) -> str:
        """
        Return what it holds.
        """
        return self.path.read_text(encoding="utf-8")

    def blocks(self, language: str) -> list[str]:
        """
        Return its fenced blocks of *language*, in their order.
        """
        return re.findall(rf"^```{language}\n(.*?)^```$", self.text, re.MULTILINE | re.DOTALL)

    @property
    def commands(self) -> Iterator[Command]:
        """
        Yield the commands of its console blocks, in their order.
        """
        for block in self.blocks("console"):
            for entry in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
                line, _, shown = entry.partition("\n")
                yield Command(line, shown)

    @property
    def files(self) -> dict[str, str]:
        """
        Return its YAML files: name, from the first line -> text.
        """
        return {block.split()[1]: block for block in self.blocks("yaml")}

    @property
    def specs(self) -> list[str]:
        """
        Return the names of those files that are specs; the others are scenarios.
        """
        return [name for name, text in self.files.items() if "\nlibrary:" in text]

    @property
    def tables(self) -> list[list[list[str]]]:
        """
        Return the cells of its tables, row by row; the first row is the heading.
        """
        found: list[list[list[str]]] = []
        before = ""
        for line in self.text.splitlines():
            if line.startswith("|"):
                if not before.startswith("|"):
                    found.append([])
                cells = re.split(r"(?<!\\)\|", line)[1:-1]
                if set(line) - set("|- "):
                    found[-1].append([cell.strip() for cell in cells])
            before = line
        return found

    def table(self, *heading: str) -> list[list[str]]:
        """
        Return the rows of its tables that have this *heading*.
        """
        return [row for table in self.tables if table[0] == list(heading) for row in table[1:]]

    @property
    def links(self) -> Iterator[tuple[Path, str]]:
        """
        Yield the file and the anchor, or "", of each link to something of this project.
        """
        text = re.sub(r"^```.*?^```$", "", self.text, flags=re.MULTILINE | re.DOTALL)
        for target in re.findall(r"\]\(([^)\s]+)\)", text):
            if not target.startswith(("http://", "https://")):
                file, _, anchor = target.partition("#")
                yield (self.path.parent / file if file else self.path), anchor

    @property
    def anchors(self) -> set[str]:
        """
        Return the anchors of its headings, as GitHub makes them.
        """
        headings = re.findall(r"^#+ (.*)$", self.text, re.MULTILINE)
        words = (re.sub(r"[^\w\- ]", "", heading.lower()) for heading in headings)
        return {text.strip().replace(" ", "-") for text in words}

    def lay_out(self, folder: Path) -> Path:
        """
        Return a folder like a checkout's, with this page's files in it.
        """
        tree = folder / "stepgen"
        shutil.copytree(ROOT / "specs", tree / "specs")
        for name in ("Makefile", "pyproject.toml"):
            shutil.copy(ROOT / name, tree)
        for name, text in self.files.items():
            (tree / name).write_text(text, encoding="utf-8")
        (folder / "Arduino" / "libraries").mkdir(parents=True)
        return tree


def all_pages() -> list[Page]:
    """
    Return the README and every page of docs/.
    """
    return [Page(ROOT / "README.md"), *(Page(path) for path in sorted(DOCS.rglob("*.md")))]


def run(line: str, tree: Path) -> subprocess.CompletedProcess[str]:
    """
    Run the command *line* in *tree*, whose parent is the user's home; both streams are stdout.

    Nothing is typed, and a terminal would be 100 columns wide. The cache is that of all tests.
    """
    environment = os.environ | {
        "HOME": str(tree.parent),
        "STEPGEN_CACHE": str(cache_dir()),
        "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
        "COLUMNS": "100",
    }
    return subprocess.run(
        ["bash", "-c", line],
        cwd=tree,
        env=environment,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        check=False,
        encoding="utf-8",
        timeout=300,
    )

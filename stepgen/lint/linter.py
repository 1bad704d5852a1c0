"""
Checking a folder against every rule.
"""

from dataclasses import dataclass
from pathlib import Path

from stepgen.lint.documents import DOCUMENTS
from stepgen.lint.folder import read_folder
from stepgen.lint.library import read_library
from stepgen.lint.properties import METADATA
from stepgen.lint.rules import Finding, Rule
from stepgen.lint.structure import STRUCTURE

RULES: tuple[Rule, ...] = tuple(
    sorted((*STRUCTURE.rules, *METADATA.rules, *DOCUMENTS.rules), key=lambda rule: rule.name)
)
NOT_CHECKED = (
    ("LP017", "whether another library of the library manager has this name"),
    ("LP022", "whether a Git tag is newer than the version"),
    ("LP033, LP035", "the spelling of sentence and paragraph"),
    ("LP042", "whether the url answers"),
    ("LP048", "whether the library manager knows what depends names"),
)
"""What takes a network, a repository or a dictionary."""


@dataclass(frozen=True)
class LintReport:
    """
    What is wrong with a library folder, in the order of its files; nothing if it is fine.
    """

    path: Path
    findings: tuple[Finding, ...]


def lint(path: Path) -> LintReport:
    """
    Check the library folder *path* against every rule.

    Raises:
        StepgenError: It is no folder, or cannot be read.
    """
    library = read_library(read_folder(path))
    findings = {
        Finding(place, rule.name, reason, rule.fix)
        for rule in RULES
        for place, reason in rule.check(library)
    }
    return LintReport(path, tuple(sorted(findings)))

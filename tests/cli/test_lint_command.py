"""
``stepgen lint`` as users run it.
"""

from collections.abc import Callable
from pathlib import Path
from typing import Any

Stepgen = Callable[..., Any]


def test_a_fresh_library_is_fine(stepgen: Stepgen, pan: Path) -> None:
    """
    What was generated a moment ago breaks no rule; what only a network can tell is named.
    """
    stepgen("generate", pan)

    run = stepgen("lint", "Pan")

    assert run.code == 0
    assert "Pan: fine" in run.out
    assert "not checked: LP042: whether the url answers" in run.out


def test_findings_name_place_rule_and_fix(stepgen: Stepgen, pan: Path, tmp_path: Path) -> None:
    """
    The exit code is 1, and each finding is one line like a compiler's.
    """
    stepgen("generate", pan)
    (tmp_path / "Pan" / "LICENSE").unlink()

    run = stepgen("lint", "Pan")

    assert run.code == 1
    assert run.err == "Pan: LD002: there is no LICENSE; add a LICENSE file\n"


def test_no_folder_is_wrong_use(stepgen: Stepgen, pan: Path) -> None:
    """
    A file, a folder that is not there, and no folder at all end with exit code 2.
    """
    for arguments in ([pan], ["nowhere"], []):
        assert stepgen("lint", *arguments).code == 2


def test_the_rules_are_listed(stepgen: Stepgen) -> None:
    """
    Each rule has its name, what it demands and how to mend it.
    """
    run = stepgen("lint", "--rules")

    assert run.code == 0
    assert "LP020" in run.out

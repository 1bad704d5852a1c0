"""
`stepgen datasheet` writes one page, as the library has it or with what a verification found.
"""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from stepgen import api

Stepgen = Callable[..., Any]


def test_the_page_is_that_of_the_library(stepgen: Stepgen, pan: Path, tmp_path: Path) -> None:
    """
    Without more it is called like the library and has the same bytes as extras/datasheet.html.
    """
    run = stepgen("datasheet", pan.name)

    assert (run.code, run.out) == (0, "Pan.html: written\n")
    written = (tmp_path / "Pan.html").read_text(encoding="utf-8")
    assert written == api.render(pan)["extras/datasheet.html"]


def test_it_goes_where_output_says(stepgen: Stepgen, pan: Path, tmp_path: Path) -> None:
    """
    A page that is there already is replaced.
    """
    (tmp_path / "page.html").write_text("old", encoding="utf-8")
    run = stepgen("datasheet", pan.name, "--output", "page.html")

    assert run.code == 0
    assert (tmp_path / "page.html").read_text(encoding="utf-8").startswith("<!DOCTYPE html>")


def test_a_spec_that_is_refused_gets_no_page(stepgen: Stepgen, tmp_path: Path) -> None:
    """
    Exit code 2 and the fault; nothing is written.
    """
    (tmp_path / "wrong.yaml").write_text("library: L\nboard: uno\nmotors: {}\n", encoding="utf-8")
    run = stepgen("datasheet", "wrong.yaml")

    assert run.code == 2
    assert "wrong.yaml:3" in run.err
    assert not list(tmp_path.glob("*.html"))


def test_a_failed_verification_is_on_the_page(stepgen: Stepgen, pan: Path, tmp_path: Path) -> None:
    """
    A budget that the step interrupt cannot keep: exit code 1, and the page says what failed.
    """
    text = pan.read_text(encoding="utf-8")
    pan.write_text(text.replace("timer: 1", "timer: 1, budget: {isr_cycles: 100}"), "utf-8")
    run = stepgen("datasheet", pan.name, "--verify")
    page = (tmp_path / "Pan.html").read_text(encoding="utf-8")

    assert run.code == 1
    assert "FAILED: 1 of " in page
    assert "over the budget of 100" in page
    assert "not verified" not in page

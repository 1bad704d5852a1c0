"""
The datasheet printed by Chromium: two sheets of A4 at most, however many motors, that can be read.
"""

from math import prod, sqrt
from pathlib import Path
from typing import Any
from unicodedata import normalize

import pytest
from pypdf import PageObject, PdfReader

from stepgen import api
from tests.datasheet.browser import chromium
from tests.datasheet.large import LARGE, large
from tests.datasheet.pages import ROOT, SPECS, page, report_of, spec

GENERATED = sorted((ROOT / "generated").glob("*/extras/datasheet.html"))
A4_POINTS = (595, 842)
MOST_PAGES = 2
LEAST_POINTS = 7.0  # of any letter, those in pictures too
LEAST_POINTS_OF_FEW = 7.1  # of one motor or two
ROUNDING = 0.02


def printed(folder: Path, text: str) -> list[PageObject]:
    """
    Return the pages that Chromium prints of *text*; all are A4.
    """
    paper = folder / "page.pdf"
    chromium(folder, text, f"--print-to-pdf={paper}", "--no-pdf-header-footer")
    pages = list(PdfReader(paper).pages)
    for one in pages:
        width, height = one.mediabox.width, one.mediabox.height
        assert (round(width), round(height)) == A4_POINTS
    return pages


def smallest_points(pages: list[PageObject]) -> float:
    """
    Return the size of the smallest letters on *pages*, as they come out on paper.
    """
    sizes: list[float] = []

    def note(text: str, cm: list[float], tm: list[float], _font: Any, size: float) -> None:  # noqa: ANN401
        if text.strip():
            areas = (abs(a * d - b * c) for a, b, c, d, _, _ in (cm, tm))
            sizes.append(size * float(sqrt(prod(areas))))

    for one in pages:
        one.extract_text(visitor_text=note)
    return min(sizes)


def words_of(one: PageObject) -> str:
    """
    Return the text of a page, without ligatures.
    """
    return normalize("NFKC", one.extract_text())


@pytest.mark.parametrize("path", GENERATED, ids=lambda path: path.parents[1].name)
def test_every_library_prints_on_two_pages(tmp_path: Path, path: Path) -> None:
    """
    The page that is in the library takes two sheets at most, and begins with the wiring.
    """
    pages = printed(tmp_path, path.read_text(encoding="utf-8"))

    assert len(pages) <= MOST_PAGES
    assert smallest_points(pages) > LEAST_POINTS - ROUNDING
    assert "Wiring" in words_of(pages[0])


@pytest.mark.parametrize("path", SPECS, ids=lambda path: path.stem)
def test_a_verification_leaves_it_at_two_pages(tmp_path: Path, path: Path) -> None:
    """
    So does the page with all that a verification adds.
    """
    pages = printed(tmp_path, page(path, report_of(api.plan(path))))

    assert len(pages) <= MOST_PAGES
    assert "checks passed" in words_of(pages[-1])


@pytest.mark.parametrize("name", LARGE)
@pytest.mark.parametrize("verified", [False, True], ids=["plain", "verified"])
def test_many_motors_print_on_two_pages(tmp_path: Path, name: str, *, verified: bool) -> None:
    """
    Six motors of every kind do, and twelve, one on each compare channel of a Mega's 16-bit timers.
    """
    path = large(name, tmp_path)
    report = report_of(api.plan(path)) if verified else None
    pages = printed(tmp_path, page(path, report))

    assert len(pages) <= MOST_PAGES
    assert smallest_points(pages) > LEAST_POINTS - ROUNDING
    assert "Verification" in words_of(pages[-1])


def test_one_motor_is_printed_larger(tmp_path: Path) -> None:
    """
    There is room for larger type where there is little to tell.
    """
    pages = printed(tmp_path, page(spec("uno_motor_shield")))

    assert smallest_points(pages) > LEAST_POINTS_OF_FEW


def test_small_type_is_noticed(tmp_path: Path) -> None:
    """
    The measure itself can fail: a text of five points, and a drawing that is shrunk to half.
    """
    text = page(spec("uno_motor_shield"))
    small = text.replace("</header>", '<p style="font-size: 5pt">small</p></header>')
    shrunk = text.replace("</style>", "@media print { .wiring { width: 351px } }</style>")

    assert smallest_points(printed(tmp_path, small)) == pytest.approx(5, abs=ROUNDING)
    assert 3 < smallest_points(printed(tmp_path, shrunk)) < 5

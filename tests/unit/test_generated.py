"""
The checked-in libraries: each spec has one, none is stale, none is left over.
"""

from pathlib import Path

import pytest

from stepgen import api

ROOT = Path(__file__).resolve().parents[2]
GENERATED = ROOT / "generated"
SPECS = sorted((ROOT / "specs").glob("*.yaml"))


@pytest.mark.parametrize("path", SPECS, ids=lambda path: path.stem)
def test_a_spec_has_a_fresh_library(path: Path) -> None:
    """
    What is checked in is what a run of today writes; `stepgen generate` mends it.
    """
    found = api.stale(path, GENERATED)

    assert list(found.values()) == [[]]


def test_no_library_is_left_over() -> None:
    """
    Everything in generated/ is the library of a spec.
    """
    names = {api.load(path).spec.library.name for path in SPECS}
    found = {path.name for path in GENERATED.iterdir() if not path.name.startswith(".")}

    assert found == names

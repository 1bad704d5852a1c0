"""
What the library of two stacked shields with common enables says and has, and no other has.
"""

from pathlib import Path

import pytest

from stepgen import api

SPECS = sorted((Path(__file__).resolve().parents[2] / "specs").glob("*.yaml"))
SHARING = [path for path in SPECS if "stacked" in path.stem or "cnc" in path.stem]
STACKED = [path for path in SPECS if path.stem.startswith("mega_stacked_shields")]
WARNING = (
    "as long as one of these motors needs current, the coils of all have it, also those of one "
    "that was released."
)


def _source(path: Path, ending: str) -> str:
    (text,) = (text for name, text in api.render(path).items() if name.endswith(ending))
    return text


def _prose(text: str) -> str:
    return " ".join(text.replace("//", " ").split())


@pytest.mark.parametrize("path", STACKED, ids=lambda path: path.stem)
def test_the_header_warns_of_current_in_a_released_motor(path: Path) -> None:
    """
    For each of the two motors: with its wiring, and where it is released.
    """
    header = _prose(_source(path, ".h"))

    for motor, other in (("lower", "upper"), ("upper", "lower")):
        assert f"D3 and D11 are the enables for {other} too: {WARNING}" in header
        release = header[: header.index(f"int8_t {motor}Release();")]
        assert release.endswith(
            f"so that the shaft turns freely, unless {other} needs the current. "
            "Returns 0, or MOTOR_ERROR_RUNNING. "
        )


@pytest.mark.parametrize("path", STACKED, ids=lambda path: path.stem)
def test_the_readme_warns_and_initialises_both(path: Path) -> None:
    """
    A first sketch with one of the motors gives the other one's wires a level too.
    """
    readme = _source(path, "README.md")

    assert f"D3 and D11 are the enables for lower and upper: {WARNING}" in readme
    assert readme.count("  lowerShieldInit();") == readme.count("  upperShieldInit();") == 2


@pytest.mark.parametrize("path", sorted({*SPECS} - {*SHARING}), ids=lambda path: path.stem)
def test_enables_of_its_own_cost_nothing(path: Path) -> None:
    """
    Where no enables are shared nobody asks who needs them.
    """
    files = api.render(path).values()

    assert not any("enablesNeeded" in text or "needs the current" in text for text in files)

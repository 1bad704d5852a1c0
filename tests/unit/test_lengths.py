"""
Metric units: what the functions of a motor that has steps per millimetre compute.
"""

import re
from fractions import Fraction
from pathlib import Path

import pytest

from stepgen import api

SPEC = """
library: Mine
board: {board}
motors:
  z:
    drive: {{kind: step-dir, driver: a4988, step: D2, dir: D5, enable: D8}}
    steps_per_mm: {steps}
"""


def _files(folder: Path, steps: str, board: str = "uno") -> dict[str, str]:
    path = folder / "spec.yaml"
    path.write_text(SPEC.format(steps=steps, board=board), encoding="utf-8")
    return api.render(path)


def _body(text: str, name: str) -> str:
    start = text.index("return ", text.index(f"{name}(")) + len("return ")
    return text[start : text.index(";", start)]


def _value(expression: str, **values: int) -> int:
    """
    Return what a body computes, in Python's integers.
    """
    for old, new in (
        ("motorTimerGetIOclocksPerSecond()", "clocks"),
        ("zReadPosition()", "position"),
        ("static_cast<uint32_t>", ""),
        ("static_cast<int32_t>", ""),
        ("ULL", ""),
        ("UL", ""),
        ("LL", ""),
        ("/", "//"),
    ):
        expression = expression.replace(old, new)
    result = eval(expression, {}, values)  # noqa: S307 - an expression of our own
    assert isinstance(result, int)
    return result


def _top(source: str, speed: int) -> int:
    """
    Return what the function for a speed returns, in Python's integers.
    """
    body = source[source.index("zTimerCalcNanometresPerSecond(") :]
    body = body[: body.index("}")]
    found = re.search(r"top = ([^;]+);", body)
    assert found
    top = _value(found[1], clocks=16_000_000, speed=speed)
    if "return top ? top : 1;" in body:
        top = top or 1
    return min(top, 0xFFFF_FFFF) if "UINT32_MAX" in body else top


@pytest.mark.parametrize("steps", ["4000", "80", "3200/7", "157.48", "1"])
def test_the_functions_are_the_exact_ratio_cut_off(tmp_path: Path, steps: str) -> None:
    """
    Speed, way and position against exact fractions; a way is rounded, the others are cut off.
    """
    files = _files(tmp_path, steps)
    header, source = files["src/Mine.h"], files["src/Mine.cpp"]
    per_mm = Fraction(steps)

    for speed in (1, 46, 500, 12_345, 3_000_000, 4_100_000_000):
        exact = 16_000_000 * 1_000_000 / per_mm / speed // 1
        assert _top(source, speed) == max(1, min(exact, 0xFFFF_FFFF))
    for way in (1, 999, 1_000, 123_456):
        made = _value(_body(header, "zStepsForMicrometres"), micrometres=way)
        assert abs(made - way * per_mm / 1000) <= Fraction(1, 2)
    for position in (0, 1, 4_000, 8_000_000):
        read = _value(_body(source, "zReadNanometres"), position=position)
        assert read == position * 1_000_000 / per_mm // 1


def test_32_bits_are_taken_where_they_do(tmp_path: Path) -> None:
    """
    16 MHz times 250 nm are 4 * 10^9, below 2^32; times 269 they are more.
    """
    assert "ULL" not in _files(tmp_path, "4000")["src/Mine.cpp"]
    assert "ULL" in _files(tmp_path, "1000000/269")["src/Mine.cpp"]


def test_the_header_says_how_far_the_position_goes(tmp_path: Path) -> None:
    """
    2^31 nm are 2147.48 mm.
    """
    header = _files(tmp_path, "4000")["src/Mine.h"]

    assert "2147.48 mm either way" in " ".join(header.replace("//", " ").split())


def test_a_motor_without_millimetres_has_no_such_functions() -> None:
    """
    What a spec does not use does not exist in its library.
    """
    spec = Path(__file__).resolve().parents[2] / "specs" / "uno_cnc_shield.yaml"

    assert not any("metres" in text for text in api.render(spec).values())


@pytest.mark.parametrize("steps", ["157.480", "999999.999", "20000/127", "0.001", "1000000/7"])
def test_no_product_overflows(tmp_path: Path, steps: str) -> None:
    """
    With three digits behind the point all that 32 bits can ask for stays below 2^63.
    """
    files = _files(tmp_path, steps)
    body = files["src/Mine.cpp"] + files["src/Mine.h"]
    factors = [int(found) for found in re.findall(r"(\d+)U?LL", body)]

    assert factors
    assert all(factor << 31 < 1 << 63 for factor in factors)

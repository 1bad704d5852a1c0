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


AXIS = """
library: Mine
board: uno
motors:
  z:
    drive: {{kind: step-dir, driver: a4988, step: D2, dir: D5, enable: D8}}
    timing: {{kind: compare, timer: 1}}
    motion: {{kind: trapezoid, cruise_speed: {cruise}, acceleration: {acceleration}}}
    steps_per_mm: {steps}
    steps_per_turn: 200
"""


def _axis(folder: Path, steps: str, cruise: str = "10 mm/s", more: str = "100 mm/s^2") -> Path:
    path = folder / "spec.yaml"
    path.write_text(AXIS.format(cruise=cruise, acceleration=more, steps=steps), encoding="utf-8")
    return path


@pytest.mark.parametrize("steps", ["400", "80", "3200/7", "157.48", "1000"])
def test_ways_of_an_axis_go_both_ways(tmp_path: Path, steps: str) -> None:
    """
    A way is rounded to the nearest step, forward and backward alike.
    """
    header = api.render(_axis(tmp_path, steps))["src/Mine.h"]
    body = _body(header, "int32_t zStepsForMicrometres").replace("L", "")
    plain = r"static_cast<int32_t>\(static_cast<uint32_t>\(micrometres\) \* (\d+)U\)"
    per_um = Fraction(steps) / 1000
    found = re.fullmatch(plain, body) or re.fullmatch(
        r"static_cast<int32_t>\(\(micrometres \* (\d+) \+ \(micrometres < 0 \? -(\d+) : \2\)\) / "
        r"(\d+)\)",
        body,
    )
    assert found, body
    number, half, divisor = (int(part) for part in (*found.groups("1"), "0", "1")[:3])

    for way in (1, 7, 999, 123_456):
        made = (way * number + (half if divisor > 1 else 0)) // divisor  # C cuts off towards 0
        assert abs(made - way * per_um) <= Fraction(1, 2)


@pytest.mark.parametrize("steps", ["400", "80", "3200/7", "157.48", "1000"])
def test_the_interval_of_an_axis_is_the_exact_ratio_cut_off(tmp_path: Path, steps: str) -> None:
    """
    In 1/256 clocks, so that the speed of the spec itself is not refused as too fast.
    """
    source = api.render(_axis(tmp_path, steps))["src/Mine.cpp"]
    body = source[source.index("zIntervalForNanometresPerSecond(") :]
    body = body[: body.index("}")]
    found = re.search(r"interval = (\d+)ULL / (?:speed|\((\d+)ULL \* speed\));", body)
    cruise = re.search(r"kZCruiseInterval = (\d+)UL;", source)
    assert found
    assert cruise

    for speed in (1, 46, 12_345, 3_000_000, 10_000_000):
        made = int(found[1]) // (int(found[2] or 1) * speed)
        assert made == 256 * 16_000_000 * 1_000_000 / Fraction(steps) / speed // 1
    assert made == int(cruise[1])
    assert int(found[1]) < 1 << 64
    assert "interval < UINT32_MAX ? interval : UINT32_MAX" in body


@pytest.mark.parametrize(
    ("cruise", "more", "sps", "acceleration"),
    [
        ("4000", "8000", 4000, 8000),
        ("10 mm/s", "100 mm/s^2", 4000, 40_000),
        ("360 deg/s", "2 turns/s^2", 200, 400),
        ("1.5 turns/s", "90 deg/s^2", 300, 50),
        ("2000/127 mm/s", "8000 steps/s^2", Fraction(800_000, 127), 8000),
    ],
)
def test_a_spec_may_name_speeds_in_the_units_of_the_axis(
    tmp_path: Path, cruise: str, more: str, sps: Fraction, acceleration: Fraction
) -> None:
    """
    400 steps are a millimetre, 200 a turn; every unit is kept exactly.
    """
    (motor,) = api.plan(_axis(tmp_path, "400", cruise, more)).motors

    assert motor.motion.cruise_interval_256 == 16_000_000 * 256 // sps
    assert motor.motion.ladder
    assert motor.motion.ladder.speeds.acceleration == acceleration

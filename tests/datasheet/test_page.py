"""
The datasheet as text: all that the plan says is there, unchanged, and nothing else.
"""

import json
import re
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

from stepgen import api
from stepgen.datasheet.chart import motion_charts
from stepgen.datasheet.page import PATH, render_datasheet
from stepgen.datasheet.tagged import WIDEST
from stepgen.datasheet.wiring import wiring_scene
from stepgen.devices import Board, boards
from stepgen.devices.outlines import OUTLINES, Outline, outline_of
from stepgen.plan.model import Plan
from tests.datasheet.large import LARGE, large
from tests.datasheet.pages import SPECS, Reader, ends_of, page, report_of, spec, words

MOST_BYTES = 50_000
LONGEST_TAG = 16  # letters
HOSTILE = (
    "</style><script>alert(1)</script>",
    '"\' onload=alert(1) x="',
    "{{ page.name }} %% for x in y",
    "<b>&amp;</b> ]]> --> <!--",
    "long and \u00fcber " * 30,
)


@pytest.mark.parametrize("path", SPECS, ids=lambda path: path.stem)
def test_every_library_has_its_page(path: Path, tmp_path: Path) -> None:
    """
    The page in a library is the page of its spec, wherever that lies; it is small and complete.
    """
    copy = tmp_path / "elsewhere.yaml"
    copy.write_text(path.read_text(encoding="utf-8"), encoding="utf-8")
    text = api.render(path)[PATH]

    assert text == page(copy) == api.datasheet(path)
    assert len(text.encode()) < MOST_BYTES
    assert not re.search(r"<script|<link|<img|@import|url\(|\bsrc=|https?:|file:", text)


@pytest.mark.parametrize("path", SPECS, ids=lambda path: path.stem)
def test_every_wire_is_drawn_from_its_pin_to_the_driver(path: Path) -> None:
    """
    Each has a line that begins at its pin and ends at the left edge of a driver, or of switches.
    """
    plan = api.plan(path)
    scene = wiring_scene(plan)
    pins = {(dot.title, dot.x, dot.y) for dot in scene.dots}
    edges = [float(box.d[1:].split()[0]) for box in scene.strokes if box.css == "driver"]
    lines = {stroke.title: stroke.d for stroke in scene.strokes if "wire" in stroke.css.split()}

    assert len(edges) == len(plan.motors)
    for motor in plan.motors:
        for signal, pin in ends_of(motor):
            title = f"motor {motor.name}, {signal}: {pin.label} ({pin.bit.name})"
            way = lines[title]
            start = re.match(r"M([\d.]+) ([\d.]+)", way)
            assert start
            assert (title, start[1], start[2]) in pins
            assert float(way.rpartition("H")[2]) == edges[0]
            assert title in Reader(page(path)).titles


@pytest.mark.parametrize("name", sorted(LARGE.keys() - {"switches"}))
def test_each_pin_of_many_bears_a_tag(name: str, tmp_path: Path) -> None:
    """
    Where wires would be too many to draw, a tag at the end of each names motor and signal.

    If a name is long, motors have numbers there, and in the tables. Each kind of driver is drawn.
    """
    plan = api.plan(large(name, tmp_path))
    scene = wiring_scene(plan)
    tags = {label.text for label in scene.labels if label.css.startswith("on-tag")}
    titles = {stroke.title for stroke in scene.strokes if stroke.css.startswith("wire ")}
    pins = {dot.title for dot in scene.dots if dot.css.startswith("pin ")}
    names = [f"{motor.name} {end[0]}" for motor in plan.motors for end in ends_of(motor)]
    is_long = max(map(len, names)) > LONGEST_TAG
    ends = [
        (f"{number}:" if is_long else motor.name, motor.name, *end)
        for number, motor in enumerate(plan.motors, 1)
        for end in ends_of(motor)
    ]

    assert tags == {f"{tag} {signal}" for tag, _, signal, _ in ends}
    wanted = {f"motor {m}, {signal}: {pin.label} ({pin.bit.name})" for _, m, signal, pin in ends}
    assert titles == pins == wanted
    drivers = {motor.drive.title for motor in plan.motors}
    assert drivers <= {label.text for label in scene.labels}
    assert float(scene.width) <= WIDEST


@pytest.mark.parametrize("path", SPECS, ids=lambda path: path.stem)
def test_no_two_wires_lie_on_each_other(path: Path) -> None:
    """
    Lines may cross, but none runs along another, unless both come from one pin.
    """
    used: dict[tuple[str, str], list[tuple[float, float, str]]] = {}
    for stroke in wiring_scene(api.plan(path)).strokes:
        if "wire" not in stroke.css.split():
            continue
        pin = stroke.title.rpartition(": ")[2]
        x, y = map(float, stroke.d[1:].split("H")[0].split("V")[0].split())
        for turn, end in re.findall(r"([HV])([\d.]+)", stroke.d):
            along, across = (x, y) if turn == "H" else (y, x)
            low, high = sorted((along, float(end)))
            for other_low, other_high, other in used.get((turn, f"{across:g}"), []):
                assert other == pin or high <= other_low or other_high <= low, stroke.title
            used.setdefault((turn, f"{across:g}"), []).append((low, high, pin))
            x, y = (float(end), y) if turn == "H" else (x, float(end))


@pytest.mark.parametrize("board", boards(), ids=lambda board: board.name)
def test_every_board_can_be_drawn(board: Board) -> None:
    """
    A board has one outline, each of its pins is on it once, and ground is there.
    """
    labels = [place.label for place in outline_of(board).places()]

    assert sum(board.name in outline.boards for outline in OUTLINES) == 1
    assert "GND" in labels
    assert [labels.count(pin.label) for pin in board.pins] == [1] * len(board.pins)


@pytest.mark.parametrize("outline", OUTLINES, ids=lambda outline: outline.boards[0])
def test_pins_lie_on_the_board(outline: Outline) -> None:
    """
    No pin is beside the board, and none on another.
    """
    places = [(place.x, place.y) for place in outline.places()]

    assert all(0 < x < outline.width and 0 < y < outline.height for x, y in places)
    assert len(set(places)) == len(places)


def test_the_headers_of_an_uno_are_where_its_shields_have_them() -> None:
    """
    Pin 7 and pin 8 are 160 mil apart, A5 and pin 0 stand above each other, 1900 mil apart.

    Source: Arduino's drawing of the Uno Rev3.
    """
    places = {place.label: place for place in OUTLINES[0].places()}

    assert places["D7"].x - places["D8"].x == 160
    assert (places["A5"].x, places["A5"].y - places["D0"].y) == (places["D0"].x, 1900)


def test_a_drive_without_looks_of_its_own_is_drawn_from_its_wires() -> None:
    """
    Its inputs are called as its signals, and each has its wire.
    """
    plan = api.plan(spec("uno_motor_shield"))
    [motor] = plan.motors
    other = replace(motor, drive=replace(motor.drive, kind="another", title="another driver"))
    scene = wiring_scene(replace(plan, motors=(other,)))

    signals = {wire.signal for wire in motor.drive.every_wire}
    assert signals | {"GND", "another driver"} <= {label.text for label in scene.labels}
    assert sum("wire" in stroke.css.split() for stroke in scene.strokes) == len(signals) + 1


def test_the_picture_shows_what_each_switch_does(tmp_path: Path) -> None:
    """
    One to ground is open before the end or closed there, and a pin without pull-up has a sensor.
    """
    path = tmp_path / "spec.yaml"
    text = spec("uno_homing").read_text(encoding="utf-8")
    path.write_text(text.replace("active: high", "pull_up: false"), encoding="utf-8")
    homing, sensed = (wiring_scene(api.plan(one)) for one in (spec("uno_homing"), path))
    levers = {stroke.title: stroke.d for stroke in homing.strokes if "switch of" in stroke.title}

    assert re.search(r"l16 -7M", levers["motor slide, switch of the low end: closes there"])
    assert re.search(r"l16 0M", levers["motor slide, switch of the high end: opens there"])
    texts = [label.text for label in homing.labels]
    assert texts.index("LOW at the end") > 0
    assert "HIGH at the end" in texts
    assert "sensor" not in texts
    assert [label.text for label in sensed.labels].count("sensor") == 1
    assert not any("switch of the high end" in stroke.title for stroke in sensed.strokes)


def test_the_limits_of_a_motor_are_told() -> None:
    """
    Speeds and ways are those of the spec at 80 steps in a millimetre; others have no such table.
    """
    text = page(spec("uno_homing"))
    tables = Reader(text).captions

    assert tables["slide: limits"][1:] == [
        ["low end", "D9 (PB1), LOW when pressed, pulled up by the chip"],
        ["high end", "D10 (PB2), HIGH when pressed, pulled up by the chip"],
        ["range", "0 to 14400 steps: 0 to 180 mm"],
        [
            "homing",
            (
                "to the low switch at 2400 steps/s, for 17600 steps at most; "
                "back by 240, and to it at 400 steps/s"
            ),
        ],
        ["home", "the switch is position -80; rest at 0"],
    ]
    assert tables["slide: wires"][-2:] == [
        ["low end", "D9", "PB1", "input, LOW there"],
        ["high end", "D10", "PB2", "input, HIGH there"],
    ]
    ownership = tables["Timers, vectors and ports"]
    assert [row[-1] for row in ownership] == ["switches", "D9 (low end), D10 (high end)"]
    assert "slide, range 0 to 14400 steps" in words(text)
    others = Reader(page(spec("uno_trapezoid"))).captions
    assert not any(caption.endswith(": limits") for caption in others)
    assert others["Timers, vectors and ports"][0][-1] == "ports for itself"


@pytest.mark.parametrize("text", HOSTILE)
def test_text_of_a_spec_stays_text(tmp_path: Path, text: str) -> None:
    """
    Whatever author and sentence hold, the page has the same tags and attributes.
    """
    source = spec("mega_pan_tilt").read_text(encoding="utf-8")
    pages = []
    for words_of_spec in ("plain", text):
        path = tmp_path / "spec.yaml"
        lines = f"sentence: {json.dumps(words_of_spec)}\n  author: {json.dumps(words_of_spec)}"
        head, _, tail = source.partition("sentence: ")
        path.write_text(head + lines + "\n" + tail.partition("\n")[2], encoding="utf-8")
        plan = api.plan(path)
        failed = [{"name": words_of_spec, "passed": False, "detail": words_of_spec}]
        report = report_of(plan, passed=False, checks=failed, compiler=words_of_spec)
        pages.append(Reader(render_datasheet(plan, "", report)).tags)

    assert pages[0] == pages[1]


@pytest.mark.parametrize("path", SPECS, ids=lambda path: path.stem)
def test_the_figures_are_those_of_the_plan(path: Path) -> None:
    """
    Highest rates, cycles of the interrupts, stretches with interrupts off, and every wire.
    """
    assert_figures(path)


@pytest.mark.parametrize("name", LARGE)
def test_many_motors_have_theirs(name: str, tmp_path: Path) -> None:
    """
    So are those of twelve motors, where rows and columns that say the same are told once.
    """
    assert_figures(large(name, tmp_path))


def assert_figures(path: Path) -> None:
    """
    Compare the tables of the page with the plan.
    """
    plan = api.plan(path)
    tables = Reader(page(path)).captions
    safe = tables["Highest rate without a lost step"][1:]
    held = tables["How long the sketch may have interrupts off"][1:]
    cycles = {row[0]: row[1:] for row in tables["Step interrupts"]}
    called = dict(zip((motor.name for motor in plan.motors), cycles["clocks"], strict=True))

    for name, limits in plan.rates.items():
        told = iter([row for row in safe if row[0] == name])
        for beside, row in spread(told, [limit.beside for limit in limits]):
            limit = next(limit for limit in limits if limit.beside == beside)
            figures = [str(int(limit.steps_per_second)), str(limit.period_cycles)]
            assert row[2:4] == figures
            assert limit.cause.endswith(row[4].partition(" (not proven")[0])
    assert [(row[1], row[3]) for row in held] == [
        (str(one.stretch_cycles), str(one.late_cycles)) for one in plan.held_off
    ]
    assert cycles["a step, response to RETI"] == [str(m.hot_path.usual_cycles) for m in plan.motors]
    assert cycles["longest, allowed by the plan"] == [str(m.isr_bound_cycles) for m in plan.motors]
    for motor in plan.motors:
        (rows,) = (
            rows for text, rows in tables.items() if motor.name in named(text, ": wires", plan)
        )
        assert wires_in(rows, called[motor.name]) == {
            signal: f"{pin.label} ({pin.bit.name})" for signal, pin in ends_of(motor)
        }


def spread(rows: Iterator[list[str]], besides: list[str]) -> Iterator[tuple[str, list[str]]]:
    """
    Yield each of *besides* with its row: one row may stand for several that follow each other.
    """
    left = iter(besides)
    for row in rows:
        _, _, last = row[1].rpartition(" up to ")
        for beside in left:
            yield beside, row
            if beside == last:
                break
    assert not list(left)


def named(text: str, end: str, plan: Plan) -> list[str]:
    """
    Return the motors that *text* names before *end*; none if it ends otherwise.
    """
    if text == f"all motors{end}":
        return [motor.name for motor in plan.motors]
    return re.split(r", | and ", text.removesuffix(end)) if text.endswith(end) else []


def wires_in(rows: list[list[str]], name: str) -> dict[str, str]:
    """
    Return pin and port bit of each signal of the motor called *name*, alone or one of several.
    """
    heading, *others = rows
    if heading[0] == "signal":
        return {signal: f"{pin} ({bit})" for signal, pin, bit, _ in others}
    (row,) = (row for row in others if name == row[0])
    cells = dict(zip(heading[1:], row[1:], strict=True))
    return {signal: cell.partition(",")[0] for signal, cell in cells.items() if cell != "-"}


@pytest.mark.parametrize("path", SPECS, ids=lambda path: path.stem)
def test_the_rates_are_what_the_timer_makes(path: Path) -> None:
    """
    The rate on the wire is f / (prescaler x ticks), the deviation that from the wanted rate.

    A period is the clock over the rate, cut off, and then cut off again to whole ticks; of an axis
    it counts 1/256 clocks. Motors that have the same share a table; the RPM is that of the
    gear in its heading, or of all. Where the prescaler is 1, the ticks are the period.
    """
    plan = api.plan(path)
    tables = Reader(page(path)).captions
    for motor in plan.motors:
        ((heading, *rows),) = (
            rows for text, rows in tables.items() if motor.name in named(text, ": rates", plan)
        )
        axis = bool(motor.motion.ladder)
        assert len(rows) > 5
        assert axis == (heading[1] == "interval, 1/256 clocks")
        last = str(motor.motion.cruise_interval_256 if axis else plan.minimum_period_cycles)
        assert last in {row[1] for row in rows} if axis else last == rows[-1][1]
        turn = motor.steps_per_turn
        wanted_headings = {"RPM", f"RPM at {float(turn):.6g} a turn"} if turn else set()
        gears = [column for column, text in enumerate(heading) if text in wanted_headings]
        assert len(gears) == (turn is not None)
        for row in rows:
            wanted, period, *ticks = row[: heading.index("on the wire")]
            real, ppm = row[len(ticks) + 2 : len(ticks) + 4]
            exact = Fraction(plan.board.f_cpu_hz * 256, int(period))
            if not axis:
                prescaler, count = map(int, ticks[0].split(" x ") if ticks else ("1", period))
                exact = Fraction(plan.board.f_cpu_hz, prescaler * count)
                assert 0 <= int(period) - prescaler * count < prescaler
            assert float(real) == pytest.approx(float(exact), rel=1e-7)
            assert int(ppm) == pytest.approx((float(exact) / float(wanted) - 1) * 1e6, abs=1)
            for gear in gears:
                assert turn
                rpm = float(exact * 60 / turn)
                assert float(row[gear]) == pytest.approx(rpm, rel=1e-4)


def test_the_curve_of_an_axis_is_its_ramp() -> None:
    """
    The cruise speed comes after (v - u) / a and (v^2 - u^2) / 2a steps, a third of the move.

    So says uniform acceleration; the ramp of the library is within 2 %.
    """
    plan = api.plan(spec("uno_28byj48_ramp"))
    axis, constant = motion_charts(plan)
    (curve,) = axis.curves
    cruise_sps, start_sps, acceleration = 1000, 200, 1000
    steps = (cruise_sps**2 - start_sps**2) / (2 * acceleration)

    top_s = next(second for second, sps in curve.corners if sps >= cruise_sps * 0.99)
    made = re.fullmatch(r"motorMove\((\d+)\);", curve.call)
    assert made
    assert int(made[1]) == pytest.approx(3 * steps, rel=0.02)
    assert top_s == pytest.approx((cruise_sps - start_sps) / acceleration, rel=0.02)
    assert curve.corners[0][0] == 0
    assert curve.corners[0][1] == pytest.approx(start_sps, rel=0.05)
    assert curve.corners[-1][0] == pytest.approx(2 * top_s + steps / cruise_sps, rel=0.02)
    assert "No ramp" not in axis.note
    assert (constant.name, "No ramp" in constant.note) == ("feed", True)


def test_what_only_a_verification_tells_is_not_claimed_before() -> None:
    """
    The page of the library says that nothing is verified yet, and how to do it.
    """
    text = page(spec("mega_pan_tilt"))

    assert text.count("not verified yet: run stepgen verify") == 2
    assert {row[1] for row in Reader(text).captions["Memory, over an empty sketch"][1:]} == {
        "not verified"
    }


def test_a_verification_fills_its_figures_in() -> None:
    """
    Memory, measured cycles, jitter, and how many checks passed with what.
    """
    path = spec("mega_pan_tilt")
    text = page(path, report_of(api.plan(path)))
    tables = Reader(text).captions
    cycles = {row[0]: row[1:] for row in tables["Step interrupts"]}

    assert cycles["longest, by the linked program"] == ["7101", "7102"]
    assert cycles["longest, measured"] == ["7001", "7002"]
    assert cycles["mean of a step, measured"] == ["7201.5", "7202.5"]
    assert cycles["latest edge (jitter), measured"] == ["7301", "7302"]
    assert tables["Memory, over an empty sketch"][1:] == [
        ["flash", "7401 bytes of 262144"],
        ["RAM", "7501 bytes of 8192"],
        ["stack of the step interrupts", "7601 bytes, at most 7701"],
    ]
    assert text.count("verified: 55 checks passed, gcc-5.4 on simavr 1.6") == 2
    assert "not verified" not in text


def test_a_failed_check_is_shown_with_its_reason() -> None:
    """
    Nobody can take the page of a library that failed for that of one that passed.
    """
    path = spec("uno_motor_shield")
    checks = [
        {"name": "single steps", "passed": True, "detail": ""},
        {"name": "the pattern", "passed": False, "detail": "step 3 shows 0110"},
    ]
    text = page(path, report_of(api.plan(path), passed=False, checks=checks))

    assert "FAILED: 1 of 2 checks, gcc-5.4 on simavr 1.6" in words(text)
    assert "the pattern: step 3 shows 0110" in words(text)

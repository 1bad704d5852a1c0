"""
``stepgen plan`` without a spec: rates, the table, speed changes, plots.
"""

import json
import os
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import pytest

Stepgen = Callable[..., Any]

RAMP = ("plan", "--from", "6", "--to", "800")
# Chapter 7 of system 1.
CALL = (
    "motorSetSpeed(MOTOR_CTRL_SPEED_VARIABLE | MOTOR_CTRL_IRQ_TIMING | MOTOR_CTRL_FASTER | "
    "MOTOR_CTRL_DRV_EN, 2666666UL, 0UL, 91264UL, 250, 29);"
)
SVG = "{http://www.w3.org/2000/svg}"


def shows(out: str, *row: str) -> bool:
    """
    Tell whether a line of *out* begins with the cells of *row*.
    """
    return re.search(rf"^ *{' +'.join(map(re.escape, row))}\b", out, re.MULTILINE) is not None


def test_a_rate(stepgen: Stepgen) -> None:
    """
    The source's row of 180 steps/s, and the call to paste.
    """
    run = stepgen("plan", "--rate", "180", "--f-cpu", "16000000", "--steps-per-turn", "200")

    assert (run.code, run.err) == (0, "")
    assert max(map(len, run.out.splitlines())) <= 80
    assert shows(run.out, "virtual TOP", "88888 clocks")
    assert shows(run.out, "timer value", "11111 ticks: compare register 11110")
    assert shows(run.out, "prescaler", "8")
    assert shows(run.out, "real rate", "180.0018 steps/s")
    assert shows(run.out, "deviation", "+0.00100")
    assert shows(run.out, "RPM", "54.00054 at 200 steps/turn")
    assert run.out.endswith("\nmotorSetSpeed(MOTOR_CTRL_DRV_EN, 88888UL);\n")


def test_rpm(stepgen: Stepgen) -> None:
    """
    The source's row of 10 RPM, in whole steps, and the exact one below it.
    """
    run = stepgen("plan", "--rpm", "10", "--steps-per-turn", "200")

    assert run.code == 0
    assert shows(run.out, "RPM", "9.9000099 at")
    assert shows(run.out, "RPM deviation", "-0.999901")
    assert run.out.index("484848UL") < run.out.index("motorSetSpeed(MOTOR_CTRL_DRV_EN, 480000UL);")


def test_a_virtual_value(stepgen: Stepgen) -> None:
    """
    The source's example of 926533, which prescaler 64 makes 926528.
    """
    run = stepgen("plan", "--virtual", "926533")

    assert run.code == 0
    assert shows(run.out, "real interval", "926528 clocks, 99.999")
    assert shows(run.out, "timer value", "14477 ticks")


def test_the_table(stepgen: Stepgen) -> None:
    """
    First and last rows of the source's two tables.
    """
    run = stepgen("plan", "--table")

    assert run.code == 0
    assert shows(run.out, "1000", "16000", "4800")
    assert shows(run.out, "51000", "313.7255", "94.11765")
    assert shows(run.out, "5", "16000", "32000", "500", "150")
    assert shows(run.out, "16", "32768000", "65536000", "0.2441406", "0.07324219")


def test_json(stepgen: Stepgen) -> None:
    """
    Each form prints JSON with the names of the dataclasses and exact fractions.
    """
    rate = json.loads(stepgen("plan", "--rate", "180", "--clkpr", "2", "--json").out)
    table = json.loads(stepgen("plan", "--table", "--json").out)
    change = json.loads(stepgen(*RAMP, "--time", "7.25", "--json").out)

    assert rate["clock"]["clkpr"] == 2
    assert rate["rates"][0]["real_sps"] == {"numerator": 2_000_000, "denominator": 11_111}
    assert (len(table["rates"]), table["doubling"][16]["increment"]) == (51, 32_768_000)
    assert change["call"] == CALL
    assert [update["virtual_clocks"] for update in change["updates"][:2]] == [2666666, 2575402]


@pytest.mark.parametrize(
    "length", [("--updates", "29", "--interval-ms", "250"), ("--time", "7.25")]
)
def test_a_speed_change(stepgen: Stepgen, length: tuple[str, ...]) -> None:
    """
    The source's ramp: its columns, a plot, and its call on one line at the end.
    """
    run = stepgen(*RAMP, *length)

    assert (run.code, run.err) == (0, "")
    assert run.out.endswith(f"\n{CALL}\n")
    assert shows(run.out, "1", "0.25", "2575402", "-91264", "64")
    assert shows(run.out, "29", "7.25", "20010", "-91264", "1", "799.6")
    assert "\x1b" not in run.out
    assert max(len(line) for line in run.out.removesuffix(f"{CALL}\n").splitlines()) <= 80


def test_a_halving_change_with_a_modification_of_ones_own(stepgen: Stepgen) -> None:
    """
    The source's 11 updates from 1 RPM, with the modification that stands there.
    """
    options = ("--faster", "2385000", "--updates", "11", "--interval-ms", "1000", "--halving")
    run = stepgen("plan", "--from", "1rpm", *options)

    assert shows(run.out, "11", "11", "32332", "-2329", "1", "494.866")
    assert run.out.endswith("4800000UL, 0UL, 2385000UL, 1000, 11);\n")


def test_a_number_of_turns(stepgen: Stepgen) -> None:
    """
    Three turns of 400 half steps are 1200 steps, give or take a few.
    """
    run = stepgen("plan", "--from", "100", "--to", "800", "--turns", "3", "--steps-per-turn", "400")

    match = re.search(r"^turns +([\d.]+) of 400 steps", run.out, re.MULTILINE)
    assert run.code == 0
    assert match is not None
    assert float(match[1]) == pytest.approx(3, abs=0.05)


def test_many_updates_are_cut_short(stepgen: Stepgen) -> None:
    """
    Of 400 updates only some are printed, the last among them, and the output says so.
    """
    run = stepgen(*RAMP, "--updates", "400", "--interval-ms", "60")

    assert "some of 400 updates; --json has all" in run.out
    assert shows(run.out, "400", "24")
    assert len(run.out.splitlines()) < 80


def test_updates_faster_than_steps_are_noted(stepgen: Stepgen) -> None:
    """
    At 6 steps/s, updates each 50 ms wait for a step, and that is said.
    """
    assert "updates wait for a step" in stepgen(*RAMP, "--updates", "29", "--interval-ms", "50").out


def test_the_svg_plot(stepgen: Stepgen, tmp_path: Path) -> None:
    """
    The picture is well-formed, names the units of its axes, and has a corner for each update.
    """
    run = stepgen(*RAMP, "--time", "7.25", "--plot", "ramp.svg")

    root = ET.parse(tmp_path / "ramp.svg").getroot()  # noqa: S314 - our own output
    texts = [element.text for element in root.iter(f"{SVG}text")]
    line = root.find(f"{SVG}polyline")
    assert run.code == 0
    assert root.tag == f"{SVG}svg"
    assert {"steps/s", "RPM", "time since the call, s", "800", "200"} <= set(texts)
    assert line is not None
    assert len(line.attrib["points"].split()) == 1 + 2 * 29 + 1
    assert len(list(root.iter(f"{SVG}circle"))) == 29


def test_the_plot_in_the_terminal_works_in_ascii(tmp_path: Path) -> None:
    """
    Braille where the output can show it, stars where it cannot.
    """

    def out(encoding: str) -> str:
        return subprocess.run(
            [sys.executable, "-m", "stepgen", *RAMP, "--time", "7.25"],
            cwd=tmp_path,
            env={**os.environ, "PYTHONIOENCODING": encoding},
            capture_output=True,
            check=True,
            encoding=encoding,
            timeout=60,
        ).stdout

    assert "⣀" in out("utf-8")
    assert re.search(r"^ +0 \|\*+$", out("ascii"), re.MULTILINE)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((), "nothing to plan; give a SPEC, or --rate"),
        (("--f-cpu", "16000000"), "nothing to plan"),
        (("pan.yaml", "--rate", "180"), "a SPEC and --rate exclude each other"),
        (("pan.yaml", "--clkpr", "2"), "a SPEC and --clkpr exclude each other"),
        (("pan.yaml", "--from", "6", "--halving"), "a SPEC and --from and --halving exclude"),
        (("--rate", "180", "--rpm", "10"), "--rate and --rpm ask for different things"),
        (("--table", "--plot", "a.svg"), "--table and --plot ask for different things"),
        (("--rate", "fast"), "error: fast: --rate takes a number above 0"),
        (("--rate", "0"), "--rate takes a number above 0"),
        (("--rate", "1/0"), "--rate takes a number above 0"),
        (("--rate", "1e999999999"), "--rate takes a number above 0"),
        (("--rate", "30000"), "too fast; the smallest period is 640 clocks: choose from"),
        (("--virtual", "0"), "too fast"),
        (("--rpm", "0.01"), "too slow"),
        (("--rate", "180", "--clkpr", "3"), "error: 3: CLKPR divides by 1, 2, 4"),
        (("--to", "800", "--time", "1"), "needs a start; give --from SPEED"),
        (("--from", "6", "--time", "1"), "needs an end; give --to SPEED"),
        (("--from", "6", "--to", "8", "--faster", "9"), "--to and --faster are too many"),
        (("--from", "6", "--faster", "9", "--time", "1"), "take --updates and --interval-ms"),
        (("--from", "6miles", "--to", "8", "--time", "1"), "6miles: --from takes a speed"),
        (("--from", "6", "--to", "8", "--time", "1", "--plot", "a.png"), "a.png: --plot draws SVG"),
        (("--from", "6", "--to", "8"), "is not said; give updates and interval"),
        (("--from", "6", "--to", "8", "--turns", "1", "--steps", "9"), "--turns and --steps say"),
        (("--from", "6", "--to", "8", "--updates", "0", "--interval-ms", "9"), "0 updates"),
        (("--from", "6", "--to", "800", "--time", "1", "--plot", "no/a.svg"), "No such file"),
    ],
)
def test_wrong_use_is_a_message(stepgen: Stepgen, arguments: tuple[str, ...], message: str) -> None:
    """
    Wrong and contradictory options are exit code 2 and one line that says what to do.
    """
    run = stepgen("plan", *arguments)

    assert (run.code, run.out) == (2, "")
    assert message in run.err
    assert len(run.err.splitlines()) == 1

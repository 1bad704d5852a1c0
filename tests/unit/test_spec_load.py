"""
Loading a spec: every fault at its line and column, with the offending text and a way out.
"""

from collections.abc import Callable
from pathlib import Path

import pytest

from stepgen.errors import Fault, StepgenError
from stepgen.spec import LoadedSpec, load_spec

Faulty = Callable[[str], tuple[Fault, ...]]

HEAD = "library: Mine\nboard: uno\nmotors:\n"
FOUR_WIRE = "  motor: {drive: {kind: four-wire, pins: "


@pytest.fixture
def spec_path(tmp_path: Path) -> Path:
    """
    Return where the spec of a test is written.
    """
    return tmp_path / "spec.yaml"


@pytest.fixture
def loaded(spec_path: Path) -> Callable[[str], LoadedSpec]:
    """
    Return a function that loads a spec from its text.
    """

    def load(text: str) -> LoadedSpec:
        spec_path.write_text(text, encoding="utf-8")
        return load_spec(spec_path)

    return load


@pytest.fixture
def faults(loaded: Callable[[str], LoadedSpec]) -> Faulty:
    """
    Return a function that loads a faulty spec from its text and gives the faults.
    """

    def load(text: str) -> tuple[Fault, ...]:
        with pytest.raises(StepgenError) as error:
            loaded(text)
        return error.value.faults

    return load


def _where(fault: Fault) -> str:
    return fault.place.split("spec.yaml", 1)[1]


def test_five_lines_are_a_spec(loaded: Callable[[str], LoadedSpec]) -> None:
    """
    The shortest spec has a name, a board and a motor with a drive.
    """
    spec = loaded(HEAD + "  motor: {drive: motor-shield}\n").spec

    assert spec.library.name == "Mine"
    assert spec.motors["motor"].drive.kind == "motor-shield"
    assert spec.motors["motor"].timing.kind == "fast-pwm"


@pytest.mark.parametrize(
    ("motor", "where", "text", "reason"),
    [
        (
            "  motor: {drive: motor-shield, tmer: 1}\n",
            ":4:38",
            "1",
            "tmer is no field of this part of a spec; remove it",
        ),
        (
            "  motor: {drive: l298}\n",
            ":4:18",
            "l298",
            "\"l298\" is unknown; choose one of 'four-wire', 'motor-shield'",
        ),
        (
            FOUR_WIRE + "[D4, X5, D6, D7]}}\n",
            ":4:47",
            "X5",
            "is no pin; write it as D12, A8 or PB4",
        ),
        (
            FOUR_WIRE + "[D4, D5, D6, d4]}}\n",
            ":4:11",
            "",
            "pin D4 drives two coils; give each of the four coils a pin of its own",
        ),
        (FOUR_WIRE + "[D4, D5, D6]}}\n", ":4:36", "", "has too few entries; give one for each"),
        (FOUR_WIRE + "[1, 2, 3, 4, 5]}}\n", ":4:36", "", "has too many entries; give one for each"),
        ("  motor: {drive: four-wire}\n", ":4:18", "four-wire", "pins is missing; add"),
        ("  motor: {timer: 1}\n", ":4:3", "", "drive is missing; add `drive: ...`"),
        ("  motor: shield\n", ":4:10", "shield", "motor needs fields of its own; write them"),
        (
            "  motor: {drive: motor-shield, timer: one}\n",
            ":4:39",
            "one",
            "timer must be a whole number",
        ),
        (
            "  motor:\n    drive: motor-shield\n    timer: 1\n    timing: {timer: 1}\n",
            ":4:3",
            "",
            "timer is given twice, here and in timing; remove one of them",
        ),
        (
            "  motor: {drive: motor-shield, at_rest: sleep}\n",
            ":4:41",
            "sleep",
            "is not possible for at_rest; write 'hold' or 'release'",
        ),
        (
            "  motor: {drive: motor-shield, sequence: fulll}\n",
            ":4:42",
            "fulll",
            "is not possible for sequence; write 'full', 'wave' or 'half'",
        ),
        (
            FOUR_WIRE + "[1, 2, 3, 4]}, sequence: ['10', '0101', '1010']}\n",
            ":4:68",
            "10",
            "is no pattern; write four characters 0 or 1 in quotes",
        ),
        (
            FOUR_WIRE + "[1, 2, 3, 4]}, sequence: ['1010', '0101']}\n",
            ":4:57",
            "",
            "has 2 patterns; write a table of 3 to 32",
        ),
        (
            "  Pan: {drive: motor-shield}\n",
            ":4:3",
            "",
            '"Pan" names no motor: it begins each of its functions, so use a lower-case letter',
        ),
        ("  7: {drive: motor-shield}\n", ":4:3", "", "is no name; write one that begins"),
        (
            "  pan: {drive: motor-shield}\n  pAn: {drive: motor-shield}\n",
            ":3:1",
            "",
            "two motors have names that differ in case only",
        ),
        (
            "  motor: {drive: motor-shield, steps_per_turn: {full_steps: 32, gear: 1/0}}\n",
            ":4:71",
            "1/0",
            "is no number; write 64, 63.68395 or a fraction such as 25792/405",
        ),
        ("  motor: &m {drive: motor-shield}\n", ":4:10", "", "tags and anchors have no use"),
        ("  motor: !m {drive: motor-shield}\n", ":4:10", "", "tags and anchors have no use"),
        ("  motor: {drive: !m motor-shield}\n", ":4:18", "", "tags and anchors have no use"),
        ("  motor: {drive: &m motor-shield}\n", ":4:18", "", "tags and anchors have no use"),
        (
            "  motor:\n    <<: {drive: motor-shield}\n",
            ":5:5",
            "",
            "tags and anchors have no use in a spec; remove it",
        ),
        ("  motor: {drive: motor-shield}\nboard: mega\n", ":5:1", "", 'the key "board" is given'),
        ("  motor: {drive: [}\n", ":4:19", "", "is no YAML: "),
    ],
)
def test_a_fault_has_place_text_and_way_out(
    faults: Faulty, motor: str, where: str, text: str, reason: str
) -> None:
    """
    A fault names line and column, the offending text, what is wrong and what to do.
    """
    found = faults(HEAD + motor)

    assert [(_where(fault), fault.text) for fault in found] == [(where, text)]
    assert found[0].reason.startswith(reason)


@pytest.mark.parametrize(
    ("head", "where", "text", "reason"),
    [
        ("library: {name: Mine, version: 1.0}", ":1:32", "1.0", "is no version; write three"),
        ("library: {name: Mine, version: 1.0.x}", ":1:32", "1.0.x", "is no version; write three"),
        ("library: ../up", ":1:10", "../up", '"../up" names no library: it becomes a folder'),
        (
            'library: {name: Mine, author: "two\\nlines"}',
            ":1:31",
            "two lines",
            "author must be one line of text without control characters",
        ),
        ("library: {name: Mine, category: Fun}", ":1:33", "Fun", "is not possible for category"),
        ("library: Mine\nspeed: 3", ":2:8", "3", "speed is no field of this part of a spec"),
        ("library: Mine\nuses: [3]", ":2:8", "3", "uses must be text; put it in quotes"),
    ],
)
def test_a_fault_outside_the_motors_has_them_too(
    faults: Faulty, head: str, where: str, text: str, reason: str
) -> None:
    """
    The metadata and the top of the spec are reported in the same way.
    """
    found = faults(f"{head}\nboard: uno\nmotors:\n  motor: {{drive: motor-shield}}\n")

    assert [(_where(fault), fault.text) for fault in found] == [(where, text)]
    assert found[0].reason.startswith(reason)


def test_all_faults_are_reported_together(faults: Faulty) -> None:
    """
    Faults of all parts come in one report, in the order of the lines, and always in the same.
    """
    text = (
        "library: {name: 1st, version: 2}\n"
        "board: uno\n"
        "speed: 3\n"
        "motors:\n"
        "  pan: {drive: l298}\n"
        "  Tilt: {drive: motor-shield, port: mine}\n"
    )
    found = faults(text)

    assert [_where(fault) for fault in found] == [":1:31", ":3:8", ":5:16", ":6:3", ":6:37"]
    assert all(";" in fault.reason or ":" in fault.reason for fault in found)


def test_what_is_missing_at_the_top_comes_in_a_fixed_order(faults: Faulty) -> None:
    """
    Two faults of one place are sorted by their text, so that reports never change.
    """
    found = faults("library: Mine\n")

    assert [fault.reason for fault in found] == [
        "board is missing; add `board: ...`",
        "motors is missing; add `motors: ...`",
    ]


@pytest.mark.parametrize("text", ["", "\n", "# only a comment\n", "- a\n- b\n", "word\n", "{}\n"])
def test_what_holds_no_mapping_holds_no_spec(faults: Faulty, text: str) -> None:
    """
    An empty file, a list and a single word get told how a spec begins.
    """
    found = faults(text)

    assert [fault.reason for fault in found] == [
        "holds no spec; a spec begins with `library:`, `board:` and `motors:`"
    ]


@pytest.mark.parametrize("motors", ["motors:\n", "motors: {}\n", "motors: [1]\n"])
def test_a_spec_needs_a_motor(faults: Faulty, motors: str) -> None:
    """
    Motors that are no mapping, or none at all, are refused with a way out.
    """
    (fault,) = faults(f"library: Mine\nboard: uno\n{motors}")

    assert _where(fault).startswith(":3:")
    assert fault.reason.startswith("motors ")


def test_a_file_that_is_not_utf_8_is_refused_at_its_line(spec_path: Path) -> None:
    """
    Bytes of another encoding are reported with the line and column that hold them.
    """
    spec_path.write_bytes(b"library: Mine\n# M\xfcller\n")

    with pytest.raises(StepgenError) as error:
        load_spec(spec_path)

    assert error.value.faults == (
        Fault(f"{spec_path}:2:4", "", "is not UTF-8; save the file with that encoding"),
    )


def test_a_file_that_is_not_there_is_refused(tmp_path: Path) -> None:
    """
    A missing file is a fault like any other, not a traceback.
    """
    with pytest.raises(StepgenError, match=r"cannot be read .*; name the YAML file of a spec"):
        load_spec(tmp_path / "none.yaml")


def test_a_huge_file_and_deep_nesting_are_refused(faults: Faulty) -> None:
    """
    What no spec needs is refused before it can cost time or memory.
    """
    (large,) = faults("#" * 300_000)
    (deep,) = faults("a: " + "[" * 40 + "]" * 40)

    assert large.reason.startswith("is larger than 64 KiB; ")
    assert deep.reason == "is nested too deeply for a spec; remove a level"


def test_brackets_cost_nothing_beyond_the_deepest_level(faults: Faulty) -> None:
    """
    The thirteenth bracket is the fault, and none after it is read: each would cost as much as all.
    """
    (fault,) = faults("uses: " + "[" * 4000)

    assert fault.place.endswith(f":1:{len('uses: ') + 13}")
    assert fault.reason == "is nested too deeply for a spec; remove a level"

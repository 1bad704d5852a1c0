"""
The builds of ``stepgen matrix``: what is built, what is kept, and what counts as ours.
"""

from collections.abc import Callable
from pathlib import Path

import pytest

from stepgen import api
from stepgen.devices import boards, find_board
from stepgen.verify import ide_matrix
from stepgen.verify.compilers import find_compilers
from stepgen.verify.ide_matrix import Build, Builds, Outcome, fitting, run_jobs
from stepgen.verify.recipes import board_properties, targets
from tests.sim.kinds import KINDS

ROOT = Path(__file__).parents[2]
SPECS = sorted((ROOT / "specs").glob("*.yaml"))
LIBRARIES = (ROOT / "tests/libraries",)

# The boards of the Arduino AVR core 1.8 by chip, from its boards.txt.
UNO_LIKE = {
    *("uno", "unomini", "diecimila:atmega328", "nano:atmega328", "nano:atmega328old"),
    *("mini:atmega328", "ethernet", "bt:atmega328", "pro:16MHzatmega328", "unowifi"),
}
FITS = {
    "uno": UNO_LIKE,
    "pro-mini-8mhz": {"fio", "lilypad:atmega328", "pro:8MHzatmega328"},
    "mega": {"mega:atmega2560", "megaADK"},
    "mega1280": {"mega:atmega1280"},
    "leonardo": {
        *("leonardo", "leonardoeth", "micro", "esplora", "yun", "yunmini", "chiwawa", "one"),
        *("robotControl", "robotMotor"),
    },
}


def builds_of(*specs: Path) -> Builds:
    """
    Return all builds of the libraries of *specs*.
    """
    return api.plan_builds(api.render_all(specs))


def outcomes(jobs: list[Build], *libraries: Path) -> list[Outcome]:
    """
    Return what comes of *jobs*, in their order.
    """
    done = dict(run_jobs(jobs, libraries, at_once=2))
    return [done[job] for job in jobs]


@pytest.fixture
def fresh(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """
    Begin with an empty cache.
    """
    monkeypatch.setenv("STEPGEN_CACHE", str(tmp_path / "cache"))


@pytest.fixture
def sketch() -> Callable[[str], Build]:
    """
    Return a function that makes a build of a library with one function, from the sketch's text.
    """

    def make(text: str, source: str = "int tryMe() { return 1; }\n") -> Build:
        files = {
            "library.properties": (
                "name=TryMe\nversion=1.0.0\nauthor=a\nmaintainer=a\nsentence=a\nparagraph=a\n"
                "category=Device Control\nurl=https://example.org\narchitectures=avr\n"
            ),
            "src/TryMe.h": "int tryMe();\n",
            "src/TryMe.cpp": f'#include "TryMe.h"\n{source}',
            "examples/Try/Try.ino": f"#include <TryMe.h>\n{text}",
        }
        (target,) = (target for target in targets() if target.title == "uno")
        return Build(Path("try.yaml"), "TryMe", files, "Try", target, find_compilers()[0])

    return make


@pytest.mark.parametrize("name", FITS)
def test_a_library_fits_all_boards_of_its_chip_and_clock(name: str) -> None:
    """
    The boards are the core's; those of the same chip and another clock have the reason.
    """
    board = find_board(name)
    assert board is not None
    fits, reasons = fitting(board)

    assert {target.title for target in fits} == FITS[name]
    chips = {board_properties(target)["build.mcu"] for target in reasons}
    assert chips <= {board.mcu.name}
    assert set(reasons.values()) <= {"8 MHz, not 16 MHz", "16 MHz, not 8 MHz"}


def test_every_board_of_stepgen_is_one_of_the_core() -> None:
    """
    The FQBN of each is in the list that its own library fits.
    """
    for board in boards():
        assert board.fqbn in {target.fqbn for target in fitting(board)[0]}


@pytest.mark.usefixtures("fresh")
def test_what_was_built_is_not_built_again(
    sketch: Callable[[str], Build], monkeypatch: pytest.MonkeyPatch
) -> None:
    """
    The second time the builder is not run; it is where the sketch or another library differs.
    """
    job, other = (
        sketch("void setup() {}\nvoid loop() {}\n"),
        sketch("void setup() {}void loop() {}"),
    )
    first = outcomes([job])
    calls = []

    def refuse(*arguments: object, **_options: object) -> None:
        calls.append(arguments)
        raise KeyError

    monkeypatch.setattr(ide_matrix, "build_with_ide", refuse)

    assert first == outcomes([job])
    assert first[0].passed
    assert first[0].flash_bytes > 400  # the core's own, as of any sketch
    assert calls == []
    with pytest.raises(KeyError):
        outcomes([other])
    with pytest.raises(KeyError):
        outcomes([job], *LIBRARIES)


@pytest.mark.usefixtures("fresh")
def test_a_warning_counts_by_whose_code_it_is_about(
    sketch: Callable[..., Build], tmp_path: Path
) -> None:
    """
    Ours are those about the library and the sketch; those about a library beside it are others.
    """
    unused = "static int unused() { return 1; }\n"
    plain = "void setup() {}\nvoid loop() {}\n"
    header = tmp_path / "libraries/Beside/Beside.h"
    header.parent.mkdir(parents=True)
    header.write_text(unused, encoding="ascii")
    found = outcomes(
        [
            sketch(plain, unused),
            sketch(f"{unused}{plain}"),
            sketch(f"#include <Beside.h>\n{plain}"),
        ],
        tmp_path / "libraries",
    )

    for outcome, place in zip(found[:2], ("src/TryMe.cpp:2", "Try/Try.ino:2"), strict=True):
        (warning,) = outcome.warnings
        assert place in warning
        assert "-Wunused-function" in warning
        assert not outcome.passed
    assert found[2].passed
    assert "Beside/Beside.h:1" in found[2].others[0]


@pytest.mark.usefixtures("fresh")
def test_a_missing_library_is_told_from_a_failure(sketch: Callable[[str], Build]) -> None:
    """
    A header that nobody has leaves the example out; anything else fails it.
    """
    left_out, failed = outcomes(
        [
            sketch("#include <Nowhere.h>\nvoid setup() {}\nvoid loop() {}\n"),
            sketch("void setup() { nothing(); }\nvoid loop() {}\n"),
        ]
    )

    assert (left_out.needs, left_out.failure) == ("Nowhere.h", "")
    assert "'nothing' was not declared in this scope" in failed.failure


def test_one_build_of_each_kind_passes() -> None:
    """
    Examples, boards and compilers by turns, without a warning about our code.
    """
    jobs = []
    for number, stem in enumerate(KINDS):
        every = builds_of(ROOT / f"specs/{stem}.yaml").jobs
        for index, compiler in enumerate(find_compilers()):
            mine = [job for job in every if job.compiler == compiler]
            jobs.append(mine[(7 * number + 3 * index) % len(mine)])

    for job, outcome in zip(jobs, outcomes(jobs, *LIBRARIES), strict=True):
        assert outcome == Outcome(outcome.flash_bytes, outcome.ram_bytes), job
    assert len({job.example for job in jobs}) >= 5
    assert len({job.target for job in jobs}) >= 8


@pytest.mark.campaign
@pytest.mark.parametrize("spec", SPECS, ids=lambda path: path.stem)
def test_every_build_passes(spec: Path) -> None:
    """
    Every example of every spec on every board that fits, with every compiler.
    """
    jobs = list(builds_of(spec).jobs)

    for job, outcome in zip(jobs, outcomes(jobs, *LIBRARIES), strict=True):
        assert outcome == Outcome(outcome.flash_bytes, outcome.ram_bytes), job

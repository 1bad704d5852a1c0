"""
``stepgen generate``: what it writes, what it refuses, and when it calls a library stale.
"""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from stepgen import api
from stepgen.errors import StepgenError

Stepgen = Callable[..., Any]
SpecOf = Callable[..., Path]


def tree(folder: Path) -> dict[str, bytes]:
    """
    Return each file below *folder* with its content.
    """
    files = (path for path in sorted(folder.rglob("*")) if path.is_file())
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in files}


def test_the_library_is_written_into_its_folder(
    stepgen: Stepgen, pan: Path, tmp_path: Path
) -> None:
    """
    Without an output folder, the library's folder is made in the current one.
    """
    run = stepgen("generate", pan.name)

    assert run.code == 0
    assert run.out.splitlines()[0] == "Pan: 13 written"
    assert "  written src/Pan.h" in run.out
    written = tree(tmp_path / "Pan")
    assert {path: text.encode() for path, text in api.render(pan).items()}.items() <= (
        written.items()
    )
    assert set(written) - set(api.render(pan)) == {"extras/stepgen.json"}


def test_a_second_run_changes_nothing(stepgen: Stepgen, pan: Path) -> None:
    """
    An up-to-date library is called so.
    """
    stepgen("generate", pan.name, "--output", "out")

    assert stepgen("generate", pan.name, "--output", "out").out == "out/Pan: up to date\n"


def test_check_tells_fresh_from_stale(stepgen: Stepgen, pan: Path, tmp_path: Path) -> None:
    """
    --check writes nothing; it ends with 0 for a fresh library and 1 for a stale or missing one.
    """
    missing = stepgen("generate", pan.name, "--check")
    assert (missing.code, (tmp_path / "Pan").exists()) == (1, False)

    stepgen("generate", pan.name)
    assert stepgen("generate", pan.name, "--check").code == 0

    (tmp_path / "Pan" / "README.md").write_text("edited")
    (tmp_path / "Pan" / "mine.txt").write_text("mine")
    before = tree(tmp_path)
    run = stepgen("generate", pan.name, "--check")
    assert run.code == 1
    assert run.err.splitlines()[:2] == ["Pan/README.md: stale", "Pan/mine.txt: extra"]
    assert tree(tmp_path) == before


def test_an_edited_library_needs_force(stepgen: Stepgen, pan: Path, tmp_path: Path) -> None:
    """
    An edit is refused with exit code 2, and overwritten with --force.
    """
    stepgen("generate", pan.name)
    fresh = tree(tmp_path)
    (tmp_path / "Pan" / "README.md").write_text("edited")
    before = tree(tmp_path)

    run = stepgen("generate", pan.name)
    assert run.code == 2
    assert "Pan: error: holds files that were edited" in run.err
    assert tree(tmp_path) == before

    assert stepgen("generate", pan.name, "--force").code == 0
    assert tree(tmp_path) == fresh


def test_nothing_is_written_unless_all_specs_are_fine(
    stepgen: Stepgen, spec_of: SpecOf, tmp_path: Path
) -> None:
    """
    One bad spec among several stops all of them, and every bad one is reported.
    """
    spec_of("Good")
    spec_of("Bad", "nothing")
    before = tree(tmp_path)

    run = stepgen("generate", "Good.yaml", "Bad.yaml", "missing.yaml", "--output", "out")

    assert run.code == 2
    assert "Bad.yaml:4:18: error: " in run.err
    assert "missing.yaml: error: " in run.err
    assert tree(tmp_path) == before
    assert not (tmp_path / "out").exists()


def test_nothing_is_written_unless_all_folders_are_ours(
    stepgen: Stepgen, spec_of: SpecOf, tmp_path: Path
) -> None:
    """
    One folder with somebody else's files stops the other libraries too.
    """
    spec_of("Good")
    spec_of("Taken")
    (tmp_path / "Taken").mkdir()
    (tmp_path / "Taken" / "mine.txt").write_text("mine")
    before = tree(tmp_path)

    run = stepgen("generate", "Good.yaml", "Taken.yaml")

    assert run.code == 2
    assert "Taken: error: holds files that stepgen did not write (mine.txt)" in run.err
    assert tree(tmp_path) == before


def test_two_libraries_of_one_name_are_refused(
    stepgen: Stepgen, spec_of: SpecOf, tmp_path: Path
) -> None:
    """
    Two specs of one folder are refused, also where only case tells the names apart.
    """
    spec_of("Pan")
    spec_of("PAN")
    before = tree(tmp_path)

    run = stepgen("generate", "Pan.yaml", "PAN.yaml")

    assert run.code == 2
    assert "PAN.yaml:1:" in run.err
    assert "is the library of Pan.yaml too" in run.err
    assert tree(tmp_path) == before


def test_a_zip_is_written_and_checked(stepgen: Stepgen, pan: Path, tmp_path: Path) -> None:
    """
    --zip writes NAME.zip instead of a folder, the same bytes each time.
    """
    assert stepgen("generate", pan.name, "--zip").out == "Pan.zip: written\n"
    before = tree(tmp_path)

    assert stepgen("generate", pan.name, "--zip").out == "Pan.zip: up to date\n"
    assert stepgen("generate", pan.name, "--zip", "--check").code == 0
    assert tree(tmp_path) == before
    assert not (tmp_path / "Pan").exists()

    (tmp_path / "Pan.zip").write_text("mine")
    assert stepgen("generate", pan.name, "--zip", "--check").code == 1
    assert stepgen("generate", pan.name, "--zip").code == 2
    assert (tmp_path / "Pan.zip").read_text() == "mine"


@pytest.mark.parametrize("output", ["Pan.yaml", "/proc/none", "Pan.yaml/below"])
def test_an_impossible_output_folder_is_a_message(stepgen: Stepgen, pan: Path, output: str) -> None:
    """
    Where no folder can be, exit code 2 and the folder's name.
    """
    run = stepgen("generate", pan.name, "--output", output)

    assert run.code == 2
    assert run.err.startswith(f"{output}/Pan: error: cannot be ")


@pytest.mark.parametrize(
    "arguments",
    [(), ("Pan.yaml", "--check", "--force"), ("Pan.yaml", "--unknown"), ("Pan.yaml", "--output")],
)
def test_wrong_use_is_exit_code_2(
    stepgen: Stepgen, pan: Path, tmp_path: Path, arguments: tuple[str, ...]
) -> None:
    """
    Wrong options are refused before anything is read or written.
    """
    before = tree(tmp_path)

    assert stepgen("generate", *arguments).code == 2
    assert tree(tmp_path) == before
    assert pan.exists()


def test_the_api_writes_one_spec_or_several(spec_of: SpecOf, tmp_path: Path) -> None:
    """
    `api.generate` takes a path or a list, and its faults are those of all specs.
    """
    pan, tilt = spec_of("Pan"), spec_of("Tilt")

    assert [result.target.name for result in api.generate(pan, tmp_path / "out")] == ["Pan"]
    results = api.generate([pan, tilt], tmp_path / "out")
    assert [result.is_fresh for result in results] == [True, False]
    assert not any(api.stale([pan, tilt], tmp_path / "out").values())
    with pytest.raises(StepgenError) as caught:
        api.generate([spec_of("A", "no"), spec_of("B", "no")], tmp_path / "other")
    assert len({fault.place for fault in caught.value.faults}) == 2

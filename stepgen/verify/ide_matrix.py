"""
Every example of a library on every board of the Arduino core that it fits, built by the IDE.

A build is kept by the contents of all that goes into it, so that it is made once. What the core
makes is kept for itself: it is the same for every library.
"""

import functools
import json
import re
import tempfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import asdict, dataclass
from pathlib import Path, PurePosixPath

from stepgen.devices import Board
from stepgen.errors import StepgenError
from stepgen.plan.model import Plan
from stepgen.verify.arduino_builder import build_with_ide, builder_version
from stepgen.verify.arduino_core import Toolchain, core_key
from stepgen.verify.cache import build_once, content_key
from stepgen.verify.compilers import Compiler
from stepgen.verify.recipes import Target, board_properties, targets

_NO_HEADER = re.compile(r"fatal error: (\S+): No such file or directory")
_BLANK = "void setup() {}\nvoid loop() {}\n"
_RESULT = "result.json"


@dataclass(frozen=True, eq=False)
class Build:
    """
    One build: an example of a library on a board with a compiler.

    Args:
        spec: Where the library comes from.
        library: The name of the library.
        files: The library, path inside its folder -> text.
        example: The name of the sketch.
        target: The board.
        compiler: The compiler.
    """

    spec: Path
    library: str
    files: Mapping[str, str]
    example: str
    target: Target
    compiler: Compiler


@dataclass(frozen=True)
class Outcome:
    """
    What came of a build.

    Args:
        flash_bytes: As the IDE reports it, of the whole sketch; ram_bytes: the same.
        warnings: Those about the library and its example, and the IDE's about the library.
        others: Those about other people's code but the core.
        needs: The header of a library that is not here; the example was left out then.
        failure: Why there is no program, or "".
    """

    flash_bytes: int = 0
    ram_bytes: int = 0
    warnings: tuple[str, ...] = ()
    others: tuple[str, ...] = ()
    needs: str = ""
    failure: str = ""

    @property
    def passed(self) -> bool:
        """
        Tell whether nothing is wrong with the library or its example.
        """
        return not self.warnings and not self.failure


def fitting(board: Board) -> tuple[tuple[Target, ...], dict[Target, str]]:
    """
    Return the boards of the core that a library for *board* fits, and why others do not.

    The others are those with the same chip and another clock; to other chips it is nothing.
    """
    fits, reasons = [], {}
    for target in targets():
        properties = board_properties(target)
        if properties.get("build.mcu") != board.mcu.name:
            continue
        f_cpu_hz = int(properties["build.f_cpu"].rstrip("L"))
        if f_cpu_hz == board.f_cpu_hz:
            fits.append(target)
        else:
            reasons[target] = f"{f_cpu_hz / 1e6:g} MHz, not {board.f_cpu_hz / 1e6:g} MHz"
    return tuple(fits), reasons


def examples(files: Mapping[str, str]) -> tuple[str, ...]:
    """
    Return the names of the examples among a library's files.
    """
    paths = map(PurePosixPath, files)
    return tuple(sorted(path.stem for path in paths if path.suffix == ".ino"))


@dataclass(frozen=True)
class Builds:
    """
    What there is to build.

    Args:
        jobs: All builds, by spec and board.
        unfit: Spec -> boards with its chip that it does not fit, and why.
    """

    jobs: tuple[Build, ...]
    unfit: Mapping[Path, Mapping[Target, str]]

    def github(self) -> dict[str, list[dict[str, str]]]:
        """
        Return the matrix of a GitHub workflow: a job for each board and compiler, with its specs.

        So each job compiles the core once; a job for each build would be more than GitHub takes.
        """
        specs: dict[tuple[str, str], list[str]] = {}
        for job in self.jobs:
            row = specs.setdefault((job.target.title, job.compiler.name), [])
            if str(job.spec) not in row:
                row.append(str(job.spec))
        return {
            "include": [
                {"board": board, "compiler": compiler, "specs": " ".join(row)}
                for (board, compiler), row in specs.items()
            ]
        }


def plan_builds(
    libraries: Iterable[tuple[Plan, Path, Mapping[str, str]]],
    compilers: Sequence[Compiler],
    boards: Sequence[str] = (),
) -> Builds:
    """
    Return what there is to build: each example of each library on each board that it fits.

    Args:
        libraries: The plan of each, its spec and its files.
        compilers: The compilers.
        boards: The boards to build for, as `Target.title` or FQBN has them; none for all.

    Raises:
        StepgenError: One of *boards* is none of the core's, or fits no library.
    """
    wanted = tuple(_target_called(name) for name in boards)
    jobs: list[Build] = []
    unfit = {}
    for plan, spec, files in libraries:
        fits, reasons = fitting(plan.board)
        unfit[spec] = {one: why for one, why in reasons.items() if not wanted or one in wanted}
        jobs += (
            Build(spec, plan.library.name, files, example, target, compiler)
            for target in fits
            if not wanted or target in wanted
            for compiler in compilers
            for example in examples(files)
        )
    built = {job.target for job in jobs}
    for target in wanted:
        if target not in built:
            raise StepgenError.of("none of the specs fits this board", text=target.title)
    return Builds(tuple(jobs), unfit)


def _target_called(name: str) -> Target:
    for target in targets():
        if name in (target.title, target.fqbn):
            return target
    known = ", ".join(target.title for target in targets())
    raise StepgenError.of(f"is no board of the Arduino core, which has {known}", text=name)


def run_jobs(
    jobs: Sequence[Build], libraries: Sequence[Path] = (), *, at_once: int = 1
) -> Iterator[tuple[Build, Outcome]]:
    """
    Build *jobs*, several at once, and yield each with its outcome as it is done.

    Args:
        jobs: What to build.
        libraries: Folders of other libraries, which examples may need.
        at_once: How many at once.
    """
    folders = tuple(folder.resolve() for folder in libraries)
    others = content_key(_contents(folders))
    with ThreadPoolExecutor(at_once) as pool:
        cores = {(job.target, job.compiler): job for job in jobs}
        list(pool.map(lambda pair: _core(*pair), cores))
        futures = {pool.submit(_outcome, job, folders, others): job for job in jobs}
        for future in as_completed(futures):
            yield futures[future], future.result()


def core_warnings(builds: Builds) -> dict[str, tuple[str, ...]]:
    """
    Return compiler -> what it warns about in the Arduino core, which is not ours.
    """
    found: dict[str, dict[str, None]] = {}
    for target, compiler in {(job.target, job.compiler): None for job in builds.jobs}:
        text = (_core(target, compiler) / _RESULT).read_text(encoding="utf-8")
        found.setdefault(compiler.name, {}).update(dict.fromkeys(json.loads(text)))
    return {name: tuple(lines) for name, lines in found.items()}


def _outcome(job: Build, libraries: Sequence[Path], others: str) -> Outcome:
    sources = {
        path: text
        for path, text in job.files.items()
        if not path.startswith("examples/") or path.startswith(f"examples/{job.example}/")
    }
    parts = [text for pair in sorted(sources.items()) for text in pair]
    key = content_key([_core_key(job.target, job.compiler), job.example, others, *parts])
    try:
        entry = build_once("ide-build", key, lambda out: _build(job, libraries, out))
    except StepgenError as error:
        reason = "; ".join(fault.reason for fault in error.faults)
        missing = _NO_HEADER.search(reason)
        return Outcome(needs=missing[1]) if missing else Outcome(failure=reason)
    fields = json.loads((entry / _RESULT).read_text(encoding="utf-8"))
    for name in ("warnings", "others"):
        fields[name] = tuple(fields[name])
    return Outcome(**fields)


def _build(job: Build, libraries: Sequence[Path], out: Path) -> None:
    own = _library(job)
    with tempfile.TemporaryDirectory(prefix="stepgen-ide-") as folder:
        built = build_with_ide(
            own / job.library / "examples" / job.example,
            own,
            job.target.fqbn,
            job.compiler,
            Path(folder),
            others=libraries,
            core_cache=_core(job.target, job.compiler),
        )
    outcome = Outcome(built.flash_bytes, built.ram_bytes, built.warnings, built.others)
    (out / _RESULT).write_text(json.dumps(asdict(outcome)), encoding="utf-8")


def _library(job: Build) -> Path:
    """
    Return a libraries folder with nothing but the library of *job* in it.
    """

    def write(folder: Path) -> None:
        for name, text in job.files.items():
            path = folder / job.library / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8", newline="")

    parts = [text for pair in sorted(job.files.items()) for text in pair]
    return build_once("ide-library", content_key([job.library, *parts]), write)


@functools.cache
def _core_key(target: Target, compiler: Compiler) -> str:
    return content_key([core_key(Toolchain(target, compiler)), target.fqbn, builder_version()])


def _core(target: Target, compiler: Compiler) -> Path:
    """
    Return a folder in which arduino-builder finds the core, compiled, and what it warned about.
    """

    def make(out: Path) -> None:
        with tempfile.TemporaryDirectory(prefix="stepgen-ide-") as folder:
            sketch = Path(folder) / "Blank" / "Blank.ino"
            sketch.parent.mkdir()
            sketch.write_text(_BLANK, encoding="ascii")
            empty, build_path = Path(folder) / "libraries", Path(folder) / "build"
            empty.mkdir()
            built = build_with_ide(
                sketch.parent, empty, target.fqbn, compiler, build_path, core_cache=out
            )
        (out / _RESULT).write_text(json.dumps(built.others), encoding="utf-8")

    return build_once("ide-core", _core_key(target, compiler), make)


def _contents(folders: Iterable[Path]) -> Iterator[str | bytes]:
    for folder in folders:
        for path in sorted(path for path in folder.rglob("*") if path.is_file()):
            yield str(path.relative_to(folder))
            yield path.read_bytes()

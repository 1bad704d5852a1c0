"""
What stepgen does, as Python functions: one for each command, of the same name.

`load`, `plan`, `render` and `check` take one spec and write nothing. `generate` takes several, too:
all faults of all specs are reported together, and nothing is written unless every spec is fine and
every target may be replaced. What the user can mend is raised as a `StepgenError`; nothing is
printed. docs/python.md shows each.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stepgen.datasheet.page import PATH as DATASHEET
from stepgen.datasheet.page import render_datasheet
from stepgen.devices import Board, find_board
from stepgen.devices import boards as all_boards
from stepgen.draft import Draft
from stepgen.errors import Fault, StepgenError
from stepgen.library.render import render_library
from stepgen.library.swap import os_errors, replace_file
from stepgen.library.write import (
    WriteResult,
    check_library,
    check_zip,
    refusals,
    write_library,
    zip_library,
    zip_refusals,
)
from stepgen.plan.model import Plan
from stepgen.plan.planner import make_plan
from stepgen.plan.warnings import PlanWarning, plan_warnings
from stepgen.spec import LoadedSpec, load_spec

if TYPE_CHECKING:
    from stepgen.lint import LintReport, Rule
    from stepgen.verify.doctor import Diagnosis
    from stepgen.verify.ide_matrix import Build, Builds
    from stepgen.verify.ide_matrix import Outcome as BuildOutcome
    from stepgen.verify.report import SpecReport
    from stepgen.verify.runner import Outcome

__all__ = [
    "Board",
    "Draft",
    "Fault",
    "Job",
    "LoadedSpec",
    "Plan",
    "PlanWarning",
    "Rendered",
    "StepgenError",
    "WriteResult",
    "board",
    "boards",
    "build",
    "check",
    "core_warnings",
    "datasheet",
    "doctor",
    "generate",
    "init",
    "lint",
    "lint_not_checked",
    "lint_rules",
    "load",
    "matrix",
    "plan",
    "plan_builds",
    "render",
    "render_all",
    "schema",
    "simulate",
    "stale",
    "tolerances",
    "usable_simulators",
    "verify",
]

TrackScenarios = Callable[[Sequence[Any]], Iterable[Any]]
"""Passes the scenarios of a verification on one by one, to show progress."""

Track = Callable[[Sequence[Path]], Iterable[Path]]
"""Passes the specs on one by one, to show progress; such as ``rich.progress.track``."""

Job = tuple[Path, str, str]
"""Spec, compiler and simulator of one verification of `matrix`."""


@dataclass(frozen=True)
class Rendered:
    """
    The library of one spec, not yet written: its files, path -> text.
    """

    loaded: LoadedSpec
    plan: Plan
    files: dict[str, str]

    @property
    def name(self) -> str:
        """
        Return the library's name, which is also that of its folder.
        """
        return self.plan.library.name


def boards() -> tuple[Board, ...]:
    """
    Return the boards that stepgen knows, in the order of their names.
    """
    return all_boards()


def board(name: str) -> Board:
    """
    Return the board *name*: its chip, clock, pins, ports and timers.

    Raises:
        StepgenError: There is none of that name; the message lists those that there are.
    """
    found = find_board(name)
    if found is None:
        names = ", ".join(known.name for known in all_boards())
        raise StepgenError.of(
            f"is no board that stepgen knows; choose one of {names}", text=name[:80]
        )
    return found


def init(draft: Draft, path: Path, *, force: bool = False) -> None:
    """
    Write a first spec of one motor, with comments.

    Args:
        draft: What it shall say; each part has a default.
        path: The file; one that is there already is overwritten only with *force*.
        force: See there.

    Raises:
        StepgenError: The spec would be refused, or the file cannot be written.
    """
    if path.exists() and not force:
        reason = "is there already; name another file, or overwrite it with --force"
        raise StepgenError.of(reason, place=str(path))
    draft.plan(path.name)
    with os_errors(path):
        replace_file(draft.text(path.name).encode(), path)


def load(path: Path) -> LoadedSpec:
    """
    Load the spec in *path* and check its shape and its local rules.

    Raises:
        StepgenError: All faults of the spec, each with its place and a way out.
    """
    return load_spec(path)


def plan(path: Path) -> Plan:
    """
    Return what stepgen decides for the spec in *path*: every number, every conflict.

    Raises:
        StepgenError: All faults and conflicts of the spec.
    """
    return make_plan(load_spec(path))


def check(path: Path) -> tuple[PlanWarning, ...]:
    """
    Validate the spec in *path*; return what its motors keep from libraries that it does not name.

    Raises:
        StepgenError: All faults and conflicts of the spec, each with its place and a way out.
    """
    return plan_warnings(plan(path))


def render(path: Path) -> dict[str, str]:
    """
    Return the library of the spec in *path*, path inside the library -> text.

    Raises:
        StepgenError: All faults and conflicts of the spec.
    """
    return _render(path).files


def render_all(paths: Sequence[Path], *, track: Track = iter) -> tuple[Rendered, ...]:
    """
    Return the library of each spec in *paths*, in their order.

    Raises:
        StepgenError: All faults of all specs, and each name that two libraries share.
    """
    faults: list[Fault] = []
    made = []
    for path in track(paths):
        try:
            made.append(_render(path))
        except StepgenError as error:
            faults += error.faults
    faults += _shared_names(made)
    if faults:
        raise StepgenError(faults)
    return tuple(made)


def generate(
    paths: Path | Sequence[Path],
    output_dir: Path = Path(),
    *,
    zipped: bool = False,
    force: bool = False,
    track: Track = iter,
) -> tuple[WriteResult, ...]:
    """
    Write the library of each spec in *paths* to ``output_dir/<name>``; return what was done.

    Args:
        paths: One spec or several.
        output_dir: The folder of the libraries' folders; it is made if missing.
        zipped: Write ``output_dir/<name>.zip`` instead of a folder.
        force: Also overwrite files of stepgen's that somebody has edited; never others.
        track: Shows progress.

    Raises:
        StepgenError: All faults of all specs, or why targets are refused. Nothing was written
            then; only when the disk itself fails can earlier libraries of the call be there.
    """
    made = render_all(_several(paths), track=track)
    faults = [
        fault
        for library in made
        for fault in _refusals(library, output_dir, zipped=zipped, force=force)
    ]
    if faults:
        raise StepgenError(faults)
    return tuple(_write(library, output_dir, zipped=zipped, force=force) for library in made)


def stale(
    paths: Path | Sequence[Path],
    output_dir: Path = Path(),
    *,
    zipped: bool = False,
    track: Track = iter,
) -> dict[Path, list[str]]:
    """
    Return what is stale, missing or extra in each library that `generate` would write.

    Args:
        paths: As of `generate`.
        output_dir: As of `generate`.
        zipped: As of `generate`.
        track: Shows progress.

    Returns:
        The library's folder or zip -> a line for each difference; no lines where it is fresh.

    Raises:
        StepgenError: All faults of all specs, or what cannot be read.
    """
    found = {}
    for library in render_all(_several(paths), track=track):
        target = _target(library, output_dir, zipped=zipped)
        found[target] = (
            check_zip(library.files, library.name, target)
            if zipped
            else check_library(library.files, target)
        )
    return found


def schema() -> dict[str, Any]:
    """
    Return the JSON Schema of a spec, for editors; every valid spec fits it.
    """
    from stepgen.schema import json_schema  # noqa: PLC0415 - generating needs none

    return json_schema()


def lint(path: Path) -> "LintReport":
    """
    Check the library folder *path* against the rules of the Arduino library manager.

    Raises:
        StepgenError: It is no folder, or cannot be read.
    """
    from stepgen.lint import lint as lint_folder  # noqa: PLC0415 - generating needs none

    return lint_folder(path)


def lint_rules() -> "tuple[Rule, ...]":
    """
    Return every rule of `lint`, in the order of their names.
    """
    from stepgen.lint.linter import RULES  # noqa: PLC0415 - the same

    return RULES


def lint_not_checked() -> tuple[tuple[str, str], ...]:
    """
    Return the rules of Arduino Lint that `lint` cannot check, and what they are about.
    """
    from stepgen.lint.linter import NOT_CHECKED  # noqa: PLC0415 - the same

    return NOT_CHECKED


def verify(
    path: Path,
    *,
    compiler: str | None = None,
    simulator: str = "simavr",
    track: TrackScenarios = iter,
) -> "SpecReport":
    """
    Prove the library of the spec in *path*: compile, simulate, compare with the model, measure.

    Args:
        path: The spec.
        compiler: ``gcc-5.4`` or ``gcc-7.3``; without it the avr-gcc on the PATH.
        simulator: ``simavr``, ``avr8js`` or ``yasimavr``.
        track: Shows progress; passes the scenarios on one by one.

    Raises:
        StepgenError: The spec is refused, a tool is missing, the library does not compile, or
            its firmware crashes; or the simulator is unlike the chip in what the spec depends on.
    """
    from stepgen.verify.simulators import (  # noqa: PLC0415 - generating needs no simulator
        simulator_named,
    )
    from stepgen.verify.toolchain import compiler_named, default_compiler  # noqa: PLC0415 - same
    from stepgen.verify.verification import verify_spec  # noqa: PLC0415 - the same

    chosen = compiler_named(compiler) if compiler else default_compiler()
    return verify_spec(load_spec(path), chosen, simulator=simulator_named(simulator), track=track)


def plan_builds(
    libraries: Sequence[Rendered], *, compilers: Sequence[str] = (), boards: Sequence[str] = ()
) -> "Builds":
    """
    Return what the IDE has to build of *libraries*: each example for each board that it fits.

    Args:
        libraries: What `render_all` returns.
        compilers: Names; none for all that are here.
        boards: Boards of the Arduino core, such as ``uno`` or ``nano:atmega328``; none for all.

    Raises:
        StepgenError: There is no Arduino core, or no such compiler or board.
    """
    from stepgen.verify.ide_matrix import plan_builds as plan_them  # noqa: PLC0415 - as in verify
    from stepgen.verify.toolchain import compiler_named, find_compilers  # noqa: PLC0415 - same

    chosen = [compiler_named(name) for name in compilers] or find_compilers()
    return plan_them(
        ((one.plan, one.loaded.document.path, one.files) for one in libraries), chosen, boards
    )


def build(
    builds: "Builds", *, libraries: Sequence[Path] = (), jobs: int = 1
) -> "Iterator[tuple[Build, BuildOutcome]]":
    """
    Have the Arduino IDE's engine build *builds*, *jobs* at once; yield each as it is done.

    *libraries* are folders of further libraries, such as a sketchbook's, for examples that need
    them.

    Raises:
        StepgenError: arduino-builder or the Arduino core is missing.
    """
    from stepgen.verify.ide_matrix import run_jobs  # noqa: PLC0415 - as in verify

    return run_jobs(builds.jobs, libraries, at_once=jobs)


def core_warnings(builds: "Builds") -> dict[str, tuple[str, ...]]:
    """
    Return compiler -> its warnings about the Arduino core, for the boards of *builds*.
    """
    from stepgen.verify.ide_matrix import core_warnings as warn  # noqa: PLC0415 - as in verify

    return warn(builds)


def datasheet(path: Path, *, report: "SpecReport | None" = None) -> str:
    """
    Return the page about the library of the spec in *path*, as HTML.

    Args:
        path: The spec.
        report: What `verify` found for it; without it the page says that nothing is verified yet.

    Raises:
        StepgenError: All faults and conflicts of the spec.
    """
    from stepgen.datasheet.report import Report  # noqa: PLC0415 - generating has no report

    loaded = load_spec(path)
    found = None if report is None else Report.model_validate(report.as_json())
    return render_datasheet(make_plan(loaded), loaded.document.text, found)


def tolerances() -> dict[str, int]:
    """
    Return the simulators that are here -> how many cycles from the model's an edge may be there.
    """
    from stepgen.verify.simulators import installed  # noqa: PLC0415 - as in verify

    return {simulator.name: simulator.tolerance_cycles for simulator in installed()}


def usable_simulators(path: Path, *, compiler: str | None = None) -> dict[str, str]:
    """
    Return every simulator that stepgen knows -> why it is not used for the spec in *path*.

    A simulator that may be used has the reason "".

    Raises:
        StepgenError: The spec is refused, or there is no compiler.
    """
    from stepgen.verify.conformance.needs import refusal  # noqa: PLC0415 - as in verify
    from stepgen.verify.simulators import SIMULATORS  # noqa: PLC0415 - the same
    from stepgen.verify.toolchain import compiler_named, default_compiler  # noqa: PLC0415 - same

    chosen = compiler_named(compiler) if compiler else default_compiler()
    decided = make_plan(load_spec(path))
    return {simulator.name: refusal(decided, simulator, chosen) for simulator in SIMULATORS}


def matrix(
    paths: Sequence[Path],
    *,
    compilers: Sequence[str] = (),
    simulators: Sequence[str] | None = None,
    jobs: int = 1,
    track: Callable[[Any], Iterable[Any]] = iter,
) -> "dict[Job, SpecReport | str]":
    """
    Verify each spec in *paths* with each compiler, on each simulator.

    What passed before is taken from the cache while nothing changes that it depends on.

    Args:
        paths: The specs.
        compilers: Their names; without them all that are here.
        simulators: Their names; without them all that are here, as far as each fits the spec.
        jobs: How many verifications run at once, each in a process of its own.
        track: Shows progress; passes on what has a length, in the order of its end.

    Returns:
        Spec, compiler and simulator -> the report, or why that simulator cannot be used there.

    Raises:
        StepgenError: All faults of all specs, or as of `verify`.
    """
    render_all(paths)
    from stepgen.verify.parallel import in_processes  # noqa: PLC0415 - as in verify
    from stepgen.verify.toolchain import find_compilers  # noqa: PLC0415 - the same

    names = [*tolerances()] if simulators is None else simulators
    chosen = compilers or [compiler.name for compiler in find_compilers()]
    wanted = [(path, compiler, name) for path in paths for compiler in chosen for name in names]
    work = _verify_where_possible if simulators is None else _verify
    return in_processes(work, wanted, jobs, track)


def doctor(*, track: Callable[[Sequence[Any]], Iterable[Any]] = iter) -> "Diagnosis":
    """
    Return which compilers and simulators are here, and how far each simulator can be trusted.

    *track* passes the points of the conformance suite on one by one, to show progress.
    """
    from stepgen.verify.doctor import diagnose  # noqa: PLC0415 - as in verify

    return diagnose(track)


def simulate(
    path: Path, scenario: Path | None = None, *, compiler: str | None = None
) -> "tuple[Plan, Outcome]":
    """
    Run one scenario of the spec in *path* on a simulated chip.

    Args:
        path: The spec.
        scenario: A YAML file with calls and waits; without it a few steps there and back.
        compiler: As of `verify`.

    Raises:
        StepgenError: As of `verify`, and the faults of the scenario.
    """
    from stepgen.verify.simulation import simulate_spec  # noqa: PLC0415 - the same as in verify

    return simulate_spec(load_spec(path), scenario, compiler)


def _verify(path: Path, compiler: str, simulator: str) -> "SpecReport | str":
    return _remembered(path, compiler, simulator, may_refuse=False)


def _verify_where_possible(path: Path, compiler: str, simulator: str) -> "SpecReport | str":
    """
    Return the report, or why *simulator* cannot be used for the spec in *path*.
    """
    return _remembered(path, compiler, simulator, may_refuse=True)


def _remembered(
    path: Path, compiler: str, simulator: str, *, may_refuse: bool
) -> "SpecReport | str":
    from stepgen.verify.remembered import remembered_report  # noqa: PLC0415 - as in verify
    from stepgen.verify.simulators import simulator_named  # noqa: PLC0415 - the same
    from stepgen.verify.toolchain import compiler_named  # noqa: PLC0415 - the same

    tools = (compiler_named(compiler), simulator_named(simulator))
    return remembered_report(load_spec(path), *tools, may_refuse=may_refuse)


def _several(paths: Path | Sequence[Path]) -> Sequence[Path]:
    return [paths] if isinstance(paths, Path) else paths


def _render(path: Path) -> Rendered:
    loaded = load_spec(path)
    decided = make_plan(loaded)
    text = loaded.document.text
    files = {**render_library(decided, text), DATASHEET: render_datasheet(decided, text)}
    return Rendered(loaded, decided, dict(sorted(files.items())))


def _shared_names(made: Sequence[Rendered]) -> Iterable[Fault]:
    """
    Yield a fault for each library whose folder an earlier one has; case does not tell folders.
    """
    first: dict[str, Rendered] = {}
    for library in made:
        earlier = first.setdefault(library.name.lower(), library)
        if earlier is not library:
            other = earlier.loaded.document.path
            yield library.loaded.fault(
                ("library", "name"),
                f"is the library of {other} too, and each needs a folder of its own; "
                "rename one of them, or write them in two runs to two folders",
            )


def _target(library: Rendered, output_dir: Path, *, zipped: bool) -> Path:
    return output_dir / (f"{library.name}.zip" if zipped else library.name)


def _refusals(library: Rendered, output_dir: Path, *, zipped: bool, force: bool) -> list[Fault]:
    target = _target(library, output_dir, zipped=zipped)
    if zipped:
        return zip_refusals(library.name, target)
    return refusals(library.files, target, force=force)


def _write(library: Rendered, output_dir: Path, *, zipped: bool, force: bool) -> WriteResult:
    target = _target(library, output_dir, zipped=zipped)
    if zipped:
        existed = target.exists()
        done = (target.name,)
        if not zip_library(library.files, library.name, target):
            return WriteResult(target, unchanged=done)
        return WriteResult(target, changed=done) if existed else WriteResult(target, written=done)
    return write_library(library.files, target, force=force)

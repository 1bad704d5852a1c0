"""
``stepgen matrix``: every spec with every compiler, side by side.
"""

import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from stepgen import api
from stepgen.commands.report import FAILED, complain, print_tables, progress
from stepgen.errors import StepgenError

if TYPE_CHECKING:
    from stepgen.verify.report import SpecReport

EXAMPLE = "Example: stepgen matrix --jobs 2"

_DEFAULT_FOLDER = Path("specs")
_ALL = "all"
_FIGURES = ("spec", "compiler", "flash", "RAM", "a step", "longest")


def matrix(
    specs: Annotated[
        list[Path] | None,
        typer.Argument(metavar="[SPEC]...", help="YAML files; without any, specs/*.yaml."),
    ] = None,
    *,
    jobs: Annotated[
        int, typer.Option("--jobs", "-j", min=1, metavar="N", help="How many at once.")
    ] = os.cpu_count() or 1,
    simulator: Annotated[
        str,
        typer.Option(
            "--simulator", metavar="NAME", help="simavr, avr8js, yasimavr, or all that are here."
        ),
    ] = "simavr",
) -> None:
    """
    Compile and verify every spec with every compiler that is installed, and show it in tables.

    A column for each simulator says whether all edges are where the model has them, to the cycle
    or to the cycles in its heading; - that it cannot be used for the spec, with the reason below
    the tables. Then flash and RAM in bytes over an empty sketch, cycles a step takes, and the
    longest interrupt.

    Exit code 1 if any of them fails.
    """
    paths = specs or sorted(_DEFAULT_FOLDER.glob("*.yaml"))
    if not paths:
        raise StepgenError.of("no spec in specs/; name the specs", place=str(_DEFAULT_FOLDER))
    chosen = None if simulator == _ALL else [simulator]
    with progress("verifying") as track:
        results = api.matrix(paths, simulators=chosen, jobs=jobs, track=track)
    pairs = list(dict.fromkeys((path, compiler) for path, compiler, _ in results))
    simulators = list(dict.fromkeys(name for _, _, name in results))
    verdicts = ("spec", "compiler", *map(_title, simulators))
    print_tables(
        [
            ("", verdicts, [_verdict_row(*pair, simulators, results) for pair in pairs]),
            ("", _FIGURES, [_figure_row(*pair, simulators, results) for pair in pairs]),
        ]
    )
    _say_what_is_left_out(results)
    failed = [one for one in results.values() if not isinstance(one, str) and not one.passed]
    for report in failed:
        _say_failures(report)
    if failed:
        raise typer.Exit(FAILED)


def _title(simulator: str) -> str:
    tolerance_cycles = api.tolerances().get(simulator, 0)
    return f"{simulator} +-{tolerance_cycles}" if tolerance_cycles else simulator


def _verdict_row(
    path: Path, compiler: str, simulators: list[str], results: dict[api.Job, "SpecReport | str"]
) -> tuple[str, ...]:
    """
    Return the row of one spec and compiler, with the verdict of each simulator.
    """
    verdicts = (_verdict(results[path, compiler, name]) for name in simulators)
    return (path.stem, compiler, *verdicts)


def _figure_row(
    path: Path, compiler: str, simulators: list[str], results: dict[api.Job, "SpecReport | str"]
) -> tuple[str, ...]:
    """
    Return the row of one spec and compiler; the figures are those of the first simulator.
    """
    of_each = [results[path, compiler, name] for name in simulators]
    report = next((one for one in of_each if not isinstance(one, str)), None)
    if report is None:
        raise StepgenError.of("no simulator can be used for this spec", place=str(path))
    motors = report.motors.values()
    return (
        path.stem,
        compiler,
        str(report.flash_bytes),
        str(report.ram_bytes),
        f"{max(motor.cycles_per_step for motor in motors):g}",
        str(max(motor.measured_max for motor in motors)),
    )


def _verdict(result: "SpecReport | str") -> str:
    if isinstance(result, str):
        return "-"
    return "passed" if result.passed else "FAILED"


def _say_what_is_left_out(results: dict[api.Job, "SpecReport | str"]) -> None:
    """
    Say each reason for which a simulator was not used, once, and for which specs.
    """
    specs: dict[str, list[str]] = {}
    for (path, _, _), result in results.items():
        if isinstance(result, str) and path.stem not in specs.setdefault(result, []):
            specs[result].append(path.stem)
    for reason, stems in specs.items():
        complain(f"left out: {reason}: {', '.join(stems)}")


def _say_failures(report: "SpecReport") -> None:
    tools = f"{report.compiler}, {report.simulator}"
    for check in report.checks:
        if not check.passed:
            complain(f"{report.spec} ({tools}): {check.name}: {check.detail}")

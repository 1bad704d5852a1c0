"""
``stepgen matrix``: every spec with every compiler, side by side.
"""

import os
from collections.abc import Iterator
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
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
_HEADING = ("spec", "compiler", "result", "flash", "RAM", "a step", "longest")


def matrix(
    specs: Annotated[
        list[Path] | None,
        typer.Argument(metavar="[SPEC]...", help="YAML files; without any, specs/*.yaml."),
    ] = None,
    *,
    jobs: Annotated[
        int, typer.Option("--jobs", "-j", min=1, metavar="N", help="How many at once.")
    ] = os.cpu_count() or 1,
) -> None:
    """
    Compile and verify every spec with every compiler that is installed, and show a table.

    Flash and RAM in bytes over an empty sketch; cycles a step takes, and the longest interrupt.

    Exit code 1 if any of them fails.
    """
    paths = specs or sorted(_DEFAULT_FOLDER.glob("*.yaml"))
    if not paths:
        raise StepgenError.of("no spec in specs/; name the specs", place=str(_DEFAULT_FOLDER))
    api.generate_all(paths)
    from stepgen.verify.toolchain import find_compilers  # noqa: PLC0415 - only needed here

    pairs = [(path, compiler.name) for path in paths for compiler in find_compilers()]
    with ProcessPoolExecutor(max_workers=jobs) as pool:
        futures = {pool.submit(_verify, path, name): (path, name) for path, name in pairs}
        with progress("verifying") as track:
            for _ in track(_Finishing(futures)):
                pass
    reports = {pair: future.result() for future, pair in futures.items()}
    print_tables([("", _HEADING, [_row(reports[pair]) for pair in pairs])])
    failed = [reports[pair] for pair in pairs if not reports[pair].passed]
    for report in failed:
        for check in report.checks:
            if not check.passed:
                complain(f"{report.spec} ({report.compiler}): {check.name}: {check.detail}")
    if failed:
        raise typer.Exit(FAILED)


class _Finishing:
    """
    The futures in the order in which they finish, with a length for the progress bar.
    """

    def __init__(self, futures: dict[Future["SpecReport"], tuple[Path, str]]) -> None:
        self._futures = futures

    def __len__(self) -> int:
        return len(self._futures)

    def __iter__(self) -> Iterator[Future["SpecReport"]]:
        return as_completed(self._futures)


def _verify(path: Path, compiler: str) -> "SpecReport":
    return api.verify(path, compiler=compiler)


def _row(report: "SpecReport") -> tuple[str, ...]:
    motors = report.motors.values()
    return (
        Path(report.spec).stem,
        report.compiler,
        "passed" if report.passed else "FAILED",
        str(report.flash_bytes),
        str(report.ram_bytes),
        f"{max(motor.cycles_per_step for motor in motors):g}",
        str(max(motor.measured_max for motor in motors)),
    )

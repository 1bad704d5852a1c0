"""
The part of ``stepgen matrix`` that verifies: spec by compiler by simulator.
"""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from stepgen import api
from stepgen.commands.matrix_section import Section
from stepgen.commands.report import progress
from stepgen.errors import StepgenError

if TYPE_CHECKING:
    from stepgen.verify.junit import Case
    from stepgen.verify.report import SpecReport

_ALL = "all"
_FIGURES = ("flash", "RAM", "a step", "longest")

_Results = Mapping[api.Job, "SpecReport | str"]


def section(paths: Sequence[Path], compilers: Sequence[str], simulator: str, jobs: int) -> Section:
    """
    Verify each of *paths* with each compiler, or all, on *simulator*, a name or ``all``.
    """
    chosen = None if simulator == _ALL else [simulator]
    with progress("verifying") as track:
        results = api.matrix(paths, compilers=compilers, simulators=chosen, jobs=jobs, track=track)
    simulators = list(dict.fromkeys(name for _, _, name in results))
    used = list(dict.fromkeys(compiler for _, compiler, _ in results))
    rows: list[tuple[str, ...]] = []
    for path in paths:
        rows.append((path.stem,))
        rows += (_row(path, compiler, simulators, results) for compiler in used)
    heading = ("", *map(_title, simulators), *_FIGURES)
    return Section(
        "verification",
        (("Verified", heading, rows),),
        (*_left_out(results), *_failures(results)),
        tuple(_cases(results)),
    )


def _title(simulator: str) -> str:
    tolerance_cycles = api.tolerances().get(simulator, 0)
    return f"{simulator} +-{tolerance_cycles}" if tolerance_cycles else simulator


def _row(path: Path, compiler: str, simulators: list[str], results: _Results) -> tuple[str, ...]:
    """
    Return the row of one spec and compiler; the figures are those of the first simulator.
    """
    of_each = [results[path, compiler, name] for name in simulators]
    report = next((one for one in of_each if not isinstance(one, str)), None)
    if report is None:
        raise StepgenError.of("no simulator can be used for this spec", place=str(path))
    motors = report.motors.values()
    return (
        f"  {compiler}",
        *map(_verdict, of_each),
        str(report.flash_bytes),
        str(report.ram_bytes),
        f"{max(motor.cycles_per_step for motor in motors):g}",
        str(max(motor.measured_max for motor in motors)),
    )


def _verdict(result: "SpecReport | str") -> str:
    if isinstance(result, str):
        return "-"
    return "passed" if result.passed else "FAILED"


def _left_out(results: _Results) -> Iterator[str]:
    """
    Yield each reason for which a simulator was not used, once, and for which specs.
    """
    specs: dict[str, list[str]] = {}
    for (path, _, _), result in results.items():
        if isinstance(result, str) and path.stem not in specs.setdefault(result, []):
            specs[result].append(path.stem)
    for reason, stems in specs.items():
        yield f"left out: {reason}: {', '.join(stems)}"


def _failures(results: _Results) -> Iterator[str]:
    for report in results.values():
        if isinstance(report, str):
            continue
        tools = f"{report.compiler}, {report.simulator}"
        for check in report.checks:
            if not check.passed:
                yield f"{report.spec} ({tools}): {check.name}: {check.detail}"


def _cases(results: _Results) -> "Iterator[Case]":
    from stepgen.verify.junit import Case  # noqa: PLC0415 - generating needs none

    for (path, compiler, simulator), result in results.items():
        group = f"{path.stem} ({compiler}, {simulator})"
        if isinstance(result, str):
            yield Case(group, "verification", skipped=result)
            continue
        for check in result.checks:
            yield Case(group, check.name, failure="" if check.passed else check.detail)
        if not result.checks:
            yield Case(group, "verification", failure="nothing was checked")

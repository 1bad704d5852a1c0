"""
The part of ``stepgen matrix`` that builds: every example on every board of the Arduino core.
"""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from stepgen import api
from stepgen.commands.matrix_section import Section
from stepgen.commands.report import progress

if TYPE_CHECKING:
    from stepgen.verify.ide_matrix import Build, Builds, Outcome
    from stepgen.verify.junit import Case

    _Results = Mapping[Build, Outcome]

_COUNT = "examples"


def section(plan: "Builds", libraries: Sequence[Path], jobs: int) -> Section:
    """
    Build all that is in *plan*, with *libraries* for the examples that need them.
    """
    with progress("building") as track:
        done = dict(track(_Building(plan, libraries, jobs)))
    results = {job: done[job] for job in plan.jobs}
    return Section(
        "builds",
        (_table(results),),
        (
            *_of_core(plan),
            *_others(results),
            *_unfit(plan),
            *_left_out(results),
            *_failures(results),
        ),
        tuple(_cases(results)),
    )


class _Building:
    """
    The builds as they are done, with a length for the progress bar.
    """

    def __init__(self, plan: "Builds", libraries: Sequence[Path], jobs: int) -> None:
        self._plan, self._libraries, self._jobs = plan, libraries, jobs

    def __len__(self) -> int:
        return len(self._plan.jobs)

    def __iter__(self) -> "Iterator[tuple[Build, Outcome]]":
        return api.build(self._plan, libraries=self._libraries, jobs=self._jobs)


def _table(results: "_Results") -> tuple[str, Sequence[str], Sequence[Sequence[str]]]:
    compilers = list(dict.fromkeys(job.compiler.name for job in results))
    heading = ["", _COUNT]
    for compiler in compilers:
        heading += [compiler, "RAM"]
    rows: list[list[str]] = []
    for spec, targets in _by_spec(results).items():
        rows.append([spec])
        for title, outcomes in targets.items():
            built = {job.example for job, outcome in outcomes.items() if not outcome.needs}
            row = [f"  {title}", str(len(built))]
            for compiler in compilers:
                row += _sizes([o for job, o in outcomes.items() if job.compiler.name == compiler])
            rows.append(row)
    return ("Built by arduino-builder: flash and RAM of the largest example", heading, rows)


def _by_spec(results: "_Results") -> "dict[str, dict[str, dict[Build, Outcome]]]":
    found: dict[str, dict[str, dict[Build, Outcome]]] = {}
    for job, outcome in results.items():
        targets = found.setdefault(job.spec.stem, {})
        targets.setdefault(job.target.title, {})[job] = outcome
    return found


def _sizes(outcomes: "Sequence[Outcome]") -> tuple[str, str]:
    if not all(outcome.passed for outcome in outcomes):
        return "FAILED", ""
    largest = max(outcomes, key=lambda outcome: outcome.flash_bytes)
    return str(largest.flash_bytes), str(largest.ram_bytes)


def _unfit(plan: "Builds") -> Iterator[str]:
    """
    Yield each board with the chip of a spec that the spec does not fit, and why.
    """
    specs: dict[str, list[str]] = {}
    for spec, reasons in plan.unfit.items():
        for why in dict.fromkeys(reasons.values()):
            titles = ", ".join(target.title for target, reason in reasons.items() if reason == why)
            specs.setdefault(f"{titles} ({why})", []).append(spec.stem)
    for boards, stems in specs.items():
        yield f"does not fit {boards}: {', '.join(stems)}"


def _left_out(results: "_Results") -> Iterator[str]:
    needs: dict[str, list[str]] = {}
    for job, outcome in results.items():
        name = f"{job.example} of {job.spec.stem}"
        if outcome.needs and name not in needs.setdefault(outcome.needs, []):
            needs[outcome.needs].append(name)
    for header, names in needs.items():
        yield (
            f"left out, since no library has {header}: {', '.join(names)}; install it and name "
            "its folder with --libraries"
        )


def _of_core(plan: "Builds") -> Iterator[str]:
    for compiler, lines in api.core_warnings(plan).items():
        files = ", ".join(sorted({Path(line.partition(":")[0]).name for line in lines}))
        if lines:
            yield f"not ours: {len(lines)} warnings of {compiler} about the Arduino core ({files})"


def _others(results: "_Results") -> Iterator[str]:
    """
    Yield what is warned about in other people's code, which fails nothing.
    """
    found = [line for outcome in results.values() for line in outcome.others]
    for line in dict.fromkeys(found):
        yield f"not ours: {line}"


def _failures(results: "_Results") -> Iterator[str]:
    """
    Yield what is wrong, once, with the first build in which it is and how many more there are.
    """
    places: dict[str, list[str]] = {}
    for job, outcome in results.items():
        for line in (*outcome.warnings, *filter(None, [outcome.failure])):
            places.setdefault(line, []).append(_place(job))
    for line, found in places.items():
        more = f", and {len(found) - 1} builds more" if found[1:] else ""
        yield f"{found[0]}{more}: {line}"


def _place(job: "Build") -> str:
    return f"{job.spec}: {job.example} ({job.target.title}, {job.compiler.name})"


def _cases(results: "_Results") -> "Iterator[Case]":
    from stepgen.verify.junit import Case  # noqa: PLC0415 - generating needs none

    for job, outcome in results.items():
        wrong = "\n".join((*outcome.warnings, *filter(None, [outcome.failure])))
        left_out = f"no library has {outcome.needs}" if outcome.needs else ""
        group = f"{job.spec.stem} on {job.target.title} ({job.compiler.name})"
        yield Case(group, job.example, failure=wrong, skipped=left_out)

"""
``stepgen matrix``: every spec with every compiler, on simulators and built by the Arduino IDE.
"""

import json
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from stepgen import api
from stepgen.commands import matrix_builds, matrix_reports
from stepgen.commands.matrix_section import Section
from stepgen.commands.report import FAILED, complain, print_tables, say
from stepgen.errors import StepgenError
from stepgen.library.swap import os_errors

EXAMPLE = "Example: stepgen matrix --jobs 2"

_DEFAULT_FOLDER = Path("specs")


def matrix(  # noqa: PLR0913 - the options of a command
    specs: Annotated[
        list[Path] | None,
        typer.Argument(metavar="[SPEC]...", help="YAML files; without any, specs/*.yaml."),
    ] = None,
    *,
    verify: Annotated[
        bool, typer.Option("--verify/--no-verify", help="Compare with the model on simulators.")
    ] = True,
    builds: Annotated[
        bool, typer.Option("--builds/--no-builds", help="Build with the Arduino IDE's engine.")
    ] = True,
    simulator: Annotated[
        str,
        typer.Option(
            "--simulator", metavar="NAME", help="simavr, avr8js, yasimavr, or all that are here."
        ),
    ] = "simavr",
    compilers: Annotated[
        list[str] | None,
        typer.Option("--compiler", metavar="NAME", help="gcc-5.4 or gcc-7.3; default: all here."),
    ] = None,
    boards: Annotated[
        list[str] | None,
        typer.Option(
            "--board",
            metavar="NAME",
            help="Build for this board of the Arduino core only, such as uno or nano:atmega328.",
        ),
    ] = None,
    libraries: Annotated[
        list[Path] | None,
        typer.Option(
            "--libraries",
            metavar="DIR",
            exists=True,
            file_okay=False,
            help="Other libraries that examples need, such as ~/Arduino/libraries with Servo.",
        ),
    ] = None,
    jobs: Annotated[
        int, typer.Option("--jobs", "-j", min=1, metavar="N", help="How many at once.")
    ] = os.cpu_count() or 1,
    junit: Annotated[
        Path | None,
        typer.Option("--junit", metavar="FILE", help="Write a JUnit report, too."),
    ] = None,
    github: Annotated[
        bool,
        typer.Option(
            "--github", help="Print the matrix of a GitHub workflow for the builds, build nothing."
        ),
    ] = False,
) -> None:
    """
    Verify every spec with every compiler, and build every example for every board it fits.

    The first table is of verification: whether all edges are where the model has them, to the
    cycle or to the cycles in a simulator's heading; - that it cannot be used for the spec. Flash
    and RAM in bytes over an empty sketch; cycles a step takes, and the longest interrupt.

    The second is of arduino-builder, the engine of the Arduino IDE 1.8: each example on each board
    of the Arduino core with the spec's chip and clock. Flash and RAM are those of the largest
    example. A warning about the library or an example counts as a failure. An example whose
    library is in no folder of --libraries is left out.

    What passed is kept in the cache and not done again while nothing changes.

    Exit code 1 if anything fails.
    """
    paths = specs or sorted(_DEFAULT_FOLDER.glob("*.yaml"))
    if not paths:
        raise StepgenError.of("no spec in specs/; name the specs", place=str(_DEFAULT_FOLDER))
    if not (verify or builds):
        raise StepgenError.of("--no-verify and --no-builds leave nothing to do; remove one")
    made = api.render_all(paths)
    # Before anything runs: it refuses boards and compilers that are not there.
    plan = api.plan_builds(made, compilers=compilers or (), boards=boards or ())
    if github:
        say(json.dumps(plan.github()))
        return
    sections = []
    if verify:
        sections.append(matrix_reports.section(paths, compilers or (), simulator, jobs))
    if builds:
        sections.append(matrix_builds.section(plan, libraries or (), jobs))
    _show(sections)
    if junit:
        _write_junit(sections, junit)
    if any(case.failure for section in sections for case in section.cases):
        raise typer.Exit(FAILED)


def _show(sections: Sequence[Section]) -> None:
    print_tables([table for section in sections for table in section.tables])
    for section in sections:
        for note in section.notes:
            complain(note)


def _write_junit(sections: Sequence[Section], path: Path) -> None:
    from stepgen.verify.junit import junit_xml  # noqa: PLC0415 - generating needs none

    text = junit_xml((section.title, section.cases) for section in sections)
    with os_errors(path):
        path.write_text(text, encoding="utf-8")

"""
``stepgen check``: validates specs.
"""

from collections.abc import Iterable
from pathlib import Path
from typing import Annotated

import typer

from stepgen import api
from stepgen.commands.report import WRONG, complain, printable, report_faults, say
from stepgen.errors import StepgenError
from stepgen.plan.warnings import PlanWarning

EXAMPLE = "Example: stepgen check specs/*.yaml"


def check(
    specs: Annotated[list[Path], typer.Argument(metavar="SPEC", help="YAML files to check.")],
) -> None:
    """
    Validate specs: every fault and conflict, with its line and a way out.

    Warnings name what a motor keeps from libraries that `uses` does not list; a spec with
    warnings is fine.
    """
    failed = False
    for path in specs:
        try:
            warnings = api.check(path)
        except StepgenError as error:
            failed = True
            report_faults(error.faults)
        else:
            report_warnings(path, warnings)
            say(f"{path}: fine")
    if failed:
        raise typer.Exit(WRONG)


def report_warnings(path: Path, warnings: Iterable[PlanWarning]) -> None:
    """
    Print each of the *warnings* about the spec in *path* on stderr.
    """
    for warning in warnings:
        head = typer.style(f"{printable(str(path))}: ", bold=True)
        complain(head + typer.style("warning: ", fg="yellow", bold=True) + str(warning))

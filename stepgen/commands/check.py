"""
``stepgen check``: validates specs.
"""

from pathlib import Path
from typing import Annotated

import typer

from stepgen import api
from stepgen.commands.report import WRONG, report_faults, say
from stepgen.errors import StepgenError

EXAMPLE = "Example: stepgen check specs/*.yaml"


def check(
    specs: Annotated[list[Path], typer.Argument(metavar="SPEC", help="YAML files to check.")],
) -> None:
    """
    Validate specs: every fault and conflict, with its line and a way out.
    """
    failed = False
    for path in specs:
        try:
            api.plan(path)
        except StepgenError as error:
            failed = True
            report_faults(error.faults)
        else:
            say(f"{path}: fine")
    if failed:
        raise typer.Exit(WRONG)

"""
``stepgen datasheet``: one page about a library, for the screen and for two sheets of paper.
"""

from pathlib import Path
from typing import Annotated

import typer

from stepgen import api
from stepgen.commands.report import FAILED, progress, say
from stepgen.library.swap import os_errors, replace_file

EXAMPLE = "Example: stepgen datasheet specs/uno_motor_shield.yaml --verify"


def datasheet(
    spec: Annotated[Path, typer.Argument(metavar="SPEC", help="A YAML file.")],
    *,
    output: Annotated[
        Path | None,
        typer.Option(
            "--output", "-o", metavar="FILE", help="The page; default: NAME.html, as the library."
        ),
    ] = None,
    verified: Annotated[
        bool,
        typer.Option("--verify", help="Verify the library first, and show what was measured."),
    ] = False,
) -> None:
    """
    Write a page with the wiring as a picture, what the library takes, rates, plots and cycles.

    It needs nothing but a browser, in light or dark, and prints on two pages, with more than three
    motors on three. With --verify it also has flash, RAM, measured cycles, jitter and every check;
    exit code 1 if one of them fails.
    """
    target = output or Path(f"{api.plan(spec).library.name}.html")
    report = None
    if verified:
        with progress(spec.stem) as track:
            report = api.verify(spec, track=track)
    with os_errors(target):
        replace_file(api.datasheet(spec, report=report).encode(), target)
    say(f"{target}: written")
    if report and not report.passed:
        raise typer.Exit(FAILED)

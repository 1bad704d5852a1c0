"""
``stepgen lint``: the rules of the Arduino library manager.
"""

from pathlib import Path
from typing import Annotated

import typer

from stepgen import api
from stepgen.commands.report import FAILED, complain, print_tables, printable, say

EXAMPLE = "Example: stepgen lint generated/*"


def lint(
    folders: Annotated[
        list[Path] | None, typer.Argument(metavar="DIR", help="Folders of libraries.")
    ] = None,
    *,
    rules: Annotated[bool, typer.Option("--rules", help="List the rules, and check nothing.")] = (
        False
    ),
) -> None:
    """
    Check library folders against the Arduino library specification, as strictly as Arduino Lint.

    Each finding has its file, its line where it has one, the name of the rule and what to do; exit
    code 1 if there is one.
    """
    if rules:
        rows = [(rule.name, rule.title, rule.fix) for rule in api.lint_rules()]
        print_tables([("", ("Rule", "What it demands", "Fix"), rows)])
        return
    if not folders:
        raise typer.BadParameter("name the folder of a library", param_hint="DIR")
    reports = [api.lint(folder) for folder in folders]
    for report in reports:
        for finding in report.findings:
            complain(printable(f"{report.path}/{finding}".replace("/.: ", ": ", 1)))
        if not report.findings:
            say(f"{report.path}: fine")
    for name, what in api.lint_not_checked():
        say(f"not checked: {name}: {what}")
    if any(report.findings for report in reports):
        raise typer.Exit(FAILED)

"""
``stepgen doctor``: which compilers and simulators are here, and how far they can be trusted.
"""

import json
from textwrap import fill
from typing import TYPE_CHECKING, Annotated

import typer

from stepgen import api
from stepgen.commands.report import FAILED, print_tables, progress, say

if TYPE_CHECKING:
    from stepgen.verify.doctor import Diagnosis

EXAMPLE = "Example: stepgen doctor"
_DEMAND_WIDTH = 46  # leaves room for three simulators in 80 columns


def doctor(
    *,
    as_json: Annotated[bool, typer.Option("--json", help="Print one object.")] = False,
) -> None:
    """
    List compilers and simulators, and try each simulator on what the datasheet demands.

    ok: the simulator is right by itself; corrected: stepgen puts it right; wrong: nothing that
    needs this point is verified on it. Exit code 1 unless there is a compiler and simavr meets
    every point that a spec depends on.
    """
    with progress("trying the simulators") as track:
        found = api.doctor(track=track)
    if as_json:
        say(json.dumps(found.as_json(), indent=2, ensure_ascii=False))
    else:
        _show(found)
    if not found.is_fit:
        raise typer.Exit(FAILED)


def _show(found: "Diagnosis") -> None:
    from stepgen.verify.conformance.needs import dependents  # noqa: PLC0415 - needs numpy

    here = [name for name, version in found.simulators.items() if version]
    compilers = [(one.name, one.version) for one in found.compilers]
    simulators = [(name, version or "not here") for name, version in found.simulators.items()]
    rows = [
        (fill(point.demand, _DEMAND_WIDTH), *(row[name].word for name in here))
        for point, row in found.verdicts.items()
    ]
    print_tables(
        [
            ("Compilers", ("Name", "Version"), compilers or [("none", "")]),
            ("Simulators", ("Name", "Version"), simulators),
            ("What the chip does", ("", *here), rows),
        ]
    )
    failures = list(found.failures())
    if failures:
        say("\nWrong:")
    for name, verdict in failures:
        needed = ", ".join(dependents(verdict.point)) or "nothing"
        say(f"  {name}: {verdict.point.demand} ({verdict.point.name})")
        say(f"    {(verdict.findings or ('',))[0]}")
        say(f"    needed by: {needed}")

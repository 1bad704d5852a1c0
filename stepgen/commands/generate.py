"""
``stepgen generate``: write the library, or check that what is there is fresh.
"""

from pathlib import Path
from typing import Annotated

import typer

from stepgen import api
from stepgen.commands.report import FAILED, complain, say, track
from stepgen.errors import StepgenError
from stepgen.library.write import WriteResult

EXAMPLE = "Example: stepgen generate specs/uno_motor_shield.yaml --output ~/Arduino/libraries"


def generate(
    specs: Annotated[list[Path], typer.Argument(metavar="SPEC", help="YAML files.")],
    *,
    output: Annotated[
        Path, typer.Option("--output", "-o", metavar="DIR", help="Where the library's folder goes.")
    ] = Path(),
    zipped: Annotated[
        bool, typer.Option("--zip", help="Write NAME.zip for the Arduino IDE, not a folder.")
    ] = False,
    check: Annotated[
        bool, typer.Option("--check", help="Write nothing; exit 1 if what is there is stale.")
    ] = False,
    force: Annotated[
        bool, typer.Option("--force", help="Also overwrite generated files that were edited.")
    ] = False,
) -> None:
    """
    Write the Arduino library of each spec into a folder (or a zip) named like the library.

    Files that stepgen did not write are never overwritten or removed, not even with --force.
    """
    if check and force:
        raise StepgenError.of("--check writes nothing, so --force has no use; leave one out")
    if check:
        _check(specs, output, zipped=zipped)
        return
    for result in api.generate(specs, output, zipped=zipped, force=force, track=track):
        _say_result(result, zipped=zipped)


def _check(specs: list[Path], output: Path, *, zipped: bool) -> None:
    found = api.stale(specs, output, zipped=zipped, track=track)
    for target, differences in found.items():
        if not differences:
            say(f"{target}: fresh")
        for difference in differences:
            complain(f"{target if not zipped else target.parent}/{difference}")
    if any(found.values()):
        complain("not fresh; run the same command without --check")
        raise typer.Exit(FAILED)


def _say_result(result: WriteResult, *, zipped: bool) -> None:
    if result.is_fresh:
        say(f"{result.target}: up to date")
        return
    if zipped:
        say(f"{result.target}: {'written' if result.written else 'changed'}")
        return
    kinds = {"written": result.written, "changed": result.changed, "removed": result.removed}
    counts = [f"{len(paths)} {kind}" for kind, paths in kinds.items() if paths]
    if result.unchanged:
        counts.append(f"{len(result.unchanged)} unchanged")
    say(f"{result.target}: {', '.join(counts)}")
    for kind, paths in kinds.items():
        for path in paths:
            say(f"  {kind} {path}")

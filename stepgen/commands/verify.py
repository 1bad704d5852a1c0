"""
``stepgen verify``: compile, simulate, compare with the model, measure.
"""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from stepgen import api
from stepgen.commands.report import FAILED, progress, say

if TYPE_CHECKING:
    from stepgen.verify.report import SpecReport

EXAMPLE = "Example: stepgen verify specs/uno_motor_shield.yaml"


def verify(
    specs: Annotated[list[Path], typer.Argument(metavar="SPEC", help="YAML files.")],
    *,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print one object (several specs: an array).")
    ] = False,
    paths: Annotated[
        bool, typer.Option("--paths", help="Show the longest way through each step interrupt.")
    ] = False,
    compiler: Annotated[
        str | None,
        typer.Option("--compiler", metavar="NAME", help="gcc-5.4 or gcc-7.3; default: on PATH."),
    ] = None,
) -> None:
    """
    Prove the library of each spec: every pin edge against the reference model, to the cycle.

    The longest that an interrupt can take is worked out from the program itself.

    Exit code 1 if any check fails.
    """
    api.generate_all(specs)  # all faults of all specs before the first of them is run
    reports = []
    for path in specs:
        with progress(path.stem) as track:
            reports.append(api.verify(path, compiler=compiler, track=track))
        if not as_json:
            _say_report(reports[-1], paths=paths)
    if as_json:
        shown = [report.as_json() for report in reports]
        say(json.dumps(shown[0] if len(shown) == 1 else shown, indent=2, ensure_ascii=False))
    if not all(report.passed for report in reports):
        raise typer.Exit(FAILED)


def _say_report(report: "SpecReport", *, paths: bool) -> None:
    say(f"{report.spec} ({report.compiler}): {'passed' if report.passed else 'FAILED'}")
    for check in report.checks:
        say(f"  {'ok  ' if check.passed else 'FAIL'} {check.name}: {check.detail}")
    for name, motor in report.motors.items():
        say(
            f"  {name}: {motor.cycles_per_step:g} cycles per step, longest step interrupt "
            f"{motor.measured_max} of at most {motor.bound}, "
            f"up to {motor.max_steps_per_second:.0f} steps/s"
        )
        for part in motor.longest_path if paths else ():
            say(f"    {part}")
    say(
        f"  {report.flash_bytes} bytes of flash and {report.ram_bytes} of RAM over an empty "
        f"sketch, {report.stack_bytes} of at most {report.stack_bound_bytes} of stack"
    )

"""
``stepgen verify``: compile, simulate, compare with the model, measure.
"""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from stepgen import api
from stepgen.commands.report import FAILED, complain, progress, say
from stepgen.errors import StepgenError

if TYPE_CHECKING:
    from stepgen.verify.report import SpecReport

EXAMPLE = "Example: stepgen verify specs/uno_motor_shield.yaml"

_ALL = "all"


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
    simulator: Annotated[
        str,
        typer.Option(
            "--simulator", metavar="NAME", help="simavr, avr8js, yasimavr, or all that fit."
        ),
    ] = "simavr",
) -> None:
    """
    Prove the library of each spec: every pin edge against the reference model, to the cycle.

    avr8js and yasimavr run the shorter scenarios only. A simulator that is unlike the chip in
    something that the spec depends on is refused; with `all` it is left out. The longest that an
    interrupt can take is worked out from the program itself.

    Exit code 1 if any check fails.
    """
    api.render_all(specs)  # all faults of all specs before the first of them is run
    reports = []
    for path in specs:
        for name in _simulators(path, simulator, compiler):
            with progress(f"{path.stem}, {name}") as track:
                report = api.verify(path, compiler=compiler, simulator=name, track=track)
            reports.append(report)
            if not as_json:
                _say_report(report, paths=paths)
    if as_json:
        shown = [report.as_json() for report in reports]
        say(json.dumps(shown[0] if len(shown) == 1 else shown, indent=2, ensure_ascii=False))
    if not all(report.passed for report in reports):
        raise typer.Exit(FAILED)


def _simulators(path: Path, wanted: str, compiler: str | None) -> list[str]:
    """
    Return the simulators to run the spec in *path* on; for `all`, say which are left out.
    """
    if wanted != _ALL:
        return [wanted]
    reasons = api.usable_simulators(path, compiler=compiler)
    for reason in filter(None, reasons.values()):
        complain(f"{path}: left out: {reason}")
    usable = [name for name, reason in reasons.items() if not reason]
    if not usable:
        raise StepgenError.of("no simulator can be used for this spec", place=str(path))
    return usable


def _say_report(report: "SpecReport", *, paths: bool) -> None:
    tools = f"{report.compiler}, {report.simulator}"
    say(f"{report.spec} ({tools}): {'passed' if report.passed else 'FAILED'}")
    for check in report.checks:
        say(f"  {'ok  ' if check.passed else 'FAIL'} {check.name}: {check.detail}")
    for name, reason in report.left_out.items():
        say(f"  --   {name}: left out: {reason}")
    for name, motor in report.motors.items():
        # Without the long run, which slow simulators leave out, there is no mean.
        mean = f"{motor.cycles_per_step:g} cycles per step, " if motor.cycles_per_step else ""
        say(
            f"  {name}: {mean}longest step interrupt "
            f"{motor.measured_max} of at most {motor.bound}, "
            f"up to {int(motor.max_steps_per_second)} steps/s"
        )
        for limit in motor.rates[-1:]:
            say(f"    {int(limit.steps_per_second)} steps/s are safe {limit.beside}: {limit.cause}")
        for part in motor.longest_path if paths else ():
            say(f"    {part}")
    stack = (
        f", {report.stack_bytes} of at most {report.stack_bound_bytes} of stack"
        if report.stack_bytes
        else ""
    )
    say(
        f"  {report.flash_bytes} bytes of flash and {report.ram_bytes} of RAM over an empty "
        f"sketch{stack}"
    )

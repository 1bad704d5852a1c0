"""
The command line: puts the commands of `stepgen.commands` together and turns faults into reports.

A command is a function of a module there, with an ``EXAMPLE`` for its help; it raises
StepgenError for what the user can mend. Exit codes: 0 fine; 1 a comparison, lint or freshness
check failed; 2 wrong use or an invalid spec.
"""

import errno
import os
import sys
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from stepgen import __version__
from stepgen.commands import (
    boards,
    check,
    datasheet,
    doctor,
    generate,
    init,
    lint,
    matrix,
    plan,
    schema,
    simulate,
    verify,
)
from stepgen.commands.report import WRONG, report_faults
from stepgen.errors import Fault, StepgenError

# What the extra `verify` installs, as Python imports it.
_VERIFY_MODULES = {"cffi", "elftools", "numpy"}
_NO_VERIFY = (
    "this command simulates, and generating needs none of that: pip install 'stepgen[verify]' "
    "brings what is missing"
)


class _Commands(TyperGroup):
    """
    All commands; the faults that any of them raises are reported here, without a traceback.
    """

    def invoke(self, ctx: Any) -> Any:  # noqa: ANN401 - typer's own context and results
        try:
            return super().invoke(ctx)
        except StepgenError as error:
            report_faults(error.faults)
        except ModuleNotFoundError as error:
            if error.name not in _VERIFY_MODULES:
                raise
            report_faults([Fault("", "", _NO_VERIFY)])
        except OSError as error:
            if error.errno == errno.EPIPE:  # `stepgen boards mega | head`
                raise
            _discard_output()
            what = error.strerror or str(error)
            report_faults([Fault(str(error.filename or ""), "", f"the system refuses: {what}")])
        raise typer.Exit(WRONG)


def _discard_output() -> None:
    """
    Send what stdout still holds to nowhere: a disk that is full now is full at exit, too.
    """
    try:
        sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


app = typer.Typer(
    cls=_Commands,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    epilog="Example: stepgen generate specs/uno_motor_shield.yaml --output ~/Arduino/libraries",
)


def _say_version(wanted: bool) -> None:  # noqa: FBT001 - typer calls it so
    if wanted:
        typer.echo(f"stepgen {__version__}")
        raise typer.Exit


@app.callback()
def stepgen(
    *,
    version: Annotated[
        bool,
        typer.Option("--version", callback=_say_version, is_eager=True, help="Show the version."),
    ] = False,
) -> None:
    """
    Generate interrupt-driven stepper motor libraries for Arduino AVR boards.
    """


app.command("boards", epilog=boards.EXAMPLE)(boards.boards)
app.command("init", epilog=init.EXAMPLE)(init.init)
app.command("check", epilog=check.EXAMPLE)(check.check)
app.command("plan", epilog=plan.EXAMPLE)(plan.plan)
app.command("generate", epilog=generate.EXAMPLE)(generate.generate)
app.command("datasheet", epilog=datasheet.EXAMPLE)(datasheet.datasheet)
app.command("lint", epilog=lint.EXAMPLE)(lint.lint)
app.command("schema", epilog=schema.EXAMPLE)(schema.schema)
app.command("simulate", epilog=simulate.EXAMPLE)(simulate.simulate)
app.command("verify", epilog=verify.EXAMPLE)(verify.verify)
app.command("matrix", epilog=matrix.EXAMPLE)(matrix.matrix)
app.command("doctor", epilog=doctor.EXAMPLE)(doctor.doctor)


def main() -> None:
    """
    Run the command line; the entry point of the console script.
    """
    for stream in (sys.stdout, sys.stderr):
        # A name or a spec may hold what the terminal's encoding lacks: show it, do not fail.
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")
    app()

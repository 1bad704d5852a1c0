"""
``stepgen simulate``: run one scenario and show what the pins did.
"""

from pathlib import Path
from typing import Annotated

import typer

from stepgen import api
from stepgen.commands.report import FAILED, complain, print_tables, require_svg, say
from stepgen.library.swap import os_errors, replace_file

EXAMPLE = "Example: stepgen simulate specs/uno_motor_shield.yaml --plot run.svg"


def simulate(
    spec: Annotated[Path, typer.Argument(metavar="SPEC", help="A YAML file.")],
    *,
    scenario: Annotated[
        Path | None,
        typer.Option("--scenario", metavar="FILE", help="YAML with calls and waits."),
    ] = None,
    compiler: Annotated[
        str | None,
        typer.Option("--compiler", metavar="NAME", help="gcc-5.4 or gcc-7.3; default: on PATH."),
    ] = None,
    plot: Annotated[
        Path | None,
        typer.Option("--plot", metavar="FILE.svg", help="Draw each wire over time, too."),
    ] = None,
) -> None:
    """
    Compile the library, run one scenario on a simulated chip, and show each change of a pin.

    Without a scenario each motor makes eight steps forward and eight back. A scenario has a list
    `steps` of calls and waits, such as {call: set_speed, control: [DRV_EN], top: 20000, limit: 4},
    {wait_ms: 20}, {wait_clocks: 1234} and {call: read}; docs/commands/simulate.md has them all.

    Exit code 1 if anything differs from the reference model; then it says what.
    """
    require_svg(plot)
    plan, outcome = api.simulate(spec, scenario, compiler=compiler)
    from stepgen.verify.simulation import call_rows, port_rows  # noqa: PLC0415 - needs numpy

    print_tables(
        [
            ("Calls", ("cycle", "motor", "call", "result"), call_rows(plan, outcome)),
            (
                "Pins",
                ("cycle", "ms", "since last", "port", "wires"),
                port_rows(plan, outcome),
            ),
        ]
    )
    if plot is not None:
        from stepgen.commands.simulate_plot import svg_waves  # noqa: PLC0415 - draws with XML

        with os_errors(plot):
            replace_file(svg_waves(plan, outcome).encode(), plot)
    for finding in outcome.findings:
        complain(f"differs from the model: {finding}")
    if outcome.findings:
        raise typer.Exit(FAILED)
    say(f"{outcome.scenario.name}: every edge as the model says")

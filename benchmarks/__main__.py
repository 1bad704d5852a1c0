"""
Runs the benchmarks: ``python -m benchmarks [NAME]... [--rounds N]``.
"""

import argparse

from benchmarks import axis_ramps, compare_rates, newcomer, simavr_speed
from stepgen.commands.report import print_tables

BENCHMARKS = {
    "newcomer": newcomer,
    "simavr_speed": simavr_speed,
    "compare_rates": compare_rates,
    "axis_ramps": axis_ramps,
}
_ROUNDS = 7


def main() -> None:
    """
    Print a table for each benchmark that is asked for; for all of them if none is.
    """
    parser = argparse.ArgumentParser(prog="benchmarks", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(BENCHMARKS))
    parser.add_argument("--rounds", type=int, default=_ROUNDS, help="how often each is measured")
    options = parser.parse_args()
    chosen = [BENCHMARKS[name] for name in options.names or BENCHMARKS]
    print_tables([(one.TITLE, one.HEADING, one.rows(options.rounds)) for one in chosen])


main()

"""
Runs every benchmark: ``python -m benchmarks [--rounds N]``.
"""

import argparse

from benchmarks import simavr_speed
from stepgen.commands.report import print_tables

BENCHMARKS = (simavr_speed,)
_ROUNDS = 7


def main() -> None:
    """
    Print a table for each benchmark.
    """
    options = argparse.ArgumentParser(prog="benchmarks", description=__doc__)
    options.add_argument("--rounds", type=int, default=_ROUNDS, help="how often each is measured")
    rounds = options.parse_args().rounds
    print_tables([(one.TITLE, one.HEADING, one.rows(rounds)) for one in BENCHMARKS])


main()

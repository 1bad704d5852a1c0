"""
Trials of hazards with the library of a spec, in batches on one chip after the other.
"""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from random import Random

import pytest

from stepgen.verify.hazard_run import Met, run_hazards
from stepgen.verify.hazards import commands, ways
from stepgen.verify.scenarios import Scenario
from stepgen.verify.trials import AFTER_CYCLES, Command, Trial
from tests.sim.shrinking import Library

_BATCH = 200
_LONGEST_CALL_CYCLES = 700


def sample(library: Library, index: int, seed: int, count: int) -> list[Trial]:
    """
    Return *count* trials of motor number *index*: any command on any way, at an offset of *seed*.
    """
    random = Random(seed)  # noqa: S311 - repeatable, not secret
    drawn = [
        Trial(
            random.choice(ways(library.plan, index)),
            random.choice(commands(library.plan, index)),
            random.randrange(-_LONGEST_CALL_CYCLES, AFTER_CYCLES),
        )
        for _ in range(count)
    ]
    aimed = {one.command.name: one.command for one in drawn if one.command.works_first}
    leads = {name: lead_cycles(library, index, command) for name, command in aimed.items()}
    return [replace(one, offset=one.offset - leads.get(one.command.name, 0)) for one in drawn]


def lead_cycles(library: Library, index: int, command: Command) -> int:
    """
    Return how long *command* works before what may meet a step: its end, with interrupts masked.

    It is measured on a way on which no step comes for as long as it takes.
    """
    calmest = max(ways(library.plan, index), key=lambda way: way.period_cycles)
    calm = Trial(calmest, command, -calmest.period_cycles // 2)
    (met,) = run(library, index, "calm", [calm])
    return max(0, met.cycles - _LONGEST_CALL_CYCLES)


def batches(
    library: Library, index: int, name: str, trials: Iterable[Trial]
) -> Iterator[tuple[Scenario, tuple[str, ...], tuple[Met, ...]]]:
    """
    Make all *trials* with motor number *index*; yield what was done, found and met, by batch.
    """
    waiting = [(index, trial) for trial in trials]
    for start in range(0, len(waiting), _BATCH):
        batch = waiting[start : start + _BATCH]
        done = run_hazards(library.loaded, library.plan, library.elf, batch, name=name)
        yield done.outcome.scenario, done.outcome.findings, done.met


def run(library: Library, index: int, name: str, trials: Iterable[Trial]) -> list[Met]:
    """
    Make all *trials* with motor number *index*; fail with the smallest scenario that differs.
    """
    every: list[Met] = []
    for scenario, findings, met in batches(library, index, name, trials):
        if findings:
            pytest.fail(library.failure(scenario))
        every += met
    return every

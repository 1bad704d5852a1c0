"""
Commands at every clock of a step interrupt and of a period: no step lost or extra, none slow.

Each trial starts a motor, lets a command meet a step of it at an offset that is exact to a clock,
and reads the position; the whole is compared with the model. For each kind of spec the campaign
makes every trial that there is, `make test` a sample with a stored seed; for the specs that are of
no kind of their own the campaign makes a sample too.
"""

from collections.abc import Callable
from functools import cache

import pytest

from stepgen import api
from stepgen.verify.hazard_run import run_hazards
from stepgen.verify.hazards import commands, ways
from stepgen.verify.trials import AFTER_CYCLES, Command, Trial, Way, sweep, window
from tests.sim.hazard_trials import lead_cycles, run, sample
from tests.sim.kinds import KINDS
from tests.sim.shrinking import ROOT, Library

SEED = 20_260_401
SAMPLE = 300
CAMPAIGN_SAMPLE = 20_000
MOST_ROUNDS = 10
_CALM_CYCLES = 900  # a call that begins so long before the step is over when it is due

library_of = cache(Library.of)
OTHERS = sorted({path.stem for path in (ROOT / "specs").glob("*.yaml")} - {*KINDS})
PLANS = {stem: api.plan(ROOT / "specs" / f"{stem}.yaml") for stem in KINDS}
EVERY_WAY = [
    pytest.param(stem, index, number, id=f"{stem}-{motor.name}-{way.name}")
    for stem, plan in PLANS.items()
    for index, motor in enumerate(plan.motors)
    for number, way in enumerate(ways(plan, index))
]


def call_cycles(library: Library, index: int, way: Way, command: Command) -> int:
    """
    Return how long the calls of *command* take where no interrupt comes in between.
    """
    calm = Trial(way, command, -max(_CALM_CYCLES, way.period_cycles // 2 * command.works_first))
    return run(library, index, "calm", [calm])[0].cycles


def cover(
    library: Library, index: int, way: Way, command: Command, first: int = 0
) -> tuple[int, range]:
    """
    Let *command* meet the step at the clocks of *way*; return how many trials it took, and those.

    A trial in which another interrupt comes in between misses its offset, and is made again, with
    others before it, so that the other interrupt comes elsewhere.
    """
    name = f"{way.name}, {command.name}"
    longest = call_cycles(library, index, way, command)
    every = window(way, longest, first)
    made, wanted = 0, (*every, *sweep(way, longest))
    for others in range(MOST_ROUNDS):
        row = (*every[:others], *wanted)
        met = run(library, index, name, (Trial(way, command, offset) for offset in row))
        made += len(met)
        wanted = tuple(sorted({*wanted} & {*every} - {one.offset for one in met}))
        if not wanted:
            return made, every
    pytest.fail(f"{name}: no call began at {wanted} clocks after the step was due")


@pytest.mark.parametrize("stem", KINDS)
def test_no_command_near_an_interrupt_loses_a_step(stem: str) -> None:
    """
    Three hundred commands of all kinds, on all ways of the interrupt, at offsets of a stored seed.
    """
    library = library_of(stem)

    for index in range(len(library.plan.motors)):
        trials = sample(library, index, SEED, SAMPLE // len(library.plan.motors))
        run(library, index, f"seed {SEED}", trials)


def test_a_command_meets_the_interrupt_at_every_clock() -> None:
    """
    The interrupt is raised at each clock of a call, and the call follows it at each phase.
    """
    library = library_of("uno_motor_shield")
    way, faster = ways(library.plan, 0)[0], commands(library.plan, 0)[0]

    made, clocks = cover(library, 0, way, faster)

    # The call takes more than 400 clocks; each of them, those after the interrupt, and a sweep
    # over the rest of the period took a trial at least.
    assert clocks[0] < -400
    assert clocks[-1] == AFTER_CYCLES - 1
    assert made > len(clocks) + 10


def test_a_call_that_works_for_long_meets_a_step_where_it_masks_interrupts() -> None:
    """
    A step waits for the end of a call that looks through the ramp: the trials aim there.
    """
    library = library_of("uno_trapezoid")
    way = next(one for one in ways(library.plan, 0) if one.name == "a step within a row")
    slower = next(one for one in commands(library.plan, 0) if one.works_first)
    lead = lead_cycles(library, 0, slower)

    def longest_wait(lead: int) -> int:
        trials = [(0, Trial(way, slower, -lead - early)) for early in range(0, 700, 50)]
        done = run_hazards(library.loaded, library.plan, library.elf, trials)
        assert done.outcome.findings == ()
        return done.outcome.comparisons[0].jitter_cycles

    assert lead > _CALM_CYCLES
    assert longest_wait(lead) > longest_wait(0)


@pytest.mark.campaign
@pytest.mark.parametrize(("stem", "index", "number"), EVERY_WAY)
def test_a_campaign_of_every_command_at_every_clock(
    stem: str, index: int, number: int, record_property: Callable[[str, object], None]
) -> None:
    """
    Every command at the clocks of its calls and of what follows, and over the period.

    On the usual way each clock, on the others each third: another third for the next command.
    """
    library = library_of(stem)
    way = ways(library.plan, index)[number]
    every = [
        command
        for command in commands(library.plan, index)
        if not way.only or command.name in way.only
    ]
    trials = clocks = 0
    for first, command in enumerate(every):
        made, met = cover(library, index, way, command, first)
        trials, clocks = trials + made, clocks + len(met)
    name = library.plan.motors[index].name
    record_property(
        "campaign",
        f"{stem} {name}, {way.name}: {trials} trials, {len(every)} commands, each at each clock "
        f"of its calls or at each third, {clocks} in all",
    )


@pytest.mark.campaign
@pytest.mark.parametrize("stem", OTHERS)
def test_a_campaign_with_the_specs_of_no_kind_of_their_own(
    stem: str, record_property: Callable[[str, object], None]
) -> None:
    """
    Twenty thousand commands with each of them, on all ways, at offsets of a stored seed.
    """
    library = library_of(stem)
    motors = range(len(library.plan.motors))

    made = [
        run(library, i, f"seed {SEED}", sample(library, i, SEED, CAMPAIGN_SAMPLE // len(motors)))
        for i in motors
    ]

    record_property(
        "campaign", f"{stem}: {sum(len(trials) for trials in made)} trials, seed {SEED}"
    )

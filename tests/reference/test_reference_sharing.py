"""
Two motors on stacked shields that share their enables, derived by hand from the contract.

Wires: PWM A, PWM B (the enables), DIR A, DIR B; full steps: 1100, 1110, 1111, 1101. Timers with
p = 1 and n = 1000, TOP = 999, clock on at 100 with an empty counter: deadlines at 1100, 2100 ...
"""

import pytest

from stepgen.reference.facts import MotorFacts
from stepgen.reference.integer import MotorModel
from stepgen.reference.sequences import coils_off, phases
from stepgen.reference.sharing import Need, shared_changes
from stepgen.reference.stimuli import ClockOn, Hold, Init, Release, SetSpeed, Stimulus

SHIELD, OFF = phases("motor-shield", "full"), coils_off("motor-shield")
HOLDS = MotorFacts(SHIELD, OFF, 640, "hold", shares_enables=True)
RELEASES = MotorFacts(SHIELD, OFF, 640, "release", shares_enables=True)
START: list[Stimulus] = [SetSpeed(50, 0x80, 1000, 2), ClockOn(100, 1, 0)]


def _model(facts: MotorFacts, stimuli: list[Stimulus], delay: int = 0) -> MotorModel:
    """
    Return the model after *stimuli*, with each interrupt served *delay* cycles late.
    """
    model = MotorModel(facts, lambda deadline: deadline + delay)
    for stimulus in stimuli:
        model.apply(stimulus)
    return model


def test_a_released_motor_keeps_its_directions() -> None:
    """
    What the enables show is the other motor's affair too; the DIR wires stay in the phase.
    """
    # Steps at 1100 and 2100 lead to phase 2, 11; the release is due at 3100.
    edges = _model(RELEASES, START).advance(10_000)

    assert [(edge.deadline_cycle, str(edge.pattern)) for edge in edges] == [
        (50, "1100"),
        (1100, "1110"),
        (2100, "1111"),
        (3100, "xx11"),
    ]


def test_an_init_turns_the_directions_back() -> None:
    """
    The coils of a motor that is initialised may have current: its wires go to phase 0 at once.
    """
    model = _model(RELEASES, [*START, Init(20_000), Init(30_000)])

    assert [(edge.deadline_cycle, str(edge.pattern)) for edge in model.advance(40_000)][4:] == [
        (20_000, "xx00")
    ]


@pytest.mark.parametrize(
    ("facts", "more", "needs"),
    [
        (RELEASES, [], [(50, True), (3130, False)]),
        (HOLDS, [], [(50, True)]),
        (HOLDS, [Release(9000)], [(50, True), (9000, False)]),
        (RELEASES, [Hold(2500), Release(2600)], [(50, True), (2600, False)]),
        (RELEASES, [SetSpeed(1500, 0x80, 0)], [(50, True), (1500, False)]),
        (HOLDS, [SetSpeed(1500, 0x80, 0), Init(1600)], [(50, True), (1600, False)]),
        (RELEASES, [Hold(8000)], [(50, True), (3130, False), (8000, True)]),
    ],
)
def test_a_motor_needs_current_from_start_to_release(
    facts: MotorFacts, more: list[Stimulus], needs: list[tuple[int, bool]]
) -> None:
    """
    From the call that energises it to the one, or the late interrupt, that lets go.
    """
    model = _model(facts, [*START, *more], delay=30)
    model.advance(20_000)

    assert [(need.cycle, need.on) for need in model.needs] == needs


def test_shared_pins_are_high_while_either_motor_needs_them() -> None:
    """
    They change with the first motor that needs them and with the last that lets go.
    """
    lower = [Need(100, on=True), Need(500, on=False), Need(900, on=True), Need(950, on=False)]
    upper = [Need(300, on=True), Need(700, on=False), Need(940, on=True)]

    assert shared_changes([lower, upper]) == [
        Need(100, on=True),
        Need(700, on=False),
        Need(900, on=True),
    ]
    assert shared_changes([upper, lower]) == shared_changes([lower, upper])
    assert shared_changes([[], []]) == []

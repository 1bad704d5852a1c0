"""
How long a step interrupt can wait: small cases worked out by hand.
"""

import pytest

from stepgen.plan.model import Cadence
from stepgen.plan.timings import compare, fast_pwm
from stepgen.plan.waits import MainLine, Source, longest_wait

STEP = Source("step", vector=13, cycles=200, spacing_cycles=1000)
NO_INSTRUCTIONS = MainLine(masked_cycles=300, instruction_cycles=0)


def test_it_waits_for_one_stretch_with_interrupts_off() -> None:
    """
    Alone, the worst is the instruction in progress and a whole stretch after it.
    """
    wait = longest_wait(STEP, 1000, (), MainLine(300, 4))

    assert wait is not None
    assert wait.cycles == 300 + 4


def test_of_those_with_a_higher_number_it_waits_for_one() -> None:
    """
    The step comes before all of them, except the one that has begun: the longest.
    """
    later = [Source(name, 16, cycles, 5000) for name, cycles in (("a", 110), ("b", 140))]

    wait = longest_wait(STEP, 1000, later, NO_INSTRUCTIONS)

    assert wait is not None
    assert wait.cycles == 300 + 140


def test_those_with_a_lower_number_come_as_often_as_they_can() -> None:
    """
    A fixpoint: 300 + 100 take 400, in which a second comes at 350; with it 500, before a third.
    """
    often = Source("often", 5, cycles=100, spacing_cycles=350)

    wait = longest_wait(STEP, 1000, [often], NO_INSTRUCTIONS)

    assert wait is not None
    # Two before it, and with them 3 instructions, in which one short stretch of 150 can begin:
    # 300 + 150 + 200 = 650, still before 700.
    assert wait.cycles == 650


def test_several_of_one_kind_may_come_at_once() -> None:
    """
    With two at once the first 300 cycles are followed by both, and a short stretch between.
    """
    twice = Source("twice", 5, cycles=100, spacing_cycles=5000, at_once=2)

    wait = longest_wait(STEP, 1000, [twice], NO_INSTRUCTIONS)

    assert wait is not None
    assert wait.cycles == 300 + 200 + 150


def test_the_chip_notes_one_of_those_that_come_with_interrupts_off() -> None:
    """
    Of three that come in 3000 cycles with interrupts off one is left; one more comes just after.
    """
    often = Source("often", 5, cycles=60, spacing_cycles=1000)
    slow = Source("step", 13, cycles=200, spacing_cycles=10_000)

    wait = longest_wait(slow, 10_000, [often], MainLine(3000, 0))

    assert wait is not None
    assert wait.cycles == 3000 + 2 * 60 + 150


def test_a_step_that_comes_too_late_is_lost() -> None:
    """
    A wait as long as the patience loses the step; a cycle less does not.
    """
    assert longest_wait(STEP, 300, (), NO_INSTRUCTIONS) is None
    assert longest_wait(STEP, 301, (), NO_INSTRUCTIONS) is not None


def test_a_backlog_of_its_own_steps_counts() -> None:
    """
    200 cycles each 150 never catch up, though each alone would not wait too long.
    """
    fast = Source("step", 13, cycles=200, spacing_cycles=150)

    assert longest_wait(fast, 10_000, (), MainLine(0, 0)) is None


def test_a_second_late_step_is_followed_up() -> None:
    """
    Interrupts off for 500 of 600: the second step waits for the 100 that the first ran over.
    """
    fast = Source("step", 13, cycles=200, spacing_cycles=600)

    wait = longest_wait(fast, 600, (), MainLine(500, 0))

    assert wait is not None
    assert wait.cycles == 500


@pytest.mark.parametrize("period", [2048, 40_000])
def test_compare_is_patient_for_970_cycles_at_every_speed(period: int) -> None:
    """
    128 ticks of 8 until the next match, less a tick and the 46 cycles until OCR2A is written.
    """
    assert compare.cadence(period) == Cadence(128 * 8, 128 * 8 - 8 - 46)


def test_fast_pwm_is_patient_for_a_period() -> None:
    """
    One overflow waits in the flag; it must be taken, in at most 5 cycles, before the next.
    """
    assert fast_pwm.cadence(640) == Cadence(640, 635)

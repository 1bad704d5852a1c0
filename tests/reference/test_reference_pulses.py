"""
The model of STEP and DIR: traces by hand.
"""

from dataclasses import replace

from stepgen.reference.axis import Turn
from stepgen.reference.contract import Control
from stepgen.reference.facts import MotorFacts
from stepgen.reference.integer import MotorModel
from stepgen.reference.pulses import PulseFacts
from stepgen.reference.stimuli import ClockOn, EdgeKind, Init, SetSpeed

# An A4988 at 16 MHz: 1 us are 16 cycles, 200 ns are 3.2 and so 4; ENABLE is active LOW.
A4988 = PulseFacts(16, 32, 16, 4, 4, 4, enabled_level=False)
FACTS = MotorFacts(A4988.phases, A4988.coils_off, 640, "hold", has_direction=True)
FORWARD, BACKWARD = Control.DRV_EN, Control.DRV_EN | Control.DIRECTION


def test_the_pins_show_direction_and_enable_between_the_pulses() -> None:
    """
    STEP is LOW, DIR LOW forward and HIGH backward, ENABLE LOW from the first call on.

    Mode 15 without prescaler: the clock on at 10, first tick at 11, TOP 999 from 11 + 998 on, the
    overflow at 11 + 999 = 1010; the next ones each 1000 cycles.
    """
    model = MotorModel(FACTS)
    model.apply(SetSpeed(0, BACKWARD, 1_000, 2))
    model.apply(ClockOn(10, 1, 0))

    edges = model.advance(5_000)

    assert [(e.kind, e.deadline_cycle, str(e.pattern)) for e in edges] == [
        (EdgeKind.ENERGISE, 0, "010"),
        (EdgeKind.STEP, 1_010, "010"),
        (EdgeKind.STEP, 2_010, "010"),
    ]
    assert model.turns == (Turn(0, -1),)
    assert model.position == -2


def test_dir_changes_with_the_call_and_not_with_the_step() -> None:
    """
    A call in mid-run turns round at once; the step that ends the interval goes the new way.
    """
    model = MotorModel(FACTS)
    model.apply(SetSpeed(0, FORWARD, 1_000))
    model.apply(ClockOn(10, 1, 0))
    model.apply(SetSpeed(1_500, BACKWARD, 1_000))
    model.apply(SetSpeed(1_600, BACKWARD, 1_000))

    edges = model.advance(2_500)

    assert [str(edge.pattern) for edge in edges if edge.kind is EdgeKind.STEP] == ["000", "010"]
    assert model.turns == (Turn(1_500, -1),)
    assert model.position == 0


def test_init_points_forward_again() -> None:
    """
    Init makes DIR LOW and lets go of ENABLE.
    """
    model = MotorModel(FACTS)
    model.apply(SetSpeed(0, BACKWARD, 1_000))
    model.apply(Init(500))

    assert [str(edge.pattern) for edge in model.advance(500)] == ["010", "0x1"]
    assert model.turns == (Turn(0, -1), Turn(500, 1))


def test_a_driver_that_wakes_up_has_a_long_first_interval() -> None:
    """
    The first step waits for the driver, the second comes an interval after it.

    Wake 100 000: prescaler 8, 12 500 ticks; the clock on at 10, first tick at 16, the overflow at
    16 + 12 499 * 8 = 100 008. The interval of 1000 cycles follows: 101 008.
    """
    model = MotorModel(replace(FACTS, wake_cycles=100_000))
    model.apply(SetSpeed(0, FORWARD, 1_000, 2))
    model.apply(ClockOn(10, 8, 0))

    steps = [e.deadline_cycle for e in model.advance(200_000) if e.kind is EdgeKind.STEP]

    assert steps == [100_008, 101_008]


def test_a_motor_without_enable_shows_step_and_dir_only() -> None:
    """
    Nothing can be switched off, so that with and without current look the same.
    """
    bare = replace(A4988, enabled_level=None)

    assert [str(phase) for phase in bare.phases] == ["00", "01"]
    assert str(bare.coils_off) == "0x"
    assert bare.wake_cycles("fast-pwm") == 0

"""
The highest safe rates of a plan, what the sketch wishes for, and stretches with interrupts off.
"""

from collections.abc import Callable
from itertools import pairwise

import pytest

from stepgen.devices import CORE, INTERRUPTS, MILLIS
from stepgen.plan.model import Plan
from stepgen.plan.warnings import plan_warnings

Planner = Callable[[str], Plan]
SHIELD = "drive: motor-shield, timer: 1"
FAST_PWM_FLOOR = 640  # system 1: 25 000 steps/s at 16 MHz


def one(planned: Planner, motor: str, uses: str = "", board: str = "uno") -> Plan:
    """
    Return the plan of a single motor.
    """
    return planned(f"board: {board}\nuses: [{uses}]\nmotors:\n  motor: {{{motor}}}\n")


def test_one_motor_of_constant_speed_is_limited_by_its_timing(planned: Planner) -> None:
    """
    A call, millis and its own interrupt fit into the 640 clocks that fast PWM is made for.
    """
    plan = one(planned, SHIELD)

    assert [(limit.beside, limit.period_cycles) for limit in plan.rates["motor"]] == [
        ("alone", FAST_PWM_FLOOR),
        ("beside millis", FAST_PWM_FLOOR),
    ]
    assert "640 clocks are the shortest period of timing fast-pwm" in plan.rates["motor"][-1].cause
    assert plan.minimum_period_cycles == FAST_PWM_FLOOR


def test_on_a_chip_with_usb_a_step_waits_for_its_frames(planned: Planner) -> None:
    """
    The core has USB on beside every sketch, so that it counts like millis.
    """
    plan = one(planned, "drive: motor-shield, timer: 3", "Serial1", "leonardo")
    alone, core, everything = plan.rates["motor"]
    parts = {part.cause: part.cycles for part in core.parts}

    assert (alone.beside, core.beside) == ("alone", "beside millis and USB")
    assert everything.beside == "beside millis, USB and Serial1"
    assert parts["the USB interrupt of a frame"] == CORE["USB"].cycles
    assert alone.period_cycles < core.period_cycles < everything.period_cycles


def test_its_parts_are_what_a_step_waits_for(planned: Planner) -> None:
    """
    Beside millis: a call with interrupts off, the millis interrupt, instructions, and the step.
    """
    plan = one(planned, SHIELD)
    parts = {part.cause: part.cycles for part in plan.rates["motor"][-1].parts if part.cycles}

    assert parts.pop("a call with interrupts off") == plan.masked_bound_cycles
    assert parts.pop("its own step interrupt") == plan.motors[0].isr_bound_cycles
    assert parts.pop("the millis interrupt") == MILLIS.cycles
    # The one in which it becomes due, and one after the millis interrupt: CALL takes 4 cycles.
    assert parts == {"instructions in between": 8}


def test_what_the_sketch_uses_takes_from_the_rate(planned: Planner) -> None:
    """
    Serial's and Servo's interrupts count where `uses` names them; Servo's are not proven.
    """
    uses = "Servo D40, Serial"
    limits = one(planned, "drive: motor-shield, timer: 3", uses, "mega").rates["motor"]
    causes = {part.cause for part in limits[-1].parts}

    assert [limit.beside for limit in limits] == [
        "alone",
        "beside millis",
        "beside millis, Servo and Serial",
    ]
    assert limits[1].period_cycles < limits[2].period_cycles
    assert {interrupt.cause for name in ("Servo", "Serial") for interrupt in INTERRUPTS[name]} <= (
        causes
    )
    assert [*limits[-1].unproven] == ["Servo"]


def test_servos_of_a_higher_number_count_once_and_others_as_often_as_they_come(
    planned: Planner,
) -> None:
    """
    Up to 12 servos have timer 5, behind a motor on timer 3; more have timer 1 too, before it.

    Nine pulses of 2400 us are over 20 ms, so that two interrupts of a timer can come at once.
    """
    pins = [f"D{number}" for number in range(22, 36)]
    counts = {
        number: [
            part.cycles
            for part in one(
                planned,
                "drive: motor-shield, timer: 3",
                f"Servo {' '.join(pins[:number])}",
                "mega",
            )
            .rates["motor"][-1]
            .parts
            if part.cause.startswith("Servo")
        ]
        for number in (8, 12, 13)
    }

    assert counts[8] == counts[12] == [540]
    assert counts[13] == [540, 2 * 540]


def test_motors_of_lower_number_go_first(planned: Planner) -> None:
    """
    Timer 3 goes before timer 4: of two alike the motor on timer 4 is the slower one.
    """
    drives = ("[D22, D23, D24, D25]", "[D30, D31, D32, D33]", "[D42, D43, D44, D45]")
    motors = "".join(
        f"  {name}: {{drive: {{kind: four-wire, pins: {pins}}}, timer: {timer}}}\n"
        for name, pins, timer in zip("abc", drives, (3, 4, 5), strict=True)
    )
    rates = planned(f"board: mega\nmotors:\n{motors}").rates

    periods = [limits[-1].period_cycles for limits in rates.values()]
    assert periods == sorted(periods)
    assert periods[0] < periods[-1]


@pytest.mark.parametrize(("wish", "period"), [("800", 20_000), ("0.5", 32_000_000)])
def test_a_wish_makes_the_library_refuse_more(planned: Planner, wish: str, period: int) -> None:
    """
    16 MHz by the wish; what is proven stays as it is.
    """
    plan = one(planned, f"{SHIELD}, max_steps_per_second: {wish}")

    assert plan.minimum_period_cycles == period
    assert plan.proven_period_cycles == FAST_PWM_FLOOR
    assert plan.held_off[-1].period_cycles == period


def test_a_motor_without_a_wish_keeps_the_library_fast(planned: Planner) -> None:
    """
    The constant is one for all motors: it follows the wishes only where each motor has one.
    """
    slow = "drive: {kind: four-wire, pins: [D4, D5, D6, D7]}, timing: compare"
    text = f"board: uno\nmotors:\n  a: {{{slow}, max_steps_per_second: 100}}\n  b: {{{SHIELD}}}\n"
    both = text.replace(SHIELD, f"{SHIELD}, max_steps_per_second: 500")

    assert planned(text).minimum_period_cycles == 2048
    assert planned(both).minimum_period_cycles == 16_000_000 // 500


def test_slower_motors_let_the_sketch_have_interrupts_off_for_longer(planned: Planner) -> None:
    """
    At constant speed all of a period but what else is waited for: 5 + 110 + 8 clocks on an Uno.
    """
    held = one(planned, SHIELD).held_off

    for slower, faster in pairwise(held):
        assert slower.stretch_cycles > faster.stretch_cycles
    for row in held:
        # It must begin before the period is over, less the 5 clocks in which its flag is cleared.
        assert row.stretch_cycles == row.period_cycles - 5 - 1 - MILLIS.cycles - 8
        assert row.late_cycles == row.stretch_cycles + MILLIS.cycles + 8


def test_compare_has_one_figure_for_all_rates(planned: Planner) -> None:
    """
    970 clocks in all, at every speed: what millis and two instructions leave of it.
    """
    (row,) = one(planned, "drive: motor-shield, timing: compare").held_off

    assert row.period_cycles == 2048
    assert row.stretch_cycles == 970 - 1 - MILLIS.cycles - 8


def test_a_library_without_bound_gets_a_warning(planned: Planner) -> None:
    """
    SoftwareSerial at 9600 baud: ten bits of 1667 clocks, a call and the rest are below 900 steps/s.
    """
    plan = one(planned, "drive: motor-shield, timer: 1", "SoftwareSerial D4 D5")
    (warning,) = [text for text in map(str, plan_warnings(plan)) if "nothing bounds" in text]

    assert plan.minimum_period_cycles == FAST_PWM_FLOOR
    assert "SoftwareSerial, which keeps interrupts off while it receives or sends a byte" in warning
    rate = int(warning.partition("up to ")[2].split()[0])
    assert 880 < rate < 16_000_000 / (10 * 1667)

"""
Speed changes against the source's examples and recorded runs (system 1, chapters 7 and 8).
"""

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from stepgen.errors import StepgenError
from stepgen.plan.rates import Clock
from stepgen.plan.speed_changes import Course, plan_change
from stepgen.plan.speed_wishes import Wish, largest_halved, plan_wish

UNO = Clock()
FASTER = (
    "motorSetSpeed(MOTOR_CTRL_SPEED_VARIABLE | MOTOR_CTRL_IRQ_TIMING | MOTOR_CTRL_FASTER | "
    "MOTOR_CTRL_DRV_EN, 2666666UL, 0UL, 91264UL, 250, 29);"
)


def test_the_ramp_of_29_updates() -> None:
    """
    Chapter 7: 6 to 800 steps/s in 29 updates 250 ms apart is the call that stands there.
    """
    change = plan_wish(Wish(2_666_666, 20_000, updates=29, interval_ms=250), UNO)

    assert change.call == FASTER
    # 2666666 - k * 91264, by hand; the end is 2666666 - 29 * 91264 = 20010.
    assert [update.virtual_clocks for update in change.updates[:3]] == [2666666, 2575402, 2484138]
    assert change.end.virtual_clocks == 20_010
    assert {update.modification_clocks for update in change.updates[1:]} == {91_264}
    assert (change.count, change.end.due_ms) == (29, 7_250)


def test_the_ramp_of_11_updates() -> None:
    """
    Chapter 8: with VARIABLE_PWR, both columns from 4800000 with a modification of 2385000.
    """
    course = Course(4_800_000, 2_385_000, faster=True, halving=True, count=11)

    change = plan_change(course, 1_000, UNO)

    assert [update.virtual_clocks for update in change.updates] == [
        *(4_800_000, 2_415_000, 1_222_500, 626_250, 328_125, 179_063),
        *(104_532, 67_267, 48_635, 39_319, 34_661, 32_332),
    ]
    assert [update.modification_clocks for update in change.updates[1:]] == [
        *(2_385_000, 1_192_500, 596_250, 298_125, 149_062, 74_531),
        *(37_265, 18_632, 9_316, 4_658, 2_329),
    ]
    assert f"{float(change.end.rate_sps):.1f}" == "494.9"
    assert change.call == (
        "motorSetSpeed(MOTOR_CTRL_SPEED_VARIABLE | MOTOR_CTRL_IRQ_TIMING | "
        "MOTOR_CTRL_VARIABLE_PWR | MOTOR_CTRL_FASTER | MOTOR_CTRL_DRV_EN, "
        "4800000UL, 0UL, 2385000UL, 1000, 11);"
    )


def test_the_other_way_finds_the_modification_of_11_updates() -> None:
    """
    From 1 to 150 RPM the modification is the source's 2385000, not rounded down to a thousand.

    m * (2 - 2^-10) = 4768000 gives 2385164.6; the terms are truncated, so a little more fits:
    2385167 + 1192583 + 596291 + 298145 + 149072 + 74536 + 37268 + 18634 + 9317 + 4658 + 2329
    = 4768000, and 2385168 gives 4768009.
    """
    change = plan_wish(Wish(4_800_000, 32_000, halving=True, updates=11, interval_ms=1_000), UNO)

    assert change.modification_clocks == 2_385_167
    assert change.modification_clocks // 1_000 * 1_000 == 2_385_000
    assert change.end.virtual_clocks == 32_000


def test_recorded_case_1_slows_down() -> None:
    """
    The TOP and modification columns of the recorded run: 64, doubled after each update.
    """
    course = Course(15_000, 64, faster=False, halving=True, count=12)

    change = plan_change(course, 1_000, UNO)

    assert [update.virtual_clocks for update in change.updates] == [
        *(15_000, 15_064, 15_192, 15_448, 15_960, 16_984, 19_032),
        *(23_128, 31_320, 47_704, 80_472, 146_008, 277_080),
    ]
    assert [update.modification_clocks for update in change.updates[1:]] == [
        *(64, 128, 256, 512, 1_024, 2_048, 4_096, 8_192, 16_384, 32_768, 65_536, 131_072),
    ]
    assert "MOTOR_CTRL_VARIABLE_PWR | MOTOR_CTRL_SLOWER | MOTOR_CTRL_DRV_EN, 15000UL" in change.call


def test_the_doubling_table() -> None:
    """
    Chapter 8's second table: 1000 to 65536000 in 16 updates, 16000 to 0.244141 steps/s.
    """
    course = Course(1_000, 1_000, faster=False, halving=True, count=16)

    updates = plan_change(course, 1, UNO).updates

    assert [update.virtual_clocks for update in updates] == [
        *(1_000, 2_000, 4_000, 8_000, 16_000, 32_000, 64_000, 128_000, 256_000, 512_000),
        *(1_024_000, 2_048_000, 4_096_000, 8_192_000, 16_384_000, 32_768_000, 65_536_000),
    ]
    assert updates[-1].modification_clocks == 32_768_000
    assert f"{float(updates[-1].rate_sps):.6f}" == "0.244141"
    assert f"{float(UNO.rpm(updates[-1].rate_sps)):.6f}" == "0.073242"


def test_steps_and_times_of_the_updates() -> None:
    """
    500 steps/s for 0.1 s are 50 steps, then 1000 / 3 steps/s for 0.1 s are 33.3 more.
    """
    course = Course(32_000, 16_000, faster=False, halving=False, count=2)

    updates = plan_change(course, 100, UNO).updates

    assert [update.due_ms for update in updates] == [0, 100, 200]
    assert [update.rate_sps for update in updates] == [500, Fraction(1000, 3), 250]
    assert [update.steps_made for update in updates] == pytest.approx([0, 50, 250 / 3])


def test_from_a_time() -> None:
    """
    7.25 s from 6 to 800 steps/s are the source's 29 updates without naming them.
    """
    assert plan_wish(Wish(2_666_666, 20_000, duration_ms=Fraction(7_250)), UNO).call == FASTER


@pytest.mark.parametrize(
    ("given", "count", "interval_ms"),
    [
        ({"updates": 10}, 10, 200),
        ({"interval_ms": 400}, 5, 400),
        ({"halving": True}, 4, 500),  # 32000 to 2000: halved four times
    ],
)
def test_from_a_time_and_something_else(
    given: dict[str, int], count: int, interval_ms: int
) -> None:
    """
    Two seconds with a number of updates, an interval, or with halving.
    """
    wish = Wish(32_000, 2_000, duration_ms=Fraction(2_000), **given)  # type: ignore[arg-type]

    change = plan_wish(wish, UNO)

    assert (change.count, change.interval_ms) == (count, interval_ms)


@pytest.mark.parametrize("halving", [False, True])
@pytest.mark.parametrize("given", [{}, {"updates": 12}])
@pytest.mark.parametrize("ends", [(160_000, 16_000), (16_000, 160_000)])
def test_from_a_number_of_steps(
    ends: tuple[int, int], given: dict[str, int], *, halving: bool
) -> None:
    """
    1000 steps between 100 and 1000 steps/s come out within what half a millisecond can do.
    """
    wish = Wish(*ends, halving=halving, steps=Fraction(1_000), **given)  # type: ignore[arg-type]

    change = plan_wish(wish, UNO)

    rates_sps = sum(float(update.rate_sps) for update in change.updates[:-1])
    assert abs(change.end.steps_made - 1_000) <= rates_sps * 0.000_501
    assert change.interval_ms >= 50


def test_from_steps_and_an_interval() -> None:
    """
    With the interval fixed, the number of updates is the one that comes nearest.
    """
    wish = Wish(160_000, 16_000, steps=Fraction(1_000), interval_ms=100)
    change = plan_wish(wish, UNO)
    others = [
        plan_wish(Wish(160_000, 16_000, updates=change.count + by, interval_ms=100), UNO)
        for by in (-1, 1)
    ]

    missed = abs(change.end.steps_made - 1_000)
    assert all(missed <= abs(other.end.steps_made - 1_000) for other in others)


@given(
    st.integers(640, 67_107_840),
    st.integers(640, 67_107_840),
    st.integers(1, 31),
    st.booleans(),
)
def test_the_end_is_never_passed(start: int, end: int, count: int, halving: bool) -> None:  # noqa: FBT001 - hypothesis calls it so
    """
    Whatever the speeds, the modification is the largest that does not pass the wanted end.
    """
    wish = Wish(start, end, halving=halving)
    course = wish.course(count)
    one_more = Course(start, course.modification_clocks + 1, course.faster, halving, count)

    def change(course: Course) -> int:
        return abs([*course.virtuals()][-1] - start)

    assert change(course) <= abs(start - end) < change(one_more) or start == end


def test_halving_sums_are_truncated_like_the_firmware() -> None:
    """
    7 + 3 + 1 = 11 fits into 11 and 12; 8 + 4 + 2 = 14 does not.
    """
    assert [largest_halved(clocks, 3) for clocks in (11, 12, 13, 14)] == [7, 7, 7, 8]


@pytest.mark.parametrize(
    ("wish", "message"),
    [
        (Wish(32_000, 32_000, updates=1, interval_ms=50), "same speed; call motorSetSpeed"),
        (Wish(32_000, 16_000), "not said; give updates and interval, a time, or a number of"),
        (Wish(32_000, 16_000, updates=3), "not said; give updates and interval"),
        (
            Wish(32_000, 16_000, updates=3, interval_ms=50, duration_ms=Fraction(9)),
            "more than once; give a time or",
        ),
        (
            Wish(32_000, 16_000, duration_ms=Fraction(9), steps=Fraction(9)),
            "more than once; give a time or",
        ),
        (Wish(32_000, 16_000, updates=0, interval_ms=50), "0 updates .*takes at least 1"),
        (Wish(32_000, 16_000, updates=65_536, interval_ms=50), "65536 updates .*at most 65535"),
        (Wish(32_000, 16_000, updates=2, interval_ms=65_536), "65536 milliseconds .*at most 65535"),
        (Wish(32_000, 16_000, updates=2, interval_ms=0), "0 milliseconds .*at least 1"),
        (Wish(32_000, 16_000, updates=29, duration_ms=Fraction(5)), "0 milliseconds between"),
        (Wish(32_000, 16_000, updates=2, duration_ms=Fraction(10**6)), "500000 milliseconds"),
        (Wish(32_000, 16_000, steps=Fraction(0)), "more than no time and no turn"),
        (Wish(32_000, 31_990, updates=11, interval_ms=50), "would be 0 clocks.*fewer updates"),
        (
            Wish(32_000, 16_000, halving=True, updates=20, interval_ms=50),
            "a modification of 8003 clocks is halved to 0 after 13 updates; choose at most 13",
        ),
        (Wish(32_000, 16_000, halving=True, updates=32, interval_ms=50), "at most 31"),
        (Wish(32_000, 600, updates=2, interval_ms=50), "after update 2: 600 clocks .* too fast"),
        (
            Wish(32_000, 16_000, halving=True, steps=Fraction(10**7), interval_ms=100),
            "10000000 steps cannot be had so; the nearest would be 117",
        ),
        (
            Wish(32_000, 16_000, duration_ms=Fraction(300), interval_ms=250),
            "300 milliseconds cannot be had so; the nearest would be 250",
        ),
        (Wish(639, 16_000, updates=2, interval_ms=50), "at the start: 639 clocks .* too fast"),
    ],
)
def test_impossible_wishes_are_refused(wish: Wish, message: str) -> None:
    """
    What cannot be had is refused with its limit and a way out.
    """
    with pytest.raises(StepgenError, match=message):
        plan_wish(wish, UNO)


@pytest.mark.parametrize(
    ("course", "message"),
    [
        (Course(32_000, 40_000, True, False, 1), "after update 1: -8000 clocks .* too fast"),  # noqa: FBT003
        (Course(67_000_000, 107_841, False, False, 1), "after update 1: 67107841 .* too slow"),  # noqa: FBT003
        (Course(32_000, 0, False, True, 1), "would be 0 clocks"),  # noqa: FBT003
    ],
)
def test_a_modification_that_passes_a_limit_is_refused(course: Course, message: str) -> None:
    """
    A modification of one's own may pass neither end of the timer's range, nor be 0.
    """
    with pytest.raises(StepgenError, match=message):
        plan_change(course, 100, UNO)


def test_a_long_change() -> None:
    """
    As many updates as it takes: 16e6 / 1584000 * ln(100) = 46.5 steps/s in the mean.

    8000 steps take 8000 / 46.5 = 172 s, which are 3440 updates of 50 ms; a little more, as the
    rate before each update is the lower one and the modification is truncated.
    """
    change = plan_wish(Wish(1_600_000, 16_000, steps=Fraction(8_000), interval_ms=50), UNO)

    assert change.count == pytest.approx(3_440, rel=0.05)
    assert change.end.steps_made == pytest.approx(8_000, rel=0.005)


def test_a_long_time_has_longer_intervals() -> None:
    """
    A million seconds are more than 65535 * 50 ms, so the updates are further apart.
    """
    change = plan_wish(Wish(32_000, 16_000, duration_ms=Fraction(10**9)), UNO)

    assert change.end.due_ms == 10**9

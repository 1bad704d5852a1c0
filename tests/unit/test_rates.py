"""
Rates against the source's calculator and tables (system 1, chapters 6 and 8).
"""

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from stepgen.errors import StepgenError
from stepgen.plan.rates import (
    TABLE_VIRTUALS_CLOCKS,
    Clock,
    rate_of_steps,
    rate_of_virtual,
    rates_of_rpm,
    virtual_of,
)

UNO = Clock()  # 16 MHz, CLKPR 1, 200 steps in a turn: the source's calculator

# Chapter 8, first table: virtual value, steps/s, RPM, as printed there.
TABLE = """
1000 16000 4800|2000 8000 2400|3000 5333.333 1600|4000 4000 1200|5000 3200 960
6000 2666.667 800|7000 2285.714 685.7143|8000 2000 600|9000 1777.778 533.3333|10000 1600 480
11000 1454.545 436.3636|12000 1333.333 400|13000 1230.769 369.2308|14000 1142.857 342.8571
15000 1066.667 320|16000 1000 300|17000 941.1765 282.3529|18000 888.8889 266.6667
19000 842.1053 252.6316|20000 800 240|21000 761.9048 228.5714|22000 727.2727 218.1818
23000 695.6522 208.6957|24000 666.6667 200|25000 640 192|26000 615.3846 184.6154
27000 592.5926 177.7778|28000 571.4286 171.4286|29000 551.7241 165.5172|30000 533.3333 160
31000 516.129 154.8387|32000 500 150|33000 484.8485 145.4545|34000 470.5882 141.1765
35000 457.1429 137.1429|36000 444.4444 133.3333|37000 432.4324 129.7297|38000 421.0526 126.3158
39000 410.2564 123.0769|40000 400 120|41000 390.2439 117.0732|42000 380.9524 114.2857
43000 372.093 111.6279|44000 363.6364 109.0909|45000 355.5556 106.6667|46000 347.8261 104.3478
47000 340.4255 102.1277|48000 333.3333 100|49000 326.5306 97.95918|50000 320 96
51000 313.7255 94.11765
"""


def test_180_steps_per_second() -> None:
    """
    The calculator's first row, 180 steps/s, in every digit that it has.
    """
    rate = rate_of_steps(Fraction(180), UNO)

    assert (rate.virtual_clocks, rate.timer_value, rate.compare, rate.prescaler) == (
        88_888,
        11_111,
        11_110,
        8,
    )
    assert rate.real_sps == Fraction(16_000_000, 88_888)
    assert f"{float(rate.real_sps):.4f}" == "180.0018"
    assert f"{float(rate.deviation_percent):.5f}" == "0.00100"
    assert f"{float(rate.rpm):.8f}" == "54.00054001"
    assert f"{float(rate.turns_per_second):.3f}" == "0.900"
    assert rate.call == "motorSetSpeed(MOTOR_CTRL_DRV_EN, 88888UL);"


def test_10_rpm_in_whole_steps() -> None:
    """
    The calculator's second row counts 33 whole steps per second and is 1 % slow.
    """
    rate, _ = rates_of_rpm(Fraction(10), UNO)

    assert rate.wanted_sps == 33
    assert (rate.virtual_clocks, rate.timer_value, rate.prescaler) == (484_848, 60_606, 8)
    assert f"{float(rate.real_sps):.6f}" == "33.000033"
    assert f"{float(rate.deviation_percent):.5f}" == "0.00010"
    assert f"{float(rate.rpm):.7f}" == "9.9000099"
    assert rate.rpm_deviation_percent is not None
    assert f"{float(rate.rpm_deviation_percent):.6f}" == "-0.999901"
    assert f"{float(rate.turns_per_second):.3f}" == "0.165"


def test_10_rpm_exactly() -> None:
    """
    Beside the row in whole steps stands the virtual value that is exact: 16e6 / (100/3) = 480000.
    """
    _, rate = rates_of_rpm(Fraction(10), UNO)

    assert rate.virtual_clocks == 480_000
    assert rate.rpm == 10
    assert rate.rpm_deviation_percent == 0


def test_whole_steps_need_no_second_rate() -> None:
    """
    30 RPM are 100 whole steps per second, 0.2 RPM are less than one: each is a single rate.
    """
    assert [rate.wanted_sps for rate in rates_of_rpm(Fraction(30), UNO)] == [100]
    assert [rate.wanted_sps for rate in rates_of_rpm(Fraction(1, 5), UNO)] == [Fraction(2, 3)]


def test_virtual_926533() -> None:
    """
    Chapter 6's example: 0x000E2345 becomes 0x000E2340 with prescaler 64, 99.999 % accurate.
    """
    rate = rate_of_virtual(926_533, UNO)

    assert (rate.timer_value, rate.prescaler, rate.period_clocks) == (14_477, 64, 926_528)
    assert f"{float(rate.interval_percent):.3f}" == "99.999"


@pytest.mark.parametrize(
    "row", [row for line in TABLE.split("\n") for row in line.split("|") if row]
)
def test_rpm_against_top(row: str) -> None:
    """
    Each row of chapter 8's table, to the seven digits that it has.
    """
    virtual, rate_sps, rpm = row.split()
    rate = rate_of_virtual(int(virtual), UNO)

    assert rate.virtual_clocks in TABLE_VIRTUALS_CLOCKS
    assert (f"{float(rate.real_sps):.7g}", f"{float(rate.rpm):.7g}") == (rate_sps, rpm)


def test_the_table_is_complete() -> None:
    """
    The table has 51 rows, from 1000 to 51000.
    """
    assert list(TABLE_VIRTUALS_CLOCKS) == [
        int(row.split()[0]) for line in TABLE.strip().split("\n") for row in line.split("|")
    ]


@pytest.mark.parametrize("clock", [Clock(16_000_000, 2), Clock(8_000_000, 1)])
def test_clkpr_divides_the_oscillator(clock: Clock) -> None:
    """
    16 MHz divided by 2 and 8 MHz are the same I/O clock: 8000000 // 180 = 44444, prescaler 1.
    """
    rate = rate_of_steps(Fraction(180), clock)

    assert clock.io_hz == 8_000_000
    assert (rate.virtual_clocks, rate.prescaler, rate.timer_value) == (44_444, 1, 44_444)


@pytest.mark.parametrize(
    ("rate_sps", "message"),
    [
        (Fraction(25_001), r"639 clocks .* too fast.*choose from 0.2384 to 25000 steps/s"),
        (Fraction(2, 10), r"80000000 clocks .* too slow.*0.07153 to 7500 RPM"),
        (Fraction(0), "above 0; choose from"),
    ],
)
def test_what_no_timer_can_do_is_refused(rate_sps: Fraction, message: str) -> None:
    """
    Beyond 0.2384 and 25000 steps/s at 16 MHz the error tells the range in both units.
    """
    with pytest.raises(StepgenError, match=message):
        virtual_of(rate_sps, UNO)


@pytest.mark.parametrize(
    ("f_cpu_hz", "clkpr", "steps_per_turn", "message"),
    [
        (0, 1, 200, "most boards have 16000000, a Pro Mini of 3.3 V has"),
        (16_000_001_000, 1, 200, "from 1 to 20000000 Hz"),
        (16_000_000, 3, 200, "CLKPR divides by 1, 2, 4, 8, 16, 32, 64, 128, 256 only"),
        (16_000_000, 1, 0, "more than 0 steps"),
    ],
)
def test_no_such_clock(f_cpu_hz: int, clkpr: int, steps_per_turn: int, message: str) -> None:
    """
    A clock that no AVR has is refused with what there is.
    """
    with pytest.raises(StepgenError, match=message):
        Clock(f_cpu_hz, clkpr, Fraction(steps_per_turn))


@given(st.fractions(Fraction(1, 4), 25_000))
def test_a_rate_is_never_slower_than_wanted(wanted_sps: Fraction) -> None:
    """
    Both remainders are dropped: the real period is shorter, by less than a clock and a tick.
    """
    rate = rate_of_steps(wanted_sps, UNO)

    assert rate.real_sps >= wanted_sps
    assert rate.period_clocks > UNO.io_hz / wanted_sps - 1 - rate.prescaler


@pytest.mark.parametrize("f_cpu_hz", [1, 20_000_000])
def test_an_oscillator_at_either_end_of_its_range(f_cpu_hz: int) -> None:
    """
    The datasheet has 20 MHz at most; there is no lower end but 1 Hz.
    """
    assert Clock(f_cpu_hz).f_cpu_hz == f_cpu_hz

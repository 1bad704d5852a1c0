"""
``stepgen plan --rate``, ``--rpm``, ``--virtual`` and ``--table``: what the timer makes of a rate.
"""

import json
from collections.abc import Iterable
from typing import Any

from stepgen.commands.dump import plain
from stepgen.commands.plan_options import RateWish, number
from stepgen.commands.report import print_tables, say
from stepgen.plan.rates import (
    TABLE_VIRTUALS_CLOCKS,
    Clock,
    Rate,
    rate_of_steps,
    rate_of_virtual,
    rates_of_rpm,
)
from stepgen.plan.speed_changes import Course

Row = tuple[str, ...]

# The source's second table: 1000 clocks, doubled 16 times by modifications of 1000, 2000 ...
_DOUBLING = Course(1_000, 1_000, faster=False, halving=True, count=16)


def show_rates(wish: RateWish, clock: Clock, *, as_json: bool) -> None:
    """
    Print what the timer makes of the rate that *wish* asks for, or the table of RPM against TOP.
    """
    if wish.table:
        _show_table(clock, as_json=as_json)
        return
    rates = _rates(wish, clock)
    if as_json:
        _say_json({"clock": plain(clock), "rates": [_plain(rate) for rate in rates]})
        return
    print_tables([(_title(rate, clock), (), _rows(rate, clock)) for rate in rates])
    for rate in rates:
        say(f"\n{rate.call}")


def _rates(wish: RateWish, clock: Clock) -> tuple[Rate, ...]:
    if wish.rpm is not None:
        return rates_of_rpm(number(wish.rpm, "--rpm"), clock)
    if wish.rate is not None:
        return (rate_of_steps(number(wish.rate, "--rate"), clock),)
    return (rate_of_virtual(wish.virtual or 0, clock),)


def _plain(rate: Rate) -> dict[str, Any]:
    return {**plain(rate), "call": rate.call}


def _say_json(value: Any) -> None:  # noqa: ANN401 - any JSON
    say(json.dumps(value, indent=2, ensure_ascii=False))


def _title(rate: Rate, clock: Clock) -> str:
    if rate.wanted_rpm is None:
        return "Rate"
    exact = rate.wanted_sps == clock.rate_of_rpm(rate.wanted_rpm)
    return "Exact RPM" if exact else "In whole steps per second, as motorTimerCalcPerSecond()"


def _rows(rate: Rate, clock: Clock) -> Iterable[Row]:
    if rate.wanted_rpm is not None:
        yield ("wanted RPM", _digits(rate.wanted_rpm))
    yield ("wanted rate", f"{_digits(rate.wanted_sps)} steps/s")
    yield ("I/O clock", f"{_digits(clock.io_hz)} Hz = {clock.f_cpu_hz} Hz / {clock.clkpr}")
    yield ("virtual TOP", f"{rate.virtual_clocks} clocks")
    yield ("timer value", f"{rate.timer_value} ticks: compare register {rate.compare}")
    yield ("prescaler", f"{rate.prescaler}")
    yield (
        "real interval",
        f"{rate.period_clocks} clocks, {float(rate.interval_percent):.3f} % of the virtual TOP",
    )
    yield ("real rate", f"{_digits(rate.real_sps)} steps/s")
    yield ("deviation", f"{float(rate.deviation_percent):+.5f} %")
    yield ("RPM", f"{_digits(rate.rpm)} at {_digits(clock.steps_per_turn)} steps/turn")
    if rate.rpm_deviation_percent is not None:
        yield ("RPM deviation", f"{float(rate.rpm_deviation_percent):+.6f} %")
    yield ("turns/s", _digits(rate.turns_per_second))


def _show_table(clock: Clock, *, as_json: bool) -> None:
    rates = [rate_of_virtual(virtual, clock) for virtual in TABLE_VIRTUALS_CLOCKS]
    doubled = [rate_of_virtual(virtual, clock) for virtual in _DOUBLING.virtuals()]
    increments = (0, *_DOUBLING.modifications())
    if as_json:
        doubling = [
            {"increment": increment, **_plain(rate)}
            for increment, rate in zip(increments, doubled, strict=True)
        ]
        linear = [_plain(rate) for rate in rates]
        _say_json({"clock": plain(clock), "rates": linear, "doubling": doubling})
        return
    turn = f"{_digits(clock.io_hz)} Hz, {_digits(clock.steps_per_turn)} steps/turn"
    rows = [
        (str(count), str(increment), *_table_row(rate))
        for count, (increment, rate) in enumerate(zip(increments, doubled, strict=True))
    ]
    print_tables(
        [
            (f"RPM against TOP: {turn}", ("Virtual TOP", "steps/s", "RPM"), map(_table_row, rates)),
            (
                f"With MOTOR_CTRL_VARIABLE_PWR: {turn}",
                ("Update", "Increment", "Virtual TOP", "steps/s", "RPM"),
                rows,
            ),
        ]
    )


def _table_row(rate: Rate) -> Row:
    return (
        str(rate.virtual_clocks),
        f"{float(rate.real_sps):.7g}",
        f"{float(rate.rpm):.7g}",
    )


def _digits(value: Any) -> str:  # noqa: ANN401 - any number
    return f"{float(value):.8g}"

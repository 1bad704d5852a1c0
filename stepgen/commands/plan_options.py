"""
The options of ``stepgen plan`` without a spec: a rate, the table, or a speed change.
"""

import re
from dataclasses import dataclass, fields
from fractions import Fraction
from pathlib import Path
from typing import Annotated

import typer

from stepgen.errors import StepgenError
from stepgen.plan.rates import Clock, rate_of_virtual, virtual_of

_NUMBER = re.compile(r"\d{1,12}(\.\d{1,12})?(/\d{1,12})?", re.ASCII)
_SPEED = re.compile(r"(?P<number>[\d./]+) ?(?P<unit>|rpm|clocks|steps/s)", re.IGNORECASE)

_RATES = "A rate instead of a SPEC"
_CHANGES = "A speed change instead of a SPEC"
_CLOCKS = "For both"


def _option(name: str, text: str, metavar: str, panel: str) -> typer.models.OptionInfo:
    info: typer.models.OptionInfo = typer.Option(
        name, help=text, metavar=metavar, rich_help_panel=panel, show_default=False
    )
    return info


RateOption = Annotated[str | None, _option("--rate", "Steps per second.", "N", _RATES)]
RpmOption = Annotated[str | None, _option("--rpm", "Turns per minute.", "N", _RATES)]
VirtualOption = Annotated[
    int | None, _option("--virtual", "A virtual timer TOP: clocks per step.", "N", _RATES)
]
TableOption = Annotated[
    bool, typer.Option("--table", help="RPM against TOP.", rich_help_panel=_RATES)
]
FromOption = Annotated[
    str | None,
    _option("--from", "Speed at the start: 6 (steps/s), 2rpm or 32000clocks.", "SPEED", _CHANGES),
]
ToOption = Annotated[str | None, _option("--to", "Speed at the end.", "SPEED", _CHANGES)]
FasterOption = Annotated[
    int | None, _option("--faster", "Instead of --to: the modification.", "CLOCKS", _CHANGES)
]
SlowerOption = Annotated[int | None, _option("--slower", "The same, slower.", "CLOCKS", _CHANGES)]
UpdatesOption = Annotated[int | None, _option("--updates", "Number of updates.", "N", _CHANGES)]
IntervalOption = Annotated[
    int | None, _option("--interval-ms", "Milliseconds between updates.", "N", _CHANGES)
]
TimeOption = Annotated[str | None, _option("--time", "Seconds it shall take.", "N", _CHANGES)]
TurnsOption = Annotated[
    str | None, _option("--turns", "Turns to be made meanwhile.", "N", _CHANGES)
]
StepsOption = Annotated[
    int | None, _option("--steps", "Steps to be made meanwhile.", "N", _CHANGES)
]
HalvingOption = Annotated[
    bool,
    typer.Option(
        "--halving",
        help="Halve (slower: double) the modification each time.",
        rich_help_panel=_CHANGES,
    ),
]
PlotOption = Annotated[
    Path | None, _option("--plot", "Draw speed against time.", "FILE.svg", _CHANGES)
]
OscillatorOption = Annotated[
    int | None, _option("--f-cpu", "Oscillator in Hz; 16000000 if not given.", "HZ", _CLOCKS)
]
ClkprOption = Annotated[
    int | None, _option("--clkpr", "Divider in CLKPR; 1 if not given.", "N", _CLOCKS)
]
StepsPerTurnOption = Annotated[
    str | None, _option("--steps-per-turn", "Such as 25792/405; 200 if not given.", "N", _CLOCKS)
]


@dataclass(frozen=True)
class RateWish:
    """
    The options that ask for a rate, as they were given; one of them may be.
    """

    rate: str | None
    rpm: str | None
    virtual: int | None
    table: bool


@dataclass(frozen=True)
class ChangeWish:
    """
    The options that ask for a speed change, as they were given.
    """

    start: str | None
    to: str | None
    faster: int | None
    slower: int | None
    updates: int | None
    interval_ms: int | None
    time: str | None
    turns: str | None
    steps: int | None
    halving: bool
    plot: Path | None


@dataclass(frozen=True)
class ClockWish:
    """
    The options about clock and motor, as they were given.
    """

    f_cpu: int | None
    clkpr: int | None
    steps_per_turn: str | None

    @property
    def clock(self) -> Clock:
        """
        Return the clock, 16 MHz with 200 steps in a turn for what was not given.
        """
        return Clock(
            Clock.f_cpu_hz if self.f_cpu is None else self.f_cpu,
            Clock.clkpr if self.clkpr is None else self.clkpr,
            Clock.steps_per_turn
            if self.steps_per_turn is None
            else number(self.steps_per_turn, "--steps-per-turn"),
        )


def given(*wishes: RateWish | ChangeWish | ClockWish) -> list[str]:
    """
    Return the options of *wishes* that the user gave, as they are written.
    """
    return [
        "--from" if part.name == "start" else f"--{part.name.replace('_', '-')}"
        for wish in wishes
        for part in fields(wish)
        if not any(getattr(wish, part.name) is absent for absent in (None, False))
    ]


def choose_form(spec: Path | None, rate: RateWish, change: ChangeWish, clock: ClockWish) -> None:
    """
    Refuse options that ask for two things at once, or for nothing.

    Raises:
        StepgenError: A spec beside these options, two questions, or none.
    """
    numbers = given(rate, change, clock)
    if spec is not None:
        if numbers:
            raise StepgenError.of(
                f"a SPEC and {' and '.join(numbers)} exclude each other: a spec has a clock and "
                "speeds of its own; give the one or the other"
            )
        return
    rates, changes = given(rate), given(change)
    if len(rates) > 1 or (rates and changes):
        raise StepgenError.of(
            f"{' and '.join([*rates, *changes])} ask for different things; give one of them"
        )
    if not rates and not changes:
        raise StepgenError.of(
            "there is nothing to plan; give a SPEC, or --rate, --rpm, --virtual or --table, or "
            "a speed change with --from and --to"
        )


def number(text: str, option: str) -> Fraction:
    """
    Return the positive number *text* of *option*, such as ``33.5`` or ``100/3``, exactly.

    Raises:
        StepgenError: It is none, or 0.
    """
    try:
        value = _ratio(text) if _NUMBER.fullmatch(text) else Fraction(0)
    except ZeroDivisionError:
        value = Fraction(0)
    if value <= 0:
        raise StepgenError.of(
            f"{option} takes a number above 0, such as 180, 33.5 or 100/3", text=text[:40]
        )
    return value


def _ratio(text: str) -> Fraction:
    numerator, _, denominator = text.partition("/")
    return Fraction(numerator) / Fraction(denominator or "1")


def virtual_of_speed(text: str, option: str, clock: Clock) -> int:
    """
    Return the virtual value of a speed such as ``6``, ``6steps/s``, ``2rpm`` or ``32000clocks``.

    Raises:
        StepgenError: No speed, or one out of the timer's range.
    """
    match = _SPEED.fullmatch(text.strip())
    if match is None:
        raise StepgenError.of(
            f"{option} takes a speed: 6 (steps/s), 2rpm or 32000clocks", text=text[:40]
        )
    value = number(match["number"], option)
    unit = match["unit"].lower()
    if unit == "clocks":
        return rate_of_virtual(int(value), clock).virtual_clocks
    return virtual_of(clock.rate_of_rpm(value) if unit == "rpm" else value, clock)

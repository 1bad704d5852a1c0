"""
``stepgen plan --from SPEED --to SPEED``: a speed change, its plot, and the call to paste.
"""

import json
import sys
from collections.abc import Iterable
from fractions import Fraction

from stepgen.commands.dump import plain
from stepgen.commands.plan_options import ChangeWish, given, number, virtual_of_speed
from stepgen.commands.plan_plot import describe, svg_plot, text_plot
from stepgen.commands.report import print_tables, require_svg, say
from stepgen.errors import StepgenError
from stepgen.plan.rates import Clock
from stepgen.plan.speed_changes import Course, SpeedChange, Update, plan_change
from stepgen.plan.speed_wishes import Wish, plan_wish
from stepgen.units import MILLISECONDS_PER_SECOND

Row = tuple[str, ...]

_MOST_ROWS = 40
_HEADING = ("Update", "s", "Virtual TOP", "Change", "Prescaler", "steps/s", "RPM", "Steps made")


def show_change(wish: ChangeWish, clock: Clock, *, as_json: bool) -> None:
    """
    Print the speed change that *wish* asks for, draw it, and print the call last.
    """
    require_svg(wish.plot)
    change = _change(wish, clock)
    if wish.plot is not None:
        wish.plot.write_text(svg_plot(change), encoding="utf-8")
    if as_json:
        say(json.dumps({**plain(change), "call": change.call}, indent=2, ensure_ascii=False))
        return
    print_tables(
        [(describe(change), _HEADING, _rows(change)), ("", (), _summary(change, wish))],
    )
    say("\n" + text_plot(change, ascii_only=not _can_show_braille()))
    say(f"\n{change.call}")


def _change(wish: ChangeWish, clock: Clock) -> SpeedChange:
    start = _required(wish.start, "--from")
    start_clocks = virtual_of_speed(start, "--from", clock)
    ends = [option for option in given(wish) if option in {"--to", "--faster", "--slower"}]
    if len(ends) != 1:
        raise StepgenError.of(
            "a speed change needs one end; give --to, or --faster or --slower with a modification, "
            f"and {' and '.join(ends)} are too many"
            if ends
            else "a speed change needs an end; give --to SPEED, or --faster or --slower with a "
            "modification in clocks"
        )
    if wish.to is None:
        return _change_by_modification(wish, start_clocks, clock)
    steps = None if wish.steps is None else Fraction(wish.steps)
    if wish.turns is not None:
        if steps is not None:
            raise StepgenError.of("--turns and --steps say the same; give one of them")
        steps = number(wish.turns, "--turns") * clock.steps_per_turn
    time_s = None if wish.time is None else number(wish.time, "--time")
    return plan_wish(
        Wish(
            start_clocks=start_clocks,
            end_clocks=virtual_of_speed(wish.to, "--to", clock),
            halving=wish.halving,
            updates=wish.updates,
            interval_ms=wish.interval_ms,
            duration_ms=None if time_s is None else time_s * MILLISECONDS_PER_SECOND,
            steps=steps,
        ),
        clock,
    )


def _change_by_modification(wish: ChangeWish, start_clocks: int, clock: Clock) -> SpeedChange:
    lengths = [option for option in given(wish) if option in {"--time", "--turns", "--steps"}]
    if lengths or wish.updates is None or wish.interval_ms is None:
        raise StepgenError.of(
            "--faster and --slower take --updates and --interval-ms and nothing else; for a time "
            "or a number of turns give the end with --to"
        )
    faster = wish.faster is not None
    clocks = (wish.faster if faster else wish.slower) or 0
    course = Course(start_clocks, clocks, faster, wish.halving, wish.updates)
    return plan_change(course, wish.interval_ms, clock)


def _required(value: str | None, option: str) -> str:
    if value is None:
        raise StepgenError.of(f"a speed change needs a start; give {option} SPEED")
    return value


def _rows(change: SpeedChange) -> Iterable[Row]:
    every = -(-change.count // _MOST_ROWS)
    sign = "-" if change.faster else "+"
    for update in change.updates:
        if update.number % every == 0 or update is change.end:
            yield (
                str(update.number),
                f"{update.due_ms / MILLISECONDS_PER_SECOND:.6g}",
                str(update.virtual_clocks),
                f"{sign}{update.modification_clocks}" if update.number else "",
                str(update.prescaler),
                *_speeds(update, change.clock),
                f"{update.steps_made:.1f}",
            )


def _speeds(update: Update, clock: Clock) -> tuple[str, str]:
    return f"{float(update.rate_sps):.6g}", f"{float(clock.rpm(update.rate_sps)):.6g}"


def _summary(change: SpeedChange, wish: ChangeWish) -> Iterable[Row]:
    end = change.end
    steps_per_turn = change.clock.steps_per_turn
    yield ("time", f"{end.due_ms / MILLISECONDS_PER_SECOND:.6g} s")
    turns = end.steps_made / float(steps_per_turn)
    yield ("steps", f"{end.steps_made:.1f}, the speed being constant between updates")
    yield ("turns", f"{turns:.6g} of {float(steps_per_turn):.8g} steps")
    if wish.to is not None:
        wanted_clocks = virtual_of_speed(wish.to, "--to", change.clock)
        missed = abs(end.virtual_clocks - wanted_clocks)
        yield ("end", f"{missed} clocks short of the wanted {wanted_clocks}")
    if change.count > _MOST_ROWS:
        yield ("rows", f"some of {change.count} updates; --json has all")
    slow = _waiting(change)
    if slow:
        plural = "speed is" if slow == 1 else "speeds are"
        yield ("note", f"{slow} {plural} below one step per update: updates wait for a step")


def _waiting(change: SpeedChange) -> int:
    """
    Return how many of the speeds before the end are so slow that an update must wait for a step.
    """
    slowest_sps = Fraction(MILLISECONDS_PER_SECOND, change.interval_ms)
    return sum(update.rate_sps < slowest_sps for update in change.updates[:-1])


def _can_show_braille() -> bool:
    try:
        "⣿│└─".encode(sys.stdout.encoding or "ascii")
    except (UnicodeEncodeError, LookupError):
        return False
    return True

"""
``stepgen init``: writes a first spec, from answers or from options.
"""

import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import typer

from stepgen import api
from stepgen.commands.report import say
from stepgen.devices import boards, find_board
from stepgen.draft import (
    Draft,
    Question,
    drive_kinds,
    libraries_of,
    motion_kinds,
    possible_timers,
    questions,
    rests,
    timing_kinds,
)
from stepgen.errors import StepgenError

EXAMPLE = (
    "Example: stepgen init fan.yaml --library Fan --board uno --drive four-wire "
    "--pins 'D4 D5 D6 D7'"
)


def _option(text: str, *values: str) -> Any:  # noqa: ANN401 - typer's own
    listed = f" One of {', '.join(values)}." if values else ""
    return typer.Option(help=text + listed, show_default=False)


def init(  # noqa: PLR0913 - one parameter for each option
    file: Annotated[Path, typer.Argument(metavar="[FILE]", help="Where the spec goes.")] = Path(
        "motor.yaml"
    ),
    *,
    library: Annotated[str | None, _option("The library's name.")] = None,
    board: Annotated[str | None, _option("The board.", *(known.name for known in boards()))] = None,
    uses: Annotated[str | None, _option("What else the sketch uses: 'Servo, Serial'.")] = None,
    motor: Annotated[str | None, _option("The motor's name.")] = None,
    drive: Annotated[str | None, _option("What drives it.", *drive_kinds())] = None,
    pins: Annotated[str | None, _option("Its pins: 'D4 D5 D6 D7'.")] = None,
    sequence: Annotated[str | None, _option("Its steps: full, wave or half.")] = None,
    field: Annotated[
        list[str] | None, _option("A field of the drive: driver=a4988; more than once.")
    ] = None,
    timing: Annotated[str | None, _option("What paces it.", *timing_kinds())] = None,
    timer: Annotated[int | None, _option("The timer's number.")] = None,
    motion: Annotated[str | None, _option("How it moves.", *motion_kinds())] = None,
    steps_per_turn: Annotated[
        int | None, _option("Full steps in one turn; 0 if it has no turns.")
    ] = None,
    at_rest: Annotated[str | None, _option("Its coils at rest.", *rests())] = None,
    ask: Annotated[
        bool | None,
        typer.Option("--ask/--no-ask", help="Ask for the rest; without it in a terminal only."),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Overwrite FILE.")] = False,
) -> None:
    """
    Write a first spec of one motor, with comments.

    In a terminal it asks for what no option gives, offers only what is possible, and takes the
    value in brackets where you press Enter. Elsewhere what is not given has its default.
    """
    given = _given(
        library=library,
        board=board,
        uses=None if uses is None else _listed(uses),
        motor=motor,
        drive=drive,
        timing=timing,
        timer=timer,
        motion=motion,
        at_rest=at_rest,
    )
    if steps_per_turn is not None:
        given["steps_per_turn"] = steps_per_turn or None
    fields = _given(pins=None if pins is None else pins.split(), sequence=sequence)
    if given.get("drive") is None and "pins" in fields:
        given["drive"] = "four-wire"
    fields |= dict(_assigned(text) for text in field or ())
    draft = replace(Draft(), **given, drive_fields=tuple(fields.items()))
    wants_answers = sys.stdin.isatty() if ask is None else ask
    draft = _ask(draft, given) if wants_answers else _with_timer(draft, given)
    api.init(draft, file, force=force)
    say(f"{file}: written; `stepgen generate {file}` writes the library {draft.library}")


def _given(**values: Any) -> dict[str, Any]:  # noqa: ANN401 - options of any type
    return {name: value for name, value in values.items() if value is not None}


def _assigned(text: str) -> tuple[str, Any]:
    """
    Return name and value of ``driver=a4988``.

    Raises:
        StepgenError: It is no such text.
    """
    name, equals, value = text.partition("=")
    if not equals:
        raise StepgenError.of("gives no value; write such as --field driver=a4988", text=text[:80])
    return name.strip(), Question(name).value(value)


def _listed(text: str) -> tuple[str, ...]:
    return tuple(part.strip() for part in text.split(",") if part.strip())


def _with_timer(draft: Draft, given: dict[str, Any]) -> Draft:
    """
    Return *draft* with the first timer that is possible, if none was asked for.
    """
    if {"timing", "timer"} & given.keys():
        return draft
    ways = possible_timers(draft)
    return replace(draft, timing=ways[0][0], timer=ways[0][1]) if ways else draft


def _ask(draft: Draft, given: dict[str, Any]) -> Draft:
    """
    Return *draft* with an answer to each question that no option has answered.
    """
    questions: tuple[tuple[str, str, Callable[[], tuple[str, ...]]], ...] = (
        ("library", "Name of the library", tuple),
        ("board", "Board", lambda: tuple(known.name for known in boards())),
        ("uses", "Libraries that the sketch uses, too", tuple),
        ("motor", "Name of the motor", tuple),
        ("drive", "Drive", drive_kinds),
        ("motion", "Motion", motion_kinds),
        ("steps_per_turn", "Full steps in one turn, 0 for none", tuple),
        ("at_rest", "Coils at rest", rests),
    )
    for name, question, choices in questions:
        if name not in given:
            draft = _ANSWERS.get(name, _plain)(draft, name, question, choices())
        if name == "drive":
            draft = _ask_fields(draft)
    return draft if {"timing", "timer"} & given.keys() else _ask_timer(draft)


def _plain(draft: Draft, name: str, question: str, choices: tuple[str, ...]) -> Draft:
    answer: dict[str, Any] = {name: _prompt(question, getattr(draft, name), choices)}
    return replace(draft, **answer)


def _uses(draft: Draft, _name: str, question: str, _choices: tuple[str, ...]) -> Draft:
    board = find_board(draft.board)
    offered = ", ".join(libraries_of(board)) if board else ""
    answer = _prompt(f"{question} ({offered})", "none", ())
    return replace(draft, uses=() if answer == "none" else _listed(answer))


def _steps(draft: Draft, name: str, question: str, choices: tuple[str, ...]) -> Draft:
    answer = _prompt(question, str(draft.steps_per_turn), choices)
    steps: dict[str, Any] = {name: (int(answer) if answer.isdecimal() else answer) or None}
    return replace(draft, **steps)


_ANSWERS = {"uses": _uses, "steps_per_turn": _steps}


def _ask_fields(draft: Draft) -> Draft:
    """
    Ask for what the drive needs; an answer that is its default goes without saying.
    """
    fields = dict(draft.drive_fields)
    for question in questions(draft.drive):
        if question.name in fields:
            continue
        answer = _prompt(question.text, question.default, ())
        if answer != question.default:
            fields[question.name] = question.value(answer)
    return replace(draft, drive_fields=tuple(fields.items()))


def _ask_timer(draft: Draft) -> Draft:
    """
    Ask for the timer, of those that are possible; where none is, the plan will say why.
    """
    ways = {f"{timing}:{number}": (timing, number) for timing, number in possible_timers(draft)}
    if not ways:
        return draft
    timing, number = ways[_prompt("Timing and its timer", next(iter(ways)), tuple(ways))]
    return replace(draft, timing=timing, timer=number)


def _prompt(question: str, default: str, choices: tuple[str, ...]) -> str:
    from rich.console import Console  # noqa: PLC0415 - rich is slow to import
    from rich.prompt import Prompt  # noqa: PLC0415 - the same

    console = Console(stderr=True, highlight=False)
    try:
        return Prompt.ask(
            question.replace("[", "\\["),
            console=console,
            choices=list(choices) or None,
            default=default,
            show_default=bool(default),
        )
    except EOFError:
        reason = "no answer came; give it as an option, or leave --ask out for the defaults"
        raise StepgenError.of(reason, text=question) from None

"""
A first spec, made of answers: its text with comments, and which answers are possible.
"""

import tempfile
from collections.abc import Iterable
from dataclasses import dataclass, replace
from io import StringIO
from pathlib import Path
from typing import Any, get_args, get_origin

from ruamel.yaml import YAML
from ruamel.yaml.error import YAMLError

from stepgen.devices import SKETCH_LIBRARIES, Board, find_board, library_claims
from stepgen.errors import Fault, StepgenError
from stepgen.plan.model import Plan
from stepgen.plan.planner import make_plan
from stepgen.spec import load_spec
from stepgen.spec.base import KindModel, kind_names
from stepgen.spec.drives import KINDS as DRIVES
from stepgen.spec.model import Motor
from stepgen.spec.motions import KINDS as MOTIONS
from stepgen.spec.timings import KINDS as TIMINGS

_NOTE_COLUMN = 42


@dataclass(frozen=True)
class Draft:
    """
    The answers of which a spec of one motor is made.

    Args:
        library: The library's name.
        board: The board's name.
        uses: What else the sketch uses.
        motor: The motor's name.
        drive: The kind of drive.
        drive_fields: Its other fields, such as pins, as YAML holds them.
        timing: The kind of timing.
        timer: The timer's number, None for the first free one.
        motion: The kind of motion.
        steps_per_turn: Full steps in one turn, or None.
        at_rest: ``hold`` or ``release``.
    """

    library: str = "MyMotor"
    board: str = "uno"
    uses: tuple[str, ...] = ()
    motor: str = "motor"
    drive: str = "motor-shield"
    drive_fields: tuple[tuple[str, Any], ...] = ()
    timing: str = "fast-pwm"
    timer: int | None = None
    motion: str = "constant"
    steps_per_turn: int | None = 200
    at_rest: str = "release"

    def text(self, file: str) -> str:
        """
        Return the spec as YAML for the file named *file*, each line with what it is for.
        """
        board = find_board(self.board)
        about = f"{board.title}; `stepgen boards {self.board}` shows its pins" if board else ""
        lines = [
            ("library: " + _flow(self.library), "folder, header and library name"),
            ("board: " + _flow(self.board), about),
            ("uses: " + _flow(list(self.uses)), "what else the sketch uses of the chip"),
            ("motors:", ""),
            (f"  {_flow(self.motor)}:", f"begins its functions, such as {self.motor}SetSpeed()"),
            *((f"    {key}: {_flow(value)}", note) for key, value, note in self._fields()),
        ]
        head = (
            f"# `stepgen check {file}` validates this, `stepgen generate {file}` writes the "
            f"library,\n# `stepgen plan {file}` shows every number and default.\n"
        )
        return head + "".join(_line(text, note) for text, note in lines)

    def _fields(self) -> Iterable[tuple[str, Any, str]]:
        drive = {"kind": self.drive, **dict(self.drive_fields)}
        timing = {"kind": self.timing} | ({} if self.timer is None else {"timer": self.timer})
        yield "drive", self.drive if not self.drive_fields else drive, "how it is wired"
        yield "timing", self.timing if self.timer is None else timing, "what paces its steps"
        kind = _kind(MOTIONS, self.motion)
        motion = {"kind": self.motion, **kind.first} if kind.first else self.motion
        yield "motion", motion, _first_sentence(kind)
        if self.steps_per_turn is not None:
            yield "steps_per_turn", self.steps_per_turn, "full steps in one turn of the shaft"
        yield "at_rest", self.at_rest, "what the coils do after a motion with an end"

    def plan(self, name: str = "spec.yaml") -> Plan:
        """
        Return what stepgen decides for the spec, whose file is called *name*.

        Raises:
            StepgenError: All faults of the answers; the places are lines of the spec's text.
        """
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / name
            path.write_text(self.text(name), encoding="utf-8")
            try:
                return make_plan(load_spec(path))
            except StepgenError as error:
                faults = (
                    Fault(fault.place.replace(f"{folder}/", ""), fault.text, fault.reason)
                    for fault in error.faults
                )
                raise StepgenError(faults) from None

    def is_possible(self) -> bool:
        """
        Tell whether the spec is a valid one.
        """
        try:
            self.plan()
        except StepgenError:
            return False
        return True


def drive_kinds() -> tuple[str, ...]:
    """
    Return the names of all drives.
    """
    return kind_names(DRIVES)


def motion_kinds() -> tuple[str, ...]:
    """
    Return the names of all motions.
    """
    return kind_names(MOTIONS)


def timing_kinds() -> tuple[str, ...]:
    """
    Return the names of all timings.
    """
    return kind_names(TIMINGS)


def rests() -> tuple[str, ...]:
    """
    Return what a motor may do at rest.
    """
    return get_args(Motor.model_fields["at_rest"].annotation)


@dataclass(frozen=True)
class Question:
    """
    A field of a drive that a first spec is asked for: what it is for, and its default as text.

    *several* tells whether the answer is a list, such as pins.
    """

    name: str
    text: str = ""
    default: str = ""
    several: bool = False

    def value(self, answer: str) -> Any:  # noqa: ANN401 - any YAML
        """
        Return *answer* as YAML holds it.

        Raises:
            StepgenError: It is no YAML.
        """
        if self.several:
            return answer.replace(",", " ").split()
        try:
            return YAML(typ="safe", pure=True).load(answer)
        except YAMLError:
            raise StepgenError.of(f"is no value for {self.name}", text=answer[:80]) from None


def questions(drive: str) -> tuple[Question, ...]:
    """
    Return what a *drive* is asked for: what it cannot do without, and what its kind names.
    """
    kind = _kind(DRIVES, drive)
    return tuple(
        Question(
            name,
            str(field.description).rstrip("."),
            "" if field.is_required() or field.default is None else str(field.default),
            get_origin(field.annotation) is tuple,
        )
        for name, field in kind.model_fields.items()
        if field.is_required() or name in kind.asked
    )


def libraries_of(board: Board) -> tuple[str, ...]:
    """
    Return what the sketch may use on *board*, as `uses` names it.
    """
    return tuple(name for name in SKETCH_LIBRARIES if library_claims(name, board))


def possible_timers(draft: Draft) -> tuple[tuple[str, int], ...]:
    """
    Return timing and timer of each way to pace the motor of *draft*, all else as it is.
    """
    board = find_board(draft.board)
    numbers = [timer.number for timer in board.mcu.timers] if board else []
    ways = ((timing, number) for timing in reversed(timing_kinds()) for number in numbers)
    return tuple(
        (timing, number)
        for timing, number in ways
        if replace(draft, timing=timing, timer=number).is_possible()
    )


def _kind(kinds: tuple[type[KindModel], ...], name: str) -> type[KindModel]:
    return next(kind for kind in kinds if kind.model_fields["kind"].default == name)


def _first_sentence(kind: type[KindModel]) -> str:
    """
    Return what the first line of a kind's docstring says behind its name.
    """
    line = (kind.__doc__ or "").strip().splitlines()[0]
    return line.partition(": ")[2].rstrip(".").replace("``", "")


def _flow(value: Any) -> str:  # noqa: ANN401 - any YAML
    """
    Return *value* as YAML in one line.
    """
    yaml = YAML(typ="safe", pure=True)
    yaml.default_flow_style, yaml.width = True, 10_000
    yaml.representer.sort_base_mapping_type_on_output = False  # `kind` comes first
    stream = StringIO()
    yaml.dump(value, stream)
    return stream.getvalue().removesuffix("\n").removesuffix("...").rstrip()


def _line(text: str, note: str) -> str:
    return f"{text:{_NOTE_COLUMN}}  # {note}\n" if note else f"{text}\n"

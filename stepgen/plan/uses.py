"""
What else the sketch uses: a library or function by name, and the pins that it is given.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial

from stepgen.devices import SKETCH_LIBRARIES, Board, Pin, library_claims
from stepgen.plan.pins import missing_pin

ANALOG_WRITE = "analogWrite"
_TAKES_PINS = ("Servo", "SoftwareSerial", "tone", ANALOG_WRITE)  # pins of the sketch's choice

Report = Callable[[str], None]
ReportAt = Callable[[int, str], None]


@dataclass(frozen=True)
class Use:
    """
    What the entries of a spec's ``uses`` with one name take.

    Args:
        name: The library or function.
        timers: Numbers of the timers that it takes.
        vectors: Names of the vectors that it defines.
        pins: The pins that it takes, those that the sketch gives it first.
    """

    name: str
    timers: tuple[int, ...]
    vectors: tuple[str, ...]
    pins: tuple[Pin, ...]

    @property
    def keeps_the_core_timers(self) -> bool:
        """
        Tell whether it leaves its timers as the core sets them up, so that others may too.
        """
        return self.name in (ANALOG_WRITE, "millis")


def accepted_uses(texts: Iterable[str], board: Board) -> tuple[Use, ...]:
    """
    Return what *texts* take on *board*, of a spec in which nothing is wrong with them.
    """
    return tuple(read_uses(texts, board, lambda _index, _reason: None).values())


def read_uses(texts: Iterable[str], board: Board, report: ReportAt) -> dict[int, Use]:
    """
    Return what *texts* take on *board*, by the index of the first text with each name.

    A text is a name, such as ``Serial``; behind the name of something that works on pins of
    the sketch's choice may stand those pins: ``analogWrite D5 D6``, ``tone D8``,
    ``SoftwareSerial D2 D3``. There are as many servos as pins behind ``Servo``, and without
    pins up to the 12 that need just one timer.

    Args:
        texts: The entries of ``uses``.
        board: The board.
        report: Takes the index of a text and what is wrong with it; the text is left out.
    """
    entries: dict[str, list[tuple[int, list[str]]]] = {}
    for index, text in enumerate(texts):
        name, *labels = text.split() or [""]
        entries.setdefault(name, []).append((index, labels))
    found = {}
    for name, parts in entries.items():
        named = [(index, label) for index, labels in parts for label in labels]
        pins = {board.find_pin(label): None for _, label in named}
        for index, label in named:
            if board.find_pin(label) is None:
                report(index, missing_pin(label, board))
        known = tuple(pin for pin in pins if pin)
        if len(known) == len(pins):
            index = parts[0][0]
            found[index] = _use(name, known, board, partial(report, index))
    return {index: use for index, use in found.items() if use}


def pwm_channel(pin: Pin) -> tuple[int, str] | None:
    """
    Return timer and channel behind analogWrite() on *pin*, such as (1, "A"); None without PWM.
    """
    outputs = (use.removeprefix("PWM OC") for use in pin.uses if use.startswith("PWM OC"))
    return next(((int(output[:-1]), output[-1]) for output in outputs), None)


def _use(name: str, pins: tuple[Pin, ...], board: Board, report: Report) -> Use | None:
    if name == ANALOG_WRITE:
        return _analog_write(pins, board, report)
    claims = library_claims(name, board)
    if claims is None:
        known = [known for known in SKETCH_LIBRARIES if library_claims(known, board)]
        report(
            f"stepgen does not know what {name[:40] or 'this'} takes on the {board.title}; it "
            f"knows {', '.join([*known, ANALOG_WRITE])}"
        )
        return None
    if pins and name not in _TAKES_PINS:
        report(f"{name} has pins of its own; write just `{name}`")
        return None
    timers = claims.timers
    if claims.objects_per_timer:
        count = max(1, -(-len(pins) // claims.objects_per_timer))
        if count > len(timers):
            most = len(timers) * claims.objects_per_timer
            report(f"the {board.title} has timers for {most} objects of {name}; use fewer")
            return None
        timers = timers[:count]
    own = tuple(pin for pin in board.pins if pin.bit in claims.pins)
    return Use(name, timers, tuple(vector.name for vector in claims.vectors), (*pins, *own))


def _analog_write(pins: tuple[Pin, ...], board: Board, report: Report) -> Use | None:
    others = ", ".join(pin.label for pin in board.pins if pwm_channel(pin))
    if not pins:
        report(f"say on which pins: `{ANALOG_WRITE} D3 D5`; those with PWM are {others}")
        return None
    channels = [pwm_channel(pin) for pin in pins]
    for pin, channel in zip(pins, channels, strict=True):
        if channel is None:
            report(f"{pin.label} has no PWM, {ANALOG_WRITE}() just switches it; take {others}")
    timers = dict.fromkeys(channel[0] for channel in channels if channel)
    return Use(ANALOG_WRITE, tuple(timers), (), pins) if None not in channels else None

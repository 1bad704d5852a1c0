"""
The spec: a board, its motors and the library's metadata, each with its local rules.
"""

import re
from typing import Annotated, Any, Literal, Self

from pydantic import (
    AfterValidator,
    BeforeValidator,
    Field,
    StringConstraints,
    field_validator,
    model_validator,
)

from stepgen.spec.base import SpecModel, short_form
from stepgen.spec.drives import Drive
from stepgen.spec.limits import Limits
from stepgen.spec.motions import Motion
from stepgen.spec.timings import Timing
from stepgen.spec.turns import Ratio, Steps, StepsPerMm
from stepgen.spec.watchdog import WatchdogMs

_LIBRARY_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,62}")
_MOTOR_NAME = re.compile(r"[a-z][A-Za-z0-9]{0,30}")
# What the helpers of a library begin with: millisCount(), checkSpeed(), enablesNeeded.
_HELPER_PREFIXES = frozenset(
    {"millis", "check", "choose", "print", "debug", "enables", "timer0"}
    | {"motorTimer", "motorWatchdog"}
)
# Headers of the Arduino core, of libraries that come with it or with the IDE, and of the C library
# and the compiler (a library stdint would take the place of <stdint.h>), and names that are no
# folder on Windows; in lower case, since file names there and on macOS do not tell it apart.
_DEVICES = {f"{device}{digit}" for device in ("com", "lpt") for digit in range(1, 10)}
_CORE_HEADERS = """
    arduino binary cdc client eeprom hardwareserial hardwareserial_private hid ipaddress main new
    pins_arduino pluggableusb print printable server servo softwareserial spi stream udp usbapi
    usbcore usbdesc wcharacter wire wiring_private wstring con prn aux nul
"""
_IDE_LIBRARIES = """
    bridge esplora ethernet firmata gsm keyboard liquidcrystal mouse robot_control robot_motor
    robotirremote sd spacebrewyun stepper temboo tft wifi
"""
_C_HEADERS = """
    alloca assert ctype errno fcntl float inttypes iso646 limits locale math setjmp signal stdalign
    stdarg stdatomic stdbool stddef stdfix stdint stdio stdlib stdnoreturn string syslimits tgmath
    time unistd unwind varargs
"""
_TAKEN_NAMES = _DEVICES | {*_CORE_HEADERS.split(), *_IDE_LIBRARIES.split(), *_C_HEADERS.split()}
_MOST_MOTORS = 16  # no chip has as many timers; more would only make reports long
_LONGEST_ISR_CYCLES = 1_000_000  # a sixteenth of a second
SHORT_FORMS = {"timer": "timing", "pins": "drive", "sequence": "drive"}
_DEFAULT_KINDS = {"timing": "fast-pwm", "motion": "constant"}
Category = Literal[
    "Display",
    "Communication",
    "Signal Input/Output",
    "Sensors",
    "Device Control",
    "Timing",
    "Data Storage",
    "Data Processing",
    "Other",
]

Line = Annotated[
    str,
    StringConstraints(strip_whitespace=True, pattern=r"^[^\x00-\x1f\x7f]*$", max_length=1000),
]
"""One line of text: no control characters, so that it cannot end a comment or a property."""

Url = Annotated[str, StringConstraints(pattern=r"^https?://[!#-;=?-\[\]_a-z~%]+$", max_length=500)]
"""A page that the IDE opens when its link is clicked: nothing but http and https."""

_VERSION_PART = "(0|[1-9][0-9]{0,4})"
Version = Annotated[
    str, StringConstraints(pattern=rf"^{_VERSION_PART}\.{_VERSION_PART}\.{_VERSION_PART}$")
]


class Library(SpecModel):
    """
    The metadata of the library that is written: what library.properties says.
    """

    name: str
    """A letter and up to 62 letters, digits or underscores: folder, header and library name."""
    version: Version = "1.0.0"
    """Three numbers."""
    author: Line = "unknown"
    """Who made the library."""
    maintainer: Line | None = None
    """Who looks after it; the author, if it is not given."""
    sentence: Line | None = None
    """What it does, in one sentence; the library manager shows it."""
    paragraph: Line | None = None
    """What follows the sentence there."""
    url: Url = "https://docs.arduino.cc/libraries/"
    """The address of a page about the library."""
    category: Category = "Device Control"
    """Where the library manager lists it."""

    @model_validator(mode="after")
    def _name_is_a_file_name(self) -> Self:
        if not _LIBRARY_NAME.fullmatch(self.name):
            raise ValueError(
                f'"{self.name[:80]}" names no library: it becomes a folder and a header, so use '
                "a letter followed by at most 62 letters, digits or underscores"
            )
        if self.name.lower() in _TAKEN_NAMES:
            raise ValueError(
                f'"{self.name}" is a header of the Arduino core or of C, a library that comes with '
                f"the IDE, or a device; choose another name, such as My{self.name}"
            )
        return self


def _as_library(value: Any) -> Any:  # noqa: ANN401 - whatever the YAML held
    return {"name": value} if isinstance(value, str) else value


def _long_form(value: Any) -> Any:  # noqa: ANN401 - whatever the YAML held
    """
    Move the short forms ``timer``, ``pins`` and ``sequence`` to where they belong.
    """
    if not isinstance(value, dict):
        return value
    long = dict(value)
    for short, part in SHORT_FORMS.items():
        if short not in long:
            continue
        inner = long.get(part, _DEFAULT_KINDS.get(part))
        inner = {"kind": inner} if isinstance(inner, str) else inner
        if not isinstance(inner, dict):
            continue
        if short in inner:
            raise ValueError(f"{short} is given twice, here and in {part}; remove one of them")
        long[part] = {**inner, short: long.pop(short)}
    for part, kind in _DEFAULT_KINDS.items():
        inner = long.get(part)
        if isinstance(inner, dict) and "kind" not in inner:
            long[part] = {"kind": kind, **inner}
    return long


class Budget(SpecModel):
    """
    What a motor may take of the chip at most; ``stepgen verify`` fails where it can take more.
    """

    isr_cycles: Annotated[int, Field(ge=1, le=_LONGEST_ISR_CYCLES)]
    """The most CPU cycles that one run of the step interrupt may take."""


class Motor(SpecModel):
    """
    One motor: how it is driven, what paces it, how it moves and what it does at rest.
    """

    drive: Drive
    """What drives the motor: `motor-shield`, or a mapping with kind and pins."""
    timing: Timing = Field(default="fast-pwm", validate_default=True)
    """What paces the steps: `fast-pwm` or `ctc` on a 16-bit timer, or `compare` on timer 2."""
    motion: Motion = Field(default="constant", validate_default=True)
    """How it moves: `constant` speed, or `update-events` that change the speed while it runs."""
    steps_per_turn: Steps | None = None
    """Full steps in one turn of the shaft: a number, or full_steps and gear."""
    steps_per_mm: StepsPerMm | None = None
    """Steps of the driver in one millimetre of the axis; microsteps count as steps."""
    at_rest: Literal["hold", "release"] = "release"
    """What the coils do after a motion with an end."""
    port: Literal["shared", "owned"] = "shared"
    """Whether the sketch may write other bits of the motor's ports; `owned` is faster."""
    limits: Limits | None = None
    """Limit switches, the range of positions, and homing, of a motor with ramps."""
    budget: Budget | None = None
    """What it may take of the chip at most, else verification fails."""
    max_steps_per_second: Ratio | None = None
    """The highest rate that the sketch will ask for; without it all that is proven."""
    command_timeout_ms: Annotated[int, Field(ge=10, le=30_000)] | None = None
    """How long it may run without a word from the sketch; then it stops. Without it for ever."""


def _motor_name(name: str) -> str:
    if not _MOTOR_NAME.fullmatch(name):
        raise ValueError(
            f'"{name[:80]}" names no motor: it begins each of its functions, so use a '
            "lower-case letter followed by at most 30 letters or digits, such as pan"
        )
    return name


MotorName = Annotated[str, AfterValidator(_motor_name)]
"""A motor's name, from which the names of its functions are made."""

MotorEntry = Annotated[Motor, BeforeValidator(_long_form)]


class Spec(SpecModel):
    """
    Everything that decides a library.

    ``uses`` names what else the sketch uses of the chip, so that conflicts are found:
    ``[Servo, Serial]``. Behind what works on pins of the sketch's choice may stand those pins:
    ``[analogWrite D9 D10, tone D8, SoftwareSerial D2 D3, Servo D5 D6]``; analogWrite needs them.
    """

    library: Annotated[Library, short_form(_as_library, Library | str)]
    """The library's name, or a mapping with its metadata."""
    board: str
    """The board, as `stepgen boards` names it."""
    motors: Annotated[dict[MotorName, MotorEntry], Field(min_length=1, max_length=_MOST_MOTORS)]
    """The motors by name; a name is a lower-case letter and up to 30 letters or digits."""
    uses: Annotated[tuple[str, ...], Field(strict=False)] = ()
    """What else the sketch uses of the chip, such as `Servo`, `Serial` or `analogWrite D5`."""
    watchdog_ms: WatchdogMs | None = None
    """How long the sketch may be silent before the watchdog resets the chip; else for ever."""

    @field_validator("motors")
    @classmethod
    def _motor_names_differ(cls, motors: dict[str, Motor]) -> dict[str, Motor]:
        taken = sorted(set(motors) & _HELPER_PREFIXES)
        if taken:
            raise ValueError(
                f'"{taken[0]}" begins names that every library has, such as those of its helpers; '
                "choose another name"
            )
        for name in motors:
            longer = [other for other in motors if re.match(rf"{name}[A-Z]", other)]
            if longer:
                raise ValueError(
                    f'"{longer[0]}" begins with "{name}", so that their functions could share a '
                    "name; rename one of them"
                )
        lower = [name.lower() for name in motors]
        if len(set(lower)) < len(lower):
            raise ValueError(
                "two motors have names that differ in case only; their constants would collide, "
                "so rename one of them"
            )
        return motors

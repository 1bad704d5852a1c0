"""
Specs of libraries with many motors, of every kind, up to all channels of the timers of a Mega.
"""

from collections.abc import Iterator
from pathlib import Path

CROWDED = """\
library: Crowded
board: mega
motors:
  aMotorWithTheLongestNameOfAll31: {drive: {kind: four-wire, pins: [D22, D23, D24, D25]}, timer: 1}
  second: {drive: {kind: four-wire, pins: [D50, D51, A0, A15]}, timer: 3}
  third: {drive: motor-shield, timer: 4}
  fourth: {drive: {kind: four-wire, pins: [D0, D21, D38, D39]}, timer: 5, motion: update-events}
"""

SIX = """\
library: Six
board: mega
uses: [Serial, Wire]
motors:
  x: {timing: {kind: compare, timer: 1, channel: A}, steps_per_turn: 200, MOVE,
      drive: {kind: step-dir, driver: a4988, socket: ramps-1.4 X, microsteps: 16}}
  y: {timing: {kind: compare, timer: 1, channel: B}, steps_per_turn: 400, MOVE,
      drive: {kind: step-dir, driver: a4988, socket: ramps-1.4 Y, microsteps: 16}}
  z: {timing: {kind: compare, timer: 3, channel: A},
      drive: {kind: step-dir, driver: a4988, socket: ramps-1.4 Z, microsteps: 16}}
  feed: {timing: {kind: compare, timer: 4, channel: A}, steps_per_turn: 200,
         drive: {kind: step-dir, driver: drv8825, socket: ramps-1.4 E0, microsteps: 32}}
  pan: {timing: {kind: compare, timer: 4, channel: B}, motion: update-events, steps_per_turn: 2048,
        drive: {kind: four-wire, pins: [D40, D42, D44, D59]}}
  tilt: {timing: {kind: compare, timer: 5, channel: A}, motion: update-events,
         drive: {kind: four-wire, pins: [D50, D51, D52, D53], sequence: half}}
""".replace("MOVE", "motion: {kind: trapezoid, cruise_speed: 1500, acceleration: 3000}")

SWITCHES = """\
library: Switches
board: mega
motors:
  aMotorWithTheLongestNameOfAll31: {timing: {kind: compare, timer: 1, channel: A}, MOVE,
      drive: {kind: step-dir, driver: a4988, socket: ramps-1.4 X}, limits: {low: D14, high: D15}}
  sensed: {timing: {kind: compare, timer: 1, channel: B}, MOVE, drive: motor-shield,
      limits: {high: {pin: D40, pull_up: false}, low: {pin: D41, active: high}}}
""".replace("MOVE", "motion: {kind: trapezoid, cruise_speed: 1500, acceleration: 3000}")

_PINS = (
    *(f"D{number}" for number in range(22, 54)),
    *(f"A{number}" for number in range(16)),
    *(f"D{number}" for number in range(2, 20)),
)
_CHANNELS = tuple(
    f"timer: {timer}, channel: {channel}" for timer in (1, 3, 4, 5) for channel in "ABC"
)


def _lines(library: str, motor: str, pins: int, count: int, *kinds: str) -> Iterator[str]:
    """
    Yield a spec of *count* motors, each on a compare channel, with as many *pins* of its own.
    """
    yield f"library: {library}"
    yield "board: mega"
    yield "motors:"
    for index in range(count):
        own = iter(_PINS[index * pins : (index + 1) * pins])
        what = kinds[index % len(kinds)]
        while "PIN" in what:
            what = what.replace("PIN", next(own), 1)
        what = what.replace("NUMBER", f"{index + 1}")
        yield f"  {motor}{index + 1}: {{timing: {{kind: compare, {_CHANNELS[index]}}}, {what}}}"


_AXIS = "steps_per_turn: 200, motion: {kind: trapezoid, cruise_speed: 10NUMBER, acceleration: 3000}"
_PLAIN = f"{_AXIS}, at_rest: hold, drive: {{kind: step-dir, driver: a4988, step: PIN, dir: PIN}}"
_HOMED = (
    "steps_per_mm: 80, drive: {kind: step-dir, driver: a4988, step: PIN, dir: PIN, enable: PIN}, "
    "motion: {kind: trapezoid, cruise_speed: 10 mm/s, acceleration: 600 mm/s^2}, limits: "
    "{low: PIN, high: PIN, homing: {towards: low, speed: 8 mm/s, slow_speed: 2 mm/s, "
    "back_off: 1 mm, travel: 1NUMBER mm, position: 0 mm}}"
)
_COILS = tuple(
    f"steps_per_turn: 2048, motion: {motion}, "
    f"drive: {{kind: four-wire, pins: [PIN, PIN, PIN, PIN], sequence: {sequence}}}"
    for motion, sequence in (
        ("constant", "full"),
        ("update-events", "half"),
        ("constant", "wave"),
        ("update-events", "full"),
        ("constant", "half"),
        ("update-events", "wave"),
    )
)

_LONG = ("x", "y", "z", "feed", "pan", "tilt")


def _with_long_names(text: str) -> str:
    """
    Return *text*, whose motors get names of twelve letters.
    """
    for name in _LONG:
        text = text.replace(f"\n  {name}: ", f"\n  {(name + 'OfTheMachine')[:12]}: ")
    return text


LARGE = {
    "crowded": CROWDED,
    "switches": SWITCHES,
    "six": SIX,
    "six with long names": _with_long_names(SIX),
    "six homed": "\n".join(_lines("SixHomed", "axis", 5, 6, _HOMED)),
    "twelve axes": "\n".join(_lines("TwelveAxes", "axis", 2, 12, _PLAIN)),
    "twelve homed": "\n".join(_lines("TwelveHomed", "axis", 5, 12, _HOMED)),
    "twelve coils": "\n".join(_lines("TwelveCoils", "coil", 4, 12, *_COILS)),
}


def large(name: str, folder: Path) -> Path:
    """
    Write a spec of ``LARGE`` into *folder*; return its path.
    """
    path = folder / "large.yaml"
    path.write_text(LARGE[name] + "\n", encoding="utf-8")
    return path

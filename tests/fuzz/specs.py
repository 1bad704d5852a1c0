"""
Hypothesis strategies: specs that are valid but for what motors take from each other, and others.

`specs` draws everything that a spec can say, as plain data. `nearly_valid_specs` breaks one or two
things of such a spec; `mutated_bytes` changes bytes of its file.
"""

from copy import deepcopy
from io import BytesIO
from typing import Any

from hypothesis import strategies as st
from ruamel.yaml import YAML

from stepgen.devices import DRIVERS, boards
from stepgen.spec.watchdog import WATCHDOG_MS
from stepgen.spec.yaml_guard import HIDDEN

Data = dict[str, Any]

# What reads as code somewhere, among names and texts that a spec may have.
KEYWORDS = ("auto", "class", "new", "operator", "void", "int", "volatile", "asm", "near", "f", "pi")
CODE = ("*/ int evil();", "\\", "??/", "{{ library.name }}", "%% for x in y", '"); evil("', "%s%n")
ODD: tuple[object, ...] = (
    None,
    True,
    False,
    0,
    -1,
    2**63,
    1.5,
    float("nan"),
    float("inf"),
    "",
    " ",
    "on",
    "012",
    [],
    {},
)

# PWM A, brakes B and A, PWM B, DIR A and B of the Arduino Motor Shield R3.
SHIELD_PINS = ("D3", "D8", "D9", "D11", "D12", "D13")

library_names = st.from_regex(r"X[A-Za-z0-9_]{0,62}", fullmatch=True)
motor_names = st.sampled_from(KEYWORDS) | st.from_regex(r"[a-z][A-Za-z0-9]{0,30}", fullmatch=True)
lines = st.sampled_from(CODE) | st.text(
    st.characters(exclude_categories=("C", "Zl", "Zp")), max_size=80
).filter(lambda text: not HIDDEN.search(text))
patterns = st.text("01", min_size=4, max_size=4)


def to_yaml(data: object) -> bytes:
    """
    Return *data* as the file of a spec.
    """
    stream = BytesIO()
    yaml = YAML(typ="safe")
    yaml.representer.ignore_aliases = lambda _: True  # a spec has no anchors
    yaml.dump(data, stream)
    return stream.getvalue()


@st.composite
def specs(draw: st.DrawFn) -> Data:
    """
    Draw a spec for any board: one to three motors, with pins of their own.
    """
    board = draw(st.sampled_from(boards()))
    # Serial, which the bench uses, keeps its pins.
    free = [pin.label for pin in board.pins if not {"Serial RX", "Serial TX"} & set(pin.uses)]
    most = min(3, len(board.mcu.timers) - 1)
    names = draw(st.lists(motor_names, min_size=1, max_size=most, unique_by=str.lower))
    compared = draw(st.sampled_from([*names, None]))
    shield = draw(st.sampled_from([*names, None]))
    if shield:
        free = [pin for pin in free if pin not in SHIELD_PINS]
    motors = {
        name: draw(motor(free if name != shield else [], timed=name != compared)) for name in names
    }
    watchdog = draw(
        st.fixed_dictionaries({}, optional={"watchdog_ms": st.sampled_from(WATCHDOG_MS)})
    )
    return {"library": draw(library()), "board": board.name, **watchdog, "motors": motors}


@st.composite
def library(draw: st.DrawFn) -> Data | str:
    """
    Draw a library's name, or all that it may say of itself.
    """
    name = draw(library_names)
    if draw(st.booleans()):
        return name
    texts = dict.fromkeys(("author", "maintainer", "sentence", "paragraph"), lines)
    version = st.tuples(*[st.integers(0, 99_999)] * 3).map(lambda parts: "{}.{}.{}".format(*parts))
    return {"name": name, **draw(st.fixed_dictionaries({}, optional={**texts, "version": version}))}


@st.composite
def motor(draw: st.DrawFn, free: list[str], *, timed: bool) -> Data:
    """
    Draw a motor on pins of *free*, which it takes away, or on the shield where none is free.

    It is on timer 2 unless it is *timed*, on one of 16 bits.
    """
    drives = [four_wire(free), step_dir(free)] if free else [motor_shield]
    drive = draw(st.one_of(drives))
    always_on = drive["kind"] == "step-dir" and "enable" not in drive
    gear = st.integers(1, 500) | st.sampled_from([63.68395, "25792/405", "1/3"])
    turn = st.fixed_dictionaries({"full_steps": st.integers(1, 2000), "gear": gear})
    options = {
        "at_rest": st.sampled_from(["hold"] if always_on else ["hold", "release"]),
        "port": st.sampled_from(["owned", "shared"]),
        "motion": st.sampled_from(["constant", "update-events"])
        | st.just({"kind": "update-events", "debug": True}),
        "steps_per_turn": st.integers(1, 1_000_000) | turn,
        "steps_per_mm": st.integers(1, 4000) | st.sampled_from([157.48, "20000/127"]),
        "command_timeout_ms": st.integers(10, 100),
    }
    needed = {"at_rest": options.pop("at_rest")} if always_on else {}
    return {
        "drive": drive,
        "timing": draw(st.sampled_from(["fast-pwm", "ctc"])) if timed else "compare",
        **draw(st.fixed_dictionaries(needed, optional=options)),
    }


@st.composite
def axis_specs(draw: st.DrawFn) -> Data:
    """
    Draw a spec for any board: one or two motors with ramps on compare channels of a timer.
    """
    board = draw(st.sampled_from(boards()))
    free = [pin.label for pin in board.pins if not {"Serial RX", "Serial TX"} & set(pin.uses)]
    names = draw(st.lists(motor_names, min_size=1, max_size=2, unique_by=str.lower))
    return {
        "library": draw(library_names),
        "board": board.name,
        "motors": {name: draw(axis(free)) for name in names},
    }


@st.composite
def axis(draw: st.DrawFn, free: list[str]) -> Data:
    """
    Draw a motor with ramps on pins of *free*, which it takes away.
    """
    drive = draw(st.one_of([four_wire(free), step_dir(free)]))
    always_on = drive["kind"] == "step-dir" and "enable" not in drive
    cruise = draw(st.integers(100, 12_000))
    motion = {
        "kind": "trapezoid",
        "cruise_speed": cruise,
        "acceleration": draw(st.integers(1 + cruise**2 // 100_000, 4 * cruise)),
    }
    options = {
        "start_speed": st.integers(1, cruise - 1),
        "queue": st.integers(1, 16),
        "jerk": st.integers(20 * cruise, 200 * cruise),
    }
    units: Data = {}
    if per_mm := draw(st.sampled_from([None, 1, 80, 400])):
        units["steps_per_mm"] = per_mm
        motion["cruise_speed"] = f"{cruise}/{per_mm} mm/s"
    if draw(st.booleans()):
        units["limits"] = draw(limits(free, cruise))
    return {
        **units,
        "drive": drive,
        "timing": {"kind": "compare", "timer": 1},
        "motion": motion | draw(st.fixed_dictionaries({}, optional=options)),
        "at_rest": draw(st.sampled_from(["hold"] if always_on else ["hold", "release"])),
        "port": draw(st.sampled_from(["owned", "shared"])),
    }


@st.composite
def limits(draw: st.DrawFn, free: list[str], cruise: int) -> Data:
    """
    Draw what an axis of up to *cruise* steps/s keeps to, with switches on pins of *free*.
    """
    ends = draw(st.lists(st.sampled_from(["low", "high"]), max_size=2, unique=True))
    found: Data = {}
    for end in ends:
        (pin,) = draw(pins_of(free, 1))
        if draw(st.booleans()):
            found[end] = pin
            continue
        active: str = draw(st.sampled_from(["low", "high"]))
        found[end] = {"pin": pin, "active": active, "pull_up": draw(st.booleans())}
    has_range: bool = draw(st.booleans())
    if has_range or not ends:
        found["range"] = [draw(st.integers(-2_000, 0)), draw(st.integers(1, 2_000))]
    homes: bool = draw(st.booleans())
    if ends and homes:
        speed = draw(st.integers(50, cruise))
        found["homing"] = {
            "towards": ends[0],
            "speed": speed,
            "slow_speed": draw(st.integers(20, max(20, min(speed, 400)))),
            "back_off": draw(st.integers(1, 40)),
            "travel": draw(st.integers(41, 2_000)),
            "position": draw(st.integers(-2_000, 0) if ends[0] == "low" else st.integers(1, 2_000)),
        }
    return found


sequences = st.sampled_from(["full", "wave", "half"])
motor_shield = st.fixed_dictionaries({"kind": st.just("motor-shield"), "sequence": sequences})


@st.composite
def four_wire(draw: st.DrawFn, free: list[str]) -> Data:
    """
    Draw four coils on pins of *free*, which it takes away.
    """
    tables = st.lists(patterns, min_size=3, max_size=32).filter(_steps)
    return {
        "kind": "four-wire",
        "pins": draw(pins_of(free, 4)),
        "sequence": draw(sequences | tables),
    }


@st.composite
def step_dir(draw: st.DrawFn, free: list[str]) -> Data:
    """
    Draw a driver with STEP and DIR, and perhaps ENABLE, on pins of *free*, which it takes away.
    """
    name = draw(st.sampled_from(sorted(DRIVERS)))
    signals = draw(st.sampled_from([("step", "dir"), ("step", "dir", "enable")]))
    pins: Data = dict(zip(signals, draw(pins_of(free, len(signals))), strict=True))
    if "enable" in pins and draw(st.booleans()):
        pins["enable"] = {"pin": pins["enable"], "active": draw(st.sampled_from(["low", "high"]))}
    microsteps = draw(st.sampled_from(DRIVERS[name].microsteps))
    return {"kind": "step-dir", "driver": name, **pins, "microsteps": microsteps}


@st.composite
def pins_of(draw: st.DrawFn, free: list[str], count: int) -> list[str]:
    """
    Draw *count* pins of *free*, which it takes away.
    """
    pins = draw(st.lists(st.sampled_from(free), min_size=count, max_size=count, unique=True))
    free[:] = [pin for pin in free if pin not in pins]
    return pins


def _steps(table: list[str]) -> bool:
    return all(one != two for one, two in zip(table, [*table[1:], table[0]], strict=True))


def _places(data: object) -> list[tuple[Any, Any]]:
    """
    Return each (mapping or list, key or index) of *data*, however deep.
    """
    items = data.items() if isinstance(data, dict) else enumerate(data)  # type: ignore[arg-type]
    found = []
    for key, value in items:
        found.append((data, key))
        found += _places(value) if isinstance(value, dict | list) else []
    return found


@st.composite
def nearly_valid_specs(draw: st.DrawFn) -> Data:
    """
    Draw a spec in which one or two things are missing, odd, twice there or elsewhere.
    """
    data = deepcopy(draw(specs()))
    for _ in range(draw(st.integers(1, 2))):
        place, key = draw(st.sampled_from(_places(data) or [(data, "library")]))
        other, source = draw(st.sampled_from(_places(data) or [(data, "library")]))
        change = draw(st.sampled_from(["drop", "odd", "copy", "add"]))
        if change == "drop":
            del place[key]
        elif change == "odd":
            place[key] = draw(st.sampled_from(ODD) | lines)
        elif change == "copy":
            place[key] = deepcopy(other[source])
        elif isinstance(place, dict):
            place[draw(lines)] = draw(st.sampled_from(ODD) | lines)
        else:
            place.append(draw(st.sampled_from(ODD) | lines))
    return data


@st.composite
def mutated_bytes(draw: st.DrawFn) -> bytes:
    """
    Draw a spec's file with a few stretches cut out, doubled or written over.
    """
    content = to_yaml(draw(specs()))
    for _ in range(draw(st.integers(1, 4))):
        begin = draw(st.integers(0, len(content)))
        end = min(len(content), begin + draw(st.integers(0, 20)))
        middle = draw(st.binary(max_size=8) | st.just(content[begin:end] * 2))
        content = content[:begin] + middle + content[end:]
    return content


__all__ = ["mutated_bytes", "nearly_valid_specs", "specs", "to_yaml"]

"""
A generated library as the proof sees it, and what it may take of functions proven by themselves.
"""

import re
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

import z3

from stepgen.plan.end_stops import EndStops
from stepgen.plan.model import Plan
from stepgen.reference.ladder import Ladder
from stepgen.verify.ladders import ladder_of
from stepgen.verify.proof.gimple import Function, functions
from stepgen.verify.proof.integers import U8, integer
from stepgen.verify.proof.memory import Place
from stepgen.verify.proof.numbers import wide
from stepgen.verify.proof.paths import Paths
from stepgen.verify.proof.source import Source, read_source
from stepgen.verify.recipes import IDE_VERSION, Target, board_properties, platform_dir

_CONSTANT = re.compile(r"^constexpr \w+ (\w+) = (\w+?)U?L*;", re.MULTILINE)
_STEPS_FOR = re.compile(
    r"^constexpr (u?int32_t) (\w+StepsFor(?:Turns|Micrometres))\((\w+) \w+\)", re.MULTILINE
)
_CHOOSE = ("chooseSetting", "chooseInterval", "chooseSpan")

PRESCALERS = {1: 1, 2: 8, 3: 64, 4: 256, 5: 1024}
"""What the clock select bits divide by; section "16-bit Timer/Counter", table "Clock Select"."""


LAP_TICKS = 1 << 14
"""How long a lap of a compare channel of a 16-bit timer is."""


@dataclass(frozen=True)
class Axis:
    """
    What is known of an axis.

    Args:
        ladder: What it climbs on.
        cruise_256: The shortest interval of it, in 1/256 clocks.
        stops: Its limits, if it has such.
        releases: Whether its coils go off at rest, an interval after the last step.
    """

    ladder: Ladder
    cruise_256: int
    stops: EndStops | None
    releases: bool


@dataclass(frozen=True)
class Library:
    """
    A library that can be proven.

    Args:
        source: What it declares.
        functions: The intermediate form of its functions, and ``proofNAME`` for each
            ``...StepsForTurns`` and ``...StepsForMicrometres`` of its header, which is *NAME*.
        min_top: MOTOR_MIN_TOP; 0 without a motor that has one.
        max_top: MOTOR_MAX_TOP.
        units: What makes steps of turns and micrometres: the names of those.
        steps_per_mm: The steps in a millimetre of the motors that have metric units.
        timeouts: The command time-outs of the motors that have one, in milliseconds.
        axes: What is known of those motors that are axes.
    """

    source: Source
    functions: dict[str, Function]
    min_top: int
    max_top: int
    units: tuple[str, ...]
    steps_per_mm: dict[str, Fraction]
    timeouts: dict[str, int]
    axes: dict[str, Axis]

    @property
    def chooses(self) -> list[str]:
        """
        Return the names of the functions that make a setting of a virtual TOP.
        """
        return [name for name in _CHOOSE if name in self.functions]

    def chooses_for(self, motor: str) -> str:
        """
        Return the name of the one for the timer of *motor*.
        """
        motion = self.source.structs[self.source.variables[f"{motor}Motion"]]
        return f"choose{motion['next']}"


def read_library(folder: Path, compiler: Path | str, plan: Plan, scratch: Path) -> Library:
    """
    Return the library of *plan* in *folder*, compiled in *scratch* by *compiler*.
    """
    (path,) = (folder / "src").glob("*.cpp")
    header = path.with_suffix(".h").read_text(encoding="utf-8")
    constants = dict(_CONSTANT.findall(header))
    units = _STEPS_FOR.findall(header)
    unit = scratch / path.name
    calls = "".join(_call(*unit) for unit in units)
    unit.write_text(path.read_text(encoding="utf-8") + calls, "utf-8")
    source, board = read_source(unit), plan.board
    core, variant = platform_dir(), board_properties(Target.from_fqbn(board.fqbn))["build.variant"]
    folders = (path.parent, core / "cores" / "arduino", core / "variants" / variant)
    defines = (f"-mmcu={board.mcu.name}", f"-DF_CPU={board.f_cpu_hz}UL", f"-DARDUINO={IDE_VERSION}")
    flags = (*defines, *(f"-I{folder}" for folder in folders))
    return Library(
        source=source,
        functions=functions(unit, compiler, flags),
        min_top=int(constants.get("MOTOR_MIN_TOP", 0)),
        max_top=int(constants.get("MOTOR_MAX_TOP", 0)),
        units=tuple(name for _, name, _ in units),
        steps_per_mm={
            motor.name: motor.steps_per_mm
            for motor in plan.motors
            if motor.steps_per_mm is not None
        },
        timeouts={
            motor.name: motor.command_timeout_ms
            for motor in plan.motors
            if motor.command_timeout_ms is not None
        },
        axes={
            motor.name: Axis(
                ladder,
                motor.motion.cruise_interval_256,
                motor.end_stops,
                motor.releases_at_rest,
            )
            for motor in plan.motors
            if (ladder := ladder_of(motor.motion))
        },
    )


def _call(result: str, name: str, kind: str) -> str:
    return f"\n{result} proof{name}({kind} amount) {{ return {name}(amount); }}\n"


class Chosen:
    """
    Stands for ``chooseSetting`` or ``chooseInterval``, which are proven by themselves.

    Of what it returns is known only what that proof says.
    """

    def __init__(self, library: Library, choose: str, paths: Paths) -> None:
        kinds = library.source.structs[choose.removeprefix("choose")]
        self._bits = {name: (integer(kind) or U8).bits for name, kind in kinds.items()}
        self._paths = paths

    def of(self, period: Any) -> dict[Place, Any]:  # noqa: ANN401 - z3 has no types
        """
        Return the parts of what is chosen for *period*: the same for the same term.
        """
        number = z3.simplify(period).get_id()
        return {
            (name,): z3.BitVec(f"{name} chosen for {number}", bits)
            for name, bits in self._bits.items()
        }

    def __call__(self, period: Any) -> dict[Place, Any]:  # noqa: ANN401
        """
        Return the same, and let what was proven of it be known.
        """
        chosen = self.of(period)
        self._paths.assume(right_choice(chosen, period))
        return chosen


def right_choice(chosen: dict[Place, Any], period: Any) -> Any:  # noqa: ANN401
    """
    Tell whether *chosen* makes up *period*, for the ranges that state.py and others rely on.
    """
    number = wide(period)
    if ("select",) in chosen:
        select, ticks = chosen[("select",)], wide(chosen[("top",)]) + 1
        ways = [
            z3.And(
                select == bits,
                ticks * prescaler <= number,
                number < (ticks + 1) * prescaler,
                z3.BoolVal(prescaler == 1) if prescaler == 1 else ticks >= _least_ticks(bits),
            )
            for bits, prescaler in PRESCALERS.items()
        ]
        return z3.Or(*ways)
    if ("ticks",) in chosen:
        ticks, laps = wide(chosen[("ticks",)]), wide(chosen[("laps",)])
        single = z3.And(z3.Implies(laps != 0, ticks >= LAP_TICKS), ticks < 2 * LAP_TICKS)
        return z3.And(span_ticks(chosen) == number, single)
    total = interval_ticks(chosen)
    matches = z3.And(z3.UGE(chosen[("first",)], 128), z3.ULE(chosen[("lapsHigh",)], 127))
    return z3.And(total == z3.LShR(number, 3), matches)


def _least_ticks(select: int) -> int:
    """
    Return the fewest ticks with *select*: with the next finer prescaler there are 65536 or more.
    """
    return 65_536 * PRESCALERS[select - 1] // PRESCALERS[select]


def interval_ticks(parts: dict[Place, Any]) -> Any:  # noqa: ANN401
    """
    Return the ticks of an interval of the timing ``compare``, as its interrupt counts them.

    Compare matches come *first* ticks after the step and then each 256, laps + 256 * lapsHigh of
    them (0 laps stand for 256); *last* ticks after those (0 stands for 256) comes the step.
    """
    first, last, laps, high = (
        wide(parts[(name,)]) for name in ("first", "last", "laps", "lapsHigh")
    )
    matches = z3.If(laps == 0, laps + 256, laps) + 256 * high
    return first + 256 * (matches - 1) + z3.If(last == 0, last + 256, last)


def span_ticks(parts: dict[Place, Any]) -> Any:  # noqa: ANN401
    """
    Return the clocks of an interval of a compare channel: those to its first match, and laps.
    """
    return wide(parts[("ticks",)]) + LAP_TICKS * wide(parts[("laps",)])

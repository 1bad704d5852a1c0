"""
The examples of a library do what they say, in simulation, with somebody typing where they ask.
"""

from itertools import pairwise
from pathlib import Path

import pytest

from stepgen import api
from stepgen.verify.bench import drive_switches
from stepgen.verify.compilers import default_compiler
from stepgen.verify.events import Kind
from stepgen.verify.simavr import Machine
from tests.sim.example_builds import build_example, example_names
from tests.sim.terminal import Terminal

SPECS = Path(__file__).parents[2] / "specs"
F_CPU_HZ = 16_000_000
CONSOLES = [
    path.stem for path in sorted(SPECS.glob("*.yaml")) if "Console" in example_names(api.plan(path))
]
OUT_OF_RANGE = 100_000  # more than motorTimerCalcPerSecond() can take
BESIDE = """
library: Beside
board: uno
uses: [Serial, SoftwareSerial D8 D9, tone D7, Wire, SPI, analogWrite D5]
motors:
  motor: {drive: {kind: four-wire, pins: [A0, A1, A2, A3]}, timer: 1}
"""


def terminal(stem: str, name: str) -> Terminal:
    """
    Return the board of a spec with one of its examples, and nobody at its limit switches.
    """
    spec = SPECS / f"{stem}.yaml"
    plan = api.plan(spec)
    board = Terminal(build_example(spec, name, default_compiler()), plan)
    for motor in plan.motors:
        drive_switches(board.machine, motor)
    return board


def step_cycles(machine: Machine, spec: Path, motor: int = 0) -> list[int]:
    """
    Return when the timer of a motor raised its interrupt: once per step, to the cycle.
    """
    plan = api.plan(spec)
    vector = plan.board.mcu.vector(plan.motors[motor].timing.vector).number
    events = machine.events()
    chosen = (events["kind"] == Kind.RAISE) & (events["source"] == vector)
    return [int(cycle) for cycle in events[chosen]["cycle"]]


def gaps(cycles: list[int]) -> list[int]:
    """
    Return the cycles from each to the next.
    """
    return [later - earlier for earlier, later in pairwise(cycles)]


def steady_gaps(machine: Machine, spec: Path, motor: int = 0) -> list[int]:
    """
    Return the gaps between steps, less those in which a ramp changes the prescaler.

    The timer is then set anew from the interrupt; that is once in a ramp, at 65536 clocks.
    """
    found = gaps(step_cycles(machine, spec, motor))
    steady = [gap for gap in found if gap % 2000 == 0]
    assert len(found) - len(steady) <= sum(
        (before < 1 << 16) != (after < 1 << 16) for before, after in pairwise(steady)
    )
    return steady


@pytest.mark.parametrize("stem", ["uno_motor_shield", "mega_pan_tilt"])
def test_the_smallest_sketch_turns_every_motor(stem: str) -> None:
    """
    Each motor makes 200 steps in a second, and goes on.
    """
    spec = SPECS / f"{stem}.yaml"
    machine = terminal(stem, "Smallest").machine
    machine.run_until(round(1.1 * F_CPU_HZ))

    for motor in range(len(api.plan(spec).motors)):
        found = gaps(step_cycles(machine, spec, motor))
        assert set(found) == {F_CPU_HZ // 200}
        assert len(found) > 200


@pytest.mark.parametrize("stem", CONSOLES)
def test_every_console_makes_the_steps_that_are_typed(stem: str) -> None:
    """
    Each motor of each library goes there and back, over a UART or over USB.
    """
    plan = api.plan(SPECS / f"{stem}.yaml")
    board = terminal(stem, "Console")
    board.until("type help\r\n")
    for motor in plan.motors:
        name = f"{motor.name} " if plan.motors[1:] else ""
        word = "move" if motor.motion.ladder else "steps"
        for steps, position in ((30, 30), (-20, 10)):  # a range may begin at 0
            board.enter(f"{name}{word} {steps}", "ok")
            board.wait(0.3)
            board.enter(f"{name}status", f"{motor.name} at rest, at step {position}")


@pytest.mark.parametrize("stem", ["uno_uln2003_28byj48", "leonardo_motor_shield"])
def test_the_console_moves_the_motor_as_it_is_told(stem: str) -> None:
    """
    Speed, steps, stop and status, with wrong input answered, while the motor turns.
    """
    board = terminal(stem, "Console")
    spec = SPECS / f"{stem}.yaml"
    name = api.plan(spec).motors[0].name
    board.until("type help\r\n")

    board.enter("status", f"{name} at rest, at step 0")
    board.enter("steps 120", "ok")
    board.enter("status", "", seconds=0.2)
    board.wait(0.7)
    board.enter("status", f"{name} at rest, at step 120")
    assert set(gaps(step_cycles(board.machine, spec))) == {F_CPU_HZ // 200}
    board.enter("speed -500", "ok")
    board.enter("fly", "what? type help")
    board.enter("steps", "that needs a number, and not 0")
    board.enter("steps 12x", "that needs a number, and not 0")
    board.enter("speed 0", "that needs a number, and not 0")
    board.enter("hold", "not while it runs")
    most = F_CPU_HZ // api.plan(spec).minimum_period_cycles
    board.enter(f"speed {most + 1}", f"too fast: at most {most}")
    board.enter(f"speed {OUT_OF_RANGE}", f"too fast: at most {most}")
    assert gaps(step_cycles(board.machine, spec))[-10:] == [F_CPU_HZ // 500] * 10
    board.enter("stop", "ok")
    made = len(step_cycles(board.machine, spec))
    board.wait(0.1)
    assert len(step_cycles(board.machine, spec)) == made
    shown = board.enter("status", "")
    assert shown.startswith(f"{name} at rest, at step ")


def test_the_console_of_an_axis_does_what_each_word_says() -> None:
    """
    Targets, ways, speeds, runs both ways, stops, and the coils; numbers that are none are told.
    """
    board = terminal("uno_trapezoid", "Console")
    board.until("type help\r\n")
    for typed, answer in (
        ("to 40", "ok"),
        ("speed 500", "ok"),
        ("speed 20000", "that is no speed, or faster than the spec's"),
        ("speed", "what? type help"),
        ("run", "ok"),
        ("on", "not while it runs"),
        ("stop", "ok"),
    ):
        board.enter(typed, answer)
    board.wait(0.3)
    rest = int(board.enter("status", "").removeprefix("slide at rest, at step "))
    assert rest > 0
    board.enter("zero", "ok")
    board.enter("back", "ok")
    board.wait(0.2)
    board.enter("halt", "ok")
    back = int(board.enter("status", "").removeprefix("slide at rest, at step "))
    assert -110 < back < -40  # 500 steps/s for 0.2 s, and up to 0.04 s for typing and looking
    for typed in ("on", "off", "to 0"):
        board.enter(typed, "ok")
    board.wait(0.5)
    board.enter("status", "slide at rest, at step 0")


def test_the_console_says_what_can_be_typed_and_that_the_motor_runs() -> None:
    """
    There is a line of help for each command; a motor on its way says so, and where it is then.
    """
    board = terminal("uno_variable_speed", "Console")
    board.until("type help\r\n")

    board.type(b"help\n")
    shown = board.until("where is it\n", seconds=0.3)
    words = [line.split()[0] for line in shown.splitlines() if line.strip()]
    assert words == ["speed", "steps", "stop", "hold", "release", "ramp", "status"]
    board.enter("speed -500", "ok")
    board.wait(0.5)
    position = int(board.enter("status", "").removeprefix("motor running, at step "))
    assert -280 < position < -250  # 500 steps/s, and up to 0.05 s for typing and looking


def test_the_console_ramps_a_motor_with_update_events() -> None:
    """
    It goes from 100 to 400 steps/s within 3 s, by itself, in equal changes of the interval.
    """
    board = terminal("uno_variable_speed", "Console")
    board.until("type help\r\n")
    board.enter("ramp", "ok")
    board.wait(3.1)

    found = steady_gaps(board.machine, SPECS / "uno_variable_speed.yaml")

    assert (found[0], found[-1]) == (F_CPU_HZ // 100, F_CPU_HZ // 400)
    assert {0, 2000} == {earlier - later for earlier, later in pairwise(found)}


def test_a_console_for_several_motors_takes_their_names() -> None:
    """
    Each motor obeys its own name; status and stop alone are for all.
    """
    board = terminal("mega_pan_tilt", "Console")
    spec = SPECS / "mega_pan_tilt.yaml"
    board.until("type help\r\n")

    board.enter("tilt speed 400", "ok")
    board.enter("pan steps -30", "ok")
    board.enter("nobody steps 30", "what? type help")
    board.enter("pan fly", "what? type help")
    board.wait(0.3)
    board.enter("status", "pan at rest, at step -30")
    board.until("tilt running, at step ")
    board.enter("pan status", "pan at rest, at step -30")
    board.enter("stop", "ok")
    board.enter("tilt release", "ok")
    board.enter("tilt status", "", seconds=0.2)
    pan, tilt = (gaps(step_cycles(board.machine, spec, motor)) for motor in (0, 1))
    assert set(pan) == {F_CPU_HZ // 200}
    assert set(tilt) == {F_CPU_HZ // 400}


def test_a_console_of_two_kinds_of_motors_takes_the_words_of_each() -> None:
    """
    A name decides which words there are; stop and status alone are for both kinds.
    """
    board = terminal("uno_28byj48_ramp", "Console")
    board.until("type help\r\n")

    for typed, answer in (
        ("feed speed 400", "ok"),
        ("motor run", "ok"),
        ("feed run", "what? type help"),
        ("motor steps 20", "what? type help"),
        ("motor speed 2000", "that is no speed, or faster than the spec's"),
        ("stop", "ok"),
    ):
        board.enter(typed, answer)
    board.wait(0.5)  # from 1000 steps/s down, 1000 steps/s slower each second: longer than that
    board.enter("motor halt", "ok")
    board.type(b"status\r\n")
    lines = board.until("\nfeed at rest, at step ").splitlines()
    assert lines[0].startswith("motor at rest, at step ")


@pytest.mark.parametrize("stem", ["uno_variable_speed", "mega_stacked_shields_variable"])
def test_the_ramp_goes_up_and_down_for_ever(stem: str) -> None:
    """
    From 100 to 400 steps/s and back, in changes of 2000 clocks, 60 of them in 3 s.
    """
    spec = SPECS / f"{stem}.yaml"
    machine = terminal(stem, "Ramp").machine
    machine.run_until(round(9.5 * F_CPU_HZ))
    changing = len(api.plan(spec).motors) - 1

    found = steady_gaps(machine, spec, changing)
    bottom = found.index(F_CPU_HZ // 400)
    top = found.index(F_CPU_HZ // 100, bottom)
    up, down, again = found[: bottom + 1], found[bottom : top + 1], found[top:]

    assert [up[0], down[0], again[0]] == [F_CPU_HZ // 100, F_CPU_HZ // 400, F_CPU_HZ // 100]
    for part, change in ((up, 2000), (down, -2000)):
        changes = [earlier - later for earlier, later in pairwise(part)]
        assert set(changes) == {0, change}
        assert changes.count(change) == 60
    assert min(again) == F_CPU_HZ // 400


def test_no_step_is_lost_beside_other_libraries(tmp_path: Path) -> None:
    """
    With SoftwareSerial, tone, Wire, SPI and PWM at work, steps come 200 a second and in order.
    """
    spec = tmp_path / "beside.yaml"
    spec.write_text(BESIDE.replace(", SPI", ""), encoding="utf-8")
    plan = api.plan(spec)
    board = Terminal(build_example(spec, "Together", default_compiler()), plan)
    board.wait(2.05)

    found = step_cycles(board.machine, spec)
    assert set(gaps(found)) == {F_CPU_HZ // 200}
    rows = board.machine.events()
    port = plan.board.mcu.port("C").port.address
    coils = [
        int(v) & 0x0F for v in rows[(rows["kind"] == Kind.PORT) & (rows["source"] == port)]["value"]
    ]
    changes = [after for before, after in pairwise(coils) if after != before]
    full_steps = [0b0011, 0b0110, 0b1100, 0b1001]
    first = full_steps.index(changes[0])
    assert changes == [full_steps[(first + k) % 4] for k in range(len(changes))]
    assert len(changes) in (len(found), len(found) + 1)  # the first shows where it stands
    assert [int(line) for line in board.text.split()][-1] in range(len(found) - 25, len(found) + 1)

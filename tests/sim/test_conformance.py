"""
The simulators against the datasheet, and what is not verified on one that differs from it.
"""

import dataclasses
from functools import partial
from pathlib import Path

import pytest

from stepgen import api
from stepgen.devices import boards
from stepgen.errors import StepgenError
from stepgen.plan.kernels import Ring, Toggle
from stepgen.plan.pulses import Pulse
from stepgen.spec.timings import KINDS as TIMINGS
from stepgen.verify import avr8js, yasimavr
from stepgen.verify.compilers import default_compiler
from stepgen.verify.conformance import Point, judge, needs, points
from stepgen.verify.conformance.lab import Lab, cycles, gaps
from stepgen.verify.events import Kind
from stepgen.verify.simulators import AVR8JS, SIMAVR, YASIMAVR, Simulator, simulator_named

SPECS = Path(__file__).parents[2] / "specs"
UNO, MEGA = SPECS / "uno_motor_shield.yaml", SPECS / "mega_pan_tilt.yaml"
THIRD = pytest.param(YASIMAVR, marks=pytest.mark.yasimavr)

# What cannot be put right, as `stepgen doctor` and docs/simulators.md list it. Of avr8js 0.21.1: no
# capture flag in mode 12; TEMP and ICR1 are no registers of their own; no transmit buffer; no USB.
# Of yasimavr 0.1.6: no compare pins. Both load the buffer at TCNT1 = 0.
WRONG = {
    "simavr": set(),
    "avr8js": {
        *("ctc-icr-period", "count-zero-loads-nothing"),
        *("temp-register", "icr-read-only", "uart-buffer", "uart-status"),
        *("usb-banks", "usb-port"),
    },
    "yasimavr": {
        *("ctc-icr-period", "count-zero-loads-nothing", "icr-read-only"),
        *("count-write-blocks", "compare-pins", "compare-pin-edges", "compare-force"),
    },
}
# The same simulators without what stepgen corrects.
RAW_AVR8JS = dataclasses.replace(AVR8JS, open=partial(avr8js.Machine, correct=False))
RAW_YASIMAVR = dataclasses.replace(YASIMAVR, open=partial(yasimavr.Machine, correct=False))
RAW_THIRD = pytest.param(RAW_YASIMAVR, marks=pytest.mark.yasimavr)


def name_of(value: object) -> str:
    """
    Return the name of a point or a simulator, for the name of a test.
    """
    return str(getattr(value, "name", value))


@pytest.mark.parametrize("point", points(), ids=name_of)
@pytest.mark.parametrize("simulator", [SIMAVR, AVR8JS, THIRD], ids=name_of)
def test_each_point_is_met_but_those_that_are_listed(simulator: Simulator, point: Point) -> None:
    """
    A simulator does what the datasheet demands, except in what is known and listed.
    """
    verdict = judge(point, simulator, default_compiler())

    if point.mcu not in simulator.mcus:
        assert verdict.word == "no chip"
    elif point.name in WRONG[simulator.name]:
        assert verdict.word == "wrong"
    else:
        assert verdict.findings == ()


@pytest.mark.parametrize("point", points(), ids=name_of)
@pytest.mark.parametrize("raw", [RAW_AVR8JS, RAW_THIRD], ids=name_of)
def test_what_is_called_corrected_is_wrong_without_the_correction(
    raw: Simulator, point: Point
) -> None:
    """
    `corrected` names exactly the points that the library by itself does not meet.
    """
    if point.mcu not in raw.mcus:
        return
    verdict = judge(point, raw, default_compiler())

    assert bool(verdict.findings) == (point.name in raw.corrected | WRONG[raw.name])


@pytest.mark.parametrize("other", [AVR8JS, THIRD], ids=name_of)
def test_the_slow_step_is_the_same_elsewhere(other: Simulator) -> None:
    """
    Double buffer and new prescaler: the timers made for simavr agree with another's own.

    From /1 with TOP 9999 to /8 with TOP 99, early in the period: what is left of 10 000 ticks is
    counted eight times as slowly, so the step takes nearly 80 000 cycles.
    """
    change = {"MODE": 15, "FROM": 9999, "TO": 99, "DELAY": 10, "CLOCK_TO": 2}
    seen = []
    for simulator in (SIMAVR, other):
        lab = Lab(simulator, default_compiler(), "atmega328p")
        with lab.running("change", watch=(), **change) as machine:
            machine.run_until(130_000)
            seen.append(cycles(machine, Kind.RAISE)[:10])

    ours, theirs = seen
    assert 79_000 < max(gaps(ours)) < 80_000
    assert sorted(set(gaps(ours)))[:2] == [800, 10_000]
    apart = [abs(one - two) for one, two in zip(ours, theirs, strict=True)]
    assert max(apart) <= other.tolerance_cycles


def test_every_kind_declares_the_points_that_it_needs() -> None:
    """
    Each timing, kernel and chip has an entry, and all that is named there exists.
    """
    kinds = {kind.model_fields["kind"].default for kind in TIMINGS}
    named = {
        *needs.ALWAYS,
        *(name for row in needs.OF_CHIP.values() for name in row),
        *(name for row in needs.OF_TIMING.values() for name in row),
        *(name for row in needs.OF_KERNEL.values() for name in row),
    }

    # Compare on a 16-bit timer: with periods of minutes, with ramps.
    forms = {"wide-compare", "long-compare", "ladder-compare"}
    assert set(needs.OF_TIMING) == kinds | forms
    assert set(needs.OF_KERNEL) == {Toggle.kind, Ring.kind, Pulse.kind}
    assert set(needs.OF_CHIP) == {board.mcu.name for board in boards()}
    assert named <= {point.name for point in points()}


@pytest.mark.parametrize("spec", sorted(SPECS.glob("*.yaml")), ids=lambda path: path.stem)
@pytest.mark.parametrize("simulator", [SIMAVR, AVR8JS], ids=name_of)
def test_every_spec_can_be_verified_on_two_simulators(simulator: Simulator, spec: Path) -> None:
    """
    Neither simavr nor avr8js is unlike the chip in what a spec depends on.
    """
    assert needs.refusal(api.plan(spec), simulator, default_compiler()) == ""


def test_a_simulator_that_fails_a_needed_point_is_refused_with_the_reason() -> None:
    """
    avr8js without corrections is refused for its prescaler, which restarts with the clock.
    """
    with pytest.raises(StepgenError) as caught:
        needs.refuse(api.plan(UNO), "my.yaml", RAW_AVR8JS, default_compiler())

    message = str(caught.value)
    assert message.startswith("my.yaml: error: avr8js 0.21.1 is unlike the chip")
    assert "prescaler-phase: first flag, clock /8" in message
    assert "double-buffer" not in message
    assert "ctc-wrap" not in message


def test_a_simulator_without_the_chip_is_refused() -> None:
    """
    A spec for the Mega is not run on a simulator that has no ATmega2560.
    """
    small = dataclasses.replace(AVR8JS, mcus=frozenset({"atmega328p"}))

    assert needs.refusal(api.plan(UNO), small, default_compiler()) == ""
    assert needs.refusal(api.plan(MEGA), small, default_compiler()) == (
        "avr8js 0.21.1 has no ATmega2560"
    )


def test_a_simulator_that_is_not_here_says_how_to_install_it() -> None:
    """
    What is missing is named with the way to get it, by `all` and by the name.
    """
    gone = dataclasses.replace(AVR8JS, find_version=lambda: None)

    assert "npm install --global" in needs.refusal(api.plan(UNO), gone, default_compiler())
    with pytest.raises(StepgenError, match="choose one of simavr, avr8js, yasimavr"):
        simulator_named("simulavr")

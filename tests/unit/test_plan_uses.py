"""
What else the sketch uses (``uses``): what it takes, and conflicts of motors with it.
"""

from collections.abc import Callable

import pytest

from stepgen.devices import Board
from stepgen.errors import Fault, StepgenError
from stepgen.plan.model import Plan
from stepgen.plan.planner import free_timers
from stepgen.plan.uses import read_uses

Planner = Callable[[str], Plan]
Faulty = Callable[[str], tuple[Fault, ...]]

_FREE_MEGA = "{drive: {kind: four-wire, pins: [A8, A9, A10, A11]}}"
_FREE_UNO = "{drive: {kind: four-wire, pins: [D4, D5, D6, D7]}}"
_UNO_TIMER_1 = "{drive: {kind: four-wire, pins: [D4, D5, D6, D7]}, timer: 1}"


@pytest.fixture
def faults(planned: Planner) -> Faulty:
    """
    Return a function that plans a spec in conflict and gives the faults.
    """

    def plan(text: str) -> tuple[Fault, ...]:
        with pytest.raises(StepgenError) as error:
            planned(text)
        return error.value.faults

    return plan


def _never(index: int, reason: str) -> None:
    raise AssertionError((index, reason))


def _lines(found: tuple[Fault, ...]) -> list[str]:
    return [f"{fault.place.split('spec.yaml', 1)[1]} {fault.reason}" for fault in found]


def test_servo_takes_the_only_timer_of_the_uno(faults: Faulty) -> None:
    """
    Known weakness 1 of system 1: nothing warned the user. Now something does, with a way out.
    """
    named = faults("board: uno\nuses: [Servo]\nmotors:\n  motor: {drive: motor-shield, timer: 1}\n")
    any_timer = faults("board: uno\nuses: [Servo]\nmotors:\n  motor: {drive: motor-shield}\n")

    (line,) = _lines(named)
    assert line == (
        ":5:39 timer 1 is taken by Servo and wanted by motor motor; "
        "take `timing: {kind: compare, timer: 2}` or a larger board, since no other 16-bit timer "
        "is left on this one, or remove Servo from `uses`"
    )
    assert any_timer[0].reason.endswith(
        "take `timing: {kind: compare, timer: 2}` or a larger board, or remove a motor or a "
        "library from `uses`"
    )


@pytest.mark.parametrize(
    ("servos", "free"),
    [(0, (1, 3, 4)), (1, (1, 3, 4)), (12, (1, 3, 4)), (13, (3, 4)), (25, (4,)), (37, ())],
)
def test_servo_takes_a_timer_of_the_mega_for_every_12(
    mega: Board, servos: int, free: tuple[int, ...]
) -> None:
    """
    Timers 5, 1, 3 and 4 go in this order (ServoTimers.h); without pins there are up to 12 servos.

    The 8-bit timer 2 is never theirs.
    """
    pins = [pin.label for pin in mega.pins[14 : 14 + servos]]
    uses = read_uses([" ".join(["Servo", *pins])], mega, _never)

    assert free_timers(mega, uses.values(), ()) == (*free, 2)


def test_more_servos_than_timers_are_refused(faults: Faulty) -> None:
    """
    Four timers with 12 servos each make 48.
    """
    pins = " ".join(f"D{number}" for number in range(5, 54))
    (fault,) = faults(f"board: mega\nuses: [Servo {pins}]\nmotors:\n  m: {_FREE_MEGA}\n")

    assert fault.reason == "the Arduino Mega 2560 has timers for 48 objects of Servo; use fewer"


def test_a_motor_beside_servo_on_the_mega_gets_a_free_timer(planned: Planner) -> None:
    """
    Without a timer in the spec, the first one that nobody wants is taken.
    """
    plan = planned("board: mega\nuses: [Servo]\nmotors:\n  motor: {drive: motor-shield}\n")

    assert plan.motors[0].timing.timer.number == 1


@pytest.mark.parametrize(("pin", "label"), [("D0", "D0 (PD0)"), ("D1", "D1 (PD1)")])
def test_serial_needs_its_pins(faults: Faulty, pin: str, label: str) -> None:
    """
    A coil on RX or TX is refused when the sketch uses Serial.
    """
    (fault,) = faults(
        "board: uno\nuses: [Serial]\nmotors:\n"
        f"  motor: {{drive: {{kind: four-wire, pins: [{pin}, D4, D5, D6]}}}}\n"
    )

    assert fault.reason.startswith(f"pin {label} is taken by Serial and wanted by motor motor")
    assert fault.reason.endswith("; give one of them other pins, or remove Serial from `uses`")


def test_without_serial_its_pins_are_free(planned: Planner) -> None:
    """
    What the sketch does not use takes nothing.
    """
    plan = planned(
        "board: uno\nmotors:\n  motor: {drive: {kind: four-wire, pins: [D0, D1, D5, D6]}}\n"
    )

    assert [wire.pin.label for wire in plan.motors[0].drive.wires] == ["D0", "D1", "D5", "D6"]


def test_an_unknown_library_is_refused_with_the_known_ones(faults: Faulty) -> None:
    """
    What stepgen does not know it cannot check; it says what it knows on this board.
    """
    (fault,) = faults("board: uno\nuses: [Serial1]\nmotors:\n  motor: {drive: motor-shield}\n")

    assert fault.text == "Serial1"
    assert fault.reason.startswith("stepgen does not know what Serial1 takes on the Arduino Uno")
    assert "Servo" in fault.reason


@pytest.mark.parametrize(
    ("pin", "why"),
    [
        ("D9", "it rewrites OCR1A, so that the motor would run away"),
        ("D10", "its PWM would follow the motor's timer"),
    ],
)
def test_analog_write_on_the_motors_timer_is_refused(faults: Faulty, pin: str, why: str) -> None:
    """
    OC1A is D9 and OC1B D10 (Uno pinout), OCR1A is TOP; PWM pins of no motor are the way out.
    """
    (fault,) = faults(f"board: uno\nuses: [analogWrite {pin}]\nmotors:\n  m: {_UNO_TIMER_1}\n")

    assert fault.reason == (
        f"timer 1 is taken by analogWrite on {pin} ({why}) and wanted by motor m; take `timing: "
        f"{{kind: compare, timer: 2}}` or a larger board, since no other 16-bit timer is left on "
        "this one, or use analogWrite on D3 or D11"
    )


def test_a_motor_takes_a_timer_without_analog_write(planned: Planner) -> None:
    """
    D11 and D12 of the Mega are PWM of timer 1, D2 of timer 3; timer 4 is the first free one.
    """
    uses = "[analogWrite D11 D12, analogWrite D2]"
    plan = planned(f"board: mega\nuses: {uses}\nmotors:\n  m: {_FREE_MEGA}\n")

    assert plan.motors[0].timing.timer.number == 4


def test_analog_write_shares_timer_0_with_millis(planned: Planner) -> None:
    """
    Both leave the timers as the core sets them up; so does PWM on two pins of one timer.
    """
    uses = "[millis, analogWrite D3 D11, Serial]"

    assert planned(f"board: uno\nuses: {uses}\nmotors:\n  m: {_FREE_UNO}\n").motors


@pytest.mark.parametrize(
    ("use", "reason"),
    [
        ("analogWrite", "say on which pins: `analogWrite D3 D5`; those with PWM are D3, D5, D6,"),
        ("analogWrite D7", "D7 has no PWM, analogWrite() just switches it; take D3, D5, D6, D9"),
        ("analogWrite D99", "the Arduino Uno has no pin D99; `stepgen boards uno` lists them"),
        ("Serial D0", "Serial has pins of its own; write just `Serial`"),
        ("' '", "stepgen does not know what this takes on the Arduino Uno; it knows"),
        ("Tone", "stepgen does not know what Tone takes on the Arduino Uno; it knows"),
    ],
)
def test_an_entry_of_uses_that_means_nothing_is_refused(
    faults: Faulty, use: str, reason: str
) -> None:
    """
    Each is reported once, at its place, with what can be written instead.
    """
    (fault,) = faults(f"board: uno\nuses: [{use}]\nmotors:\n  m: {_FREE_UNO}\n")

    assert fault.place.endswith(":3:8")
    assert fault.reason.startswith(reason)


def test_libraries_conflict_with_each_other(faults: Faulty) -> None:
    """
    tone() on timer 2 stops the PWM of D3 and D11 (Arduino reference, tone()).
    """
    uses = "[tone D8, analogWrite D3]"
    (fault,) = faults(f"board: uno\nuses: {uses}\nmotors:\n  m: {_FREE_UNO}\n")

    assert fault.reason.startswith("timer 2 is taken by tone and wanted by analogWrite on D3")


def test_pins_of_a_library_are_reported_together(faults: Faulty) -> None:
    """
    Two owners with several pins in common are one fault, with every pin.
    """
    (fault,) = faults(
        "board: mega\nuses: [Wire]\nmotors:\n"
        "  m: {drive: {kind: four-wire, pins: [D18, D19, D20, D21]}}\n"
    )

    assert fault.reason == (
        "pin D20 (PD1) and pin D21 (PD0) are taken by Wire and wanted by motor m; "
        "give one of them other pins, or remove Wire from `uses`"
    )


def test_pin_change_interrupts_are_free_for_software_serial(planned: Planner) -> None:
    """
    SoftwareSerial takes all pin-change vectors, and no motor needs one.
    """
    text = f"board: uno\nuses: [SoftwareSerial D2 D3]\nmotors:\n  m: {_FREE_UNO}\n"
    (motor,) = planned(text).motors

    assert "PCINT" not in motor.timing.vector

"""
The example sketch on a simulated chip: no mailbox, just the program that users see first.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np

from stepgen.plan.model import Plan
from stepgen.spec import LoadedSpec
from stepgen.verify.bench import Answer, Call, CallKind, drive_switches, watched_registers
from stepgen.verify.compare import Scene, compare
from stepgen.verify.events import Events, Kind
from stepgen.verify.scenarios import BACK, DRIVE
from stepgen.verify.shared_pins import compare_shared
from stepgen.verify.simulators import SIMAVR
from stepgen.verify.subject import Subject, subjects
from stepgen.verify.trace import Trace

_RUN_SECONDS = 2
_SPEED_SPS = 200
_DEFAULT_STEPS = 200


def run_example(loaded: LoadedSpec, plan: Plan, elf: Path) -> tuple[str, ...]:
    """
    Run the example for a few seconds; return what differs from the model, empty if nothing.

    The example turns each motor to and fro. Its calls are found by what they do: they start
    the timer of a motor at rest, from a stretch with interrupts off.
    """
    f_cpu_hz = plan.board.f_cpu_hz
    with SIMAVR.open(
        elf, mcu=plan.board.mcu.name, f_cpu_hz=f_cpu_hz, watch=watched_registers(plan)
    ) as machine:
        machine.fine = True
        for motor in plan.motors:
            drive_switches(machine, motor)
        machine.run_until(_RUN_SECONDS * f_cpu_hz)
        trace = Trace(_without_empty_sections(machine.events()), plan.board.mcu)
        until = machine.cycle
        findings = []
        results = []
        motors = [_kept_alive(motor) for motor in subjects(loaded, plan, elf)]
        for index, subject in enumerate(motors):
            answers = _calls(trace, subject, index, plan)
            if not answers:
                findings.append(f"{subject.name}: the example never starts it")
            result = compare(subject, index, Scene(trace, answers, plan, until))
            findings.extend(f"{subject.name}: {finding}" for finding in result.findings)
            if not result.steps:
                findings.append(f"{subject.name}: the example makes no step")
            results.append(result)
        findings.extend(compare_shared(motors, results, Scene(trace, (), plan, until)))
    return tuple(findings)


def _without_empty_sections(events: Events) -> Events:
    """
    Return *events* without the stretches with interrupts off in which nothing is recorded.

    A sketch that waits in delay() has a million of them in two seconds, and none starts a motor.
    """
    kinds = events["kind"]
    is_empty = (kinds[:-1] == Kind.MASKED) & (kinds[1:] == Kind.UNMASKED)
    kept = np.ones(len(events), dtype=bool)
    kept[:-1] &= ~is_empty
    kept[1:] &= ~is_empty
    return events[kept]


def _kept_alive(subject: Subject) -> Subject:
    """
    Return *subject* as one without a command time-out: the example's loop never lets it end.
    """
    return replace(subject, facts=replace(subject.facts, command_timeout_millis=None))


def _calls(trace: Trace, subject: Subject, index: int, plan: Plan) -> list[Answer]:
    """
    Return the calls that the example must have made, one for each start of its timer or channel.
    """
    motor = plan.motors[index]
    steps = round(motor.steps_per_turn) if motor.steps_per_turn else _DEFAULT_STEPS
    fastest_sps = plan.board.f_cpu_hz // plan.minimum_period_cycles
    top = plan.board.f_cpu_hz // min(_SPEED_SPS, fastest_sps)
    answers: list[Answer] = []
    for start in subject.clock_starts(trace):
        section = trace.masked_section(start.cycle)
        if section:  # the Arduino core's own init() starts every timer with interrupts on
            goes_back = bool(len(answers) % 2)
            control = BACK if goes_back else DRIVE
            call = Call(CallKind.SET_SPEED, index, control, top, steps)
            if subject.is_axis:
                near, far = motor.end_stops.to_and_fro(steps) if motor.end_stops else (0, steps)
                call = Call(CallKind.MOVE_TO, index, steps=near if goes_back else far)
            answers.append(Answer(call, *section, result=0, status=0, position=0))
    return answers

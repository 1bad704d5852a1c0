"""
Judging a library by its worst case: what was measured, what was planned, what the spec allows.
"""

from collections.abc import Iterator

from stepgen.devices import CORE
from stepgen.errors import StepgenError
from stepgen.plan.model import MotorPlan, Plan
from stepgen.spec import LoadedSpec
from stepgen.verify.bounds.worst_case import Bound, WorstCase, longest
from stepgen.verify.compilers import Compiler
from stepgen.verify.firmware import Firmware
from stepgen.verify.report import SpecReport

_NAME = "worst case"


def judge_worst_case(
    loaded: LoadedSpec, plan: Plan, firmware: Firmware, compiler: Compiler, report: SpecReport
) -> None:
    """
    Add to *report* the bounds of each motor and the check that all keep to them.

    Comes after the scenarios, since nothing that they measured may exceed its bound.
    """
    mcu = plan.board.mcu
    try:
        programs = [WorstCase(elf, mcu, compiler) for elf in (firmware.bench, firmware.example)]

        steps = {
            motor.name: longest([program.interrupt(motor.timing.vector) for program in programs])
            for motor in plan.motors
        }
        masked = longest([program.masked(f"{plan.library.name}.cpp") for program in programs])
        vectors = {vector.name for vector in mcu.vectors}
        core = {
            name: longest([program.interrupt(one.vector) for program in programs])
            for name, one in CORE.items()
            if one.vector in vectors
        }
    except StepgenError as error:
        report.check(_NAME, tuple(fault.reason for fault in error.faults), "")
        return
    findings: list[str] = []
    for motor in plan.motors:
        findings += _judge_motor(motor, steps[motor.name], loaded, report)
    findings += _over("a call can have interrupts off for", masked, plan.masked_bound_cycles)
    for name, bound in core.items():
        findings += _over(f"{CORE[name].cause} can take", bound, CORE[name].cycles)
    if report.masked_cycles > masked.cycles:
        findings.append(f"interrupts were off for {report.masked_cycles} of {masked.cycles} cycles")
    report.stack_bound_bytes = max(bound.stack_bytes for bound in steps.values())
    if report.stack_bytes > report.stack_bound_bytes:
        findings.append(f"{report.stack_bytes} of {report.stack_bound_bytes} bytes of stack")
    report.check(_NAME, tuple(findings), _summary(plan, steps, masked, core))


def _judge_motor(
    motor: MotorPlan, bound: Bound, loaded: LoadedSpec, report: SpecReport
) -> Iterator[str]:
    figures = report.motors[motor.name]
    figures.bound, figures.longest_path = bound.cycles, bound.path
    what = f"{motor.name}: a step interrupt can take"
    yield from _over(what, bound, motor.isr_bound_cycles)
    budget = loaded.spec.motors[motor.name].budget
    if budget and bound.cycles > budget.isr_cycles:
        yield f"{what} {bound.cycles} cycles, over the budget of {budget.isr_cycles}: {_way(bound)}"
    if figures.measured_max > bound.cycles:
        yield f"{motor.name}: a step interrupt took {figures.measured_max} of {bound.cycles} cycles"


def _over(what: str, bound: Bound, planned: int) -> Iterator[str]:
    if bound.cycles > planned:
        yield f"{what} {bound.cycles} cycles, and the plan allows {planned}: {_way(bound)}"


def _way(bound: Bound) -> str:
    return ", ".join(bound.path)


def _summary(
    plan: Plan,
    steps: dict[str, Bound],
    masked: Bound,
    core: dict[str, Bound],
) -> str:
    motors = ", ".join(
        f"{motor.name} {steps[motor.name].cycles} of {motor.isr_bound_cycles}"
        for motor in plan.motors
    )
    others = ", ".join(
        f"{name} interrupt {bound.cycles} of {CORE[name].cycles}" for name, bound in core.items()
    )
    return (
        f"by the plan's cycles at most: step interrupt {motors}, interrupts off in a call "
        f"{masked.cycles} of {plan.masked_bound_cycles}, {others}"
    )

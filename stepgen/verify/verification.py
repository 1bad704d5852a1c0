"""
Verifying a spec: compile it, run every scenario, compare, and measure.
"""

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

from stepgen.plan.model import Plan
from stepgen.plan.planner import make_plan
from stepgen.spec import LoadedSpec
from stepgen.verify.axis_scenarios import axis_scenarios
from stepgen.verify.bounds.judge import judge_worst_case
from stepgen.verify.conformance.needs import refuse
from stepgen.verify.example import run_example
from stepgen.verify.firmware import build_firmware
from stepgen.verify.late_scenarios import late_scenarios
from stepgen.verify.passed_scenarios import passed_scenarios
from stepgen.verify.ramps import judge_ramps
from stepgen.verify.report import MotorFigures, SpecReport
from stepgen.verify.runner import Outcome, is_asleep, run_scenario
from stepgen.verify.scenarios import Scenario, standard_scenarios
from stepgen.verify.sharing_scenarios import sharing_scenarios
from stepgen.verify.simulators import SIMAVR, Simulator
from stepgen.verify.slow_scenarios import slow_scenarios
from stepgen.verify.timeout_scenarios import timeout_scenarios
from stepgen.verify.toolchain import Compiler
from stepgen.verify.update_scenarios import update_scenarios
from stepgen.verify.watchdog_run import judge_watchdog, run_cycles

_EXAMPLE = "the example sketch"
_WATCHDOG = "the watchdog"
_LONG_RUN_STEPS = 10_000

Track = Callable[[Sequence[Scenario]], Iterable[Scenario]]


def verify_spec(
    loaded: LoadedSpec,
    compiler: Compiler,
    *,
    simulator: Simulator = SIMAVR,
    templates: Path | None = None,
    track: Track = iter,
) -> SpecReport:
    """
    Prove the library of *loaded*: every scenario by the model, the worst case by the plan.

    Args:
        loaded: The spec.
        compiler: Which avr-gcc builds it.
        simulator: What runs it. A slow one leaves out the scenarios that are too long for it,
            and the example.
        templates: Templates in place of stepgen's own, to see that a mutant is caught.
        track: Passes the scenarios on one by one, to show progress.

    Raises:
        StepgenError: The spec is refused, does not compile, or its firmware crashes or hangs; or
            *simulator* does not meet a point of the conformance suite that the spec depends on.
    """
    plan = make_plan(loaded)
    refuse(plan, str(loaded.document.path), simulator, compiler)
    report = SpecReport(str(loaded.document.path), compiler.name, simulator.title)
    firmware = build_firmware(plan, loaded.document.text, compiler, templates)
    report.flash_bytes, report.ram_bytes = firmware.flash_bytes, firmware.ram_bytes
    report.check(
        "compiles without a warning",
        (),
        f"{compiler.name}: {firmware.flash_bytes} bytes of flash and {firmware.ram_bytes} of RAM "
        "over an empty sketch",
    )
    report.motors = {
        motor.name: MotorFigures(
            max_steps_per_second=plan.board.f_cpu_hz / plan.minimum_period_cycles,
            rates=plan.rates[motor.name],
        )
        for motor in plan.motors
    }
    every = scenarios_of(plan)
    report.left_out = _left_out(every, plan, simulator)
    runs = [scenario for scenario, _ in every if scenario.name not in report.left_out]
    for scenario in track(runs):
        outcome = run_scenario(loaded, plan, firmware.bench, scenario, simulator)
        _judge(outcome, plan, report)
    if _EXAMPLE not in report.left_out:
        findings = run_example(loaded, plan, firmware.example)
        report.check(_EXAMPLE, findings, "every step as the model says")
    judge_ramps(loaded, plan, report)
    if plan.watchdog_ms is not None and _WATCHDOG not in report.left_out:
        findings = judge_watchdog(loaded, plan, firmware.bench, simulator)
        report.check(_WATCHDOG, findings, "a sketch that hangs is reset in time, and comes back")
    judge_worst_case(loaded, plan, firmware, compiler, report)
    return report


def scenarios_of(plan: Plan) -> list[tuple[Scenario, bool]]:
    """
    Return the scenarios of *plan*, and of each whether it makes steps so late that they count.
    """
    kinds = (
        standard_scenarios,
        update_scenarios,
        timeout_scenarios,
        sharing_scenarios,
        slow_scenarios,
        axis_scenarios,
    )
    usual = [(scenario, False) for kind in kinds for scenario in kind(plan)]
    late = (late_scenarios, passed_scenarios)
    return [*usual, *((scenario, True) for kind in late for scenario in kind(plan))]


def _left_out(
    every: Sequence[tuple[Scenario, bool]], plan: Plan, simulator: Simulator
) -> dict[str, str]:
    """
    Return what of *every* scenario and the example *simulator* cannot tell or is too slow for.
    """
    longest = simulator.longest_scenario_cycles
    reasons = {}
    for scenario, late in every:
        if late and not simulator.tells_overruns:
            reasons[scenario.name] = (
                f"{simulator.name} reads a counter a cycle off, on which it depends what is late"
            )
        elif longest is not None and scenario.cycles > longest:
            seconds = scenario.cycles / plan.board.f_cpu_hz
            reasons[scenario.name] = f"{seconds:.3g} s of simulated time, {simulator.name} is slow"
    if longest is not None:
        reasons[_EXAMPLE] = f"{simulator.name} is slow"
    if plan.watchdog_ms is not None:
        if not simulator.tells_resets:
            reasons[_WATCHDOG] = f"{simulator.name} does not tell what a reset does to the pins"
        elif longest is not None and run_cycles(plan) > longest:
            reasons[_WATCHDOG] = f"{simulator.name} is slow"
    return reasons


def _judge(outcome: Outcome, plan: Plan, report: SpecReport) -> None:
    """
    Add what *outcome* says to *report*: its check, and the figures of each motor.
    """
    findings = list(outcome.findings)
    if outcome.masked_cycles > plan.masked_bound_cycles:
        findings.append(
            f"interrupts were off for {outcome.masked_cycles} cycles in a call; "
            f"the plan allows {plan.masked_bound_cycles}"
        )
    steps = sum(comparison.steps for comparison in outcome.comparisons)
    report.check(
        outcome.scenario.name,
        tuple(findings),
        f"{steps} steps, {len(outcome.answers)} calls as the model says",
    )
    report.masked_cycles = max(report.masked_cycles, outcome.masked_cycles)
    report.stack_bytes = max(report.stack_bytes, outcome.stack_bytes)
    for comparison in outcome.comparisons:
        figures = report.motors[comparison.motor]
        figures.jitter_cycles = max(figures.jitter_cycles, comparison.jitter_cycles)
        if not is_asleep(outcome.scenario):
            longest = comparison.longest_isr_cycles
            figures.measured_max = max(figures.measured_max, longest)
        if comparison.steps >= _LONG_RUN_STEPS and not figures.cycles_per_step:
            figures.cycles_per_step = round(comparison.isr_cycles / comparison.steps, 2)

"""
What verification found: checks, figures, and their JSON.
"""

from dataclasses import dataclass, field
from typing import Any

from stepgen.plan.model import RateLimit


@dataclass(frozen=True)
class Check:
    """
    One thing that was checked, and what came out.
    """

    name: str
    passed: bool
    detail: str


@dataclass
class MotorFigures:
    """
    A motor's figures in CPU cycles.

    Args:
        measured_max: Longest single step interrupt, response through RETI.
        bound: The longest that the program allows, whatever happens: the static bound.
        longest_path: The way of that length, function by function.
        cycles_per_step: Mean taken from ``loop()`` for each step of a long constant run.
        max_steps_per_second: Fastest rate that the library accepts.
        jitter_cycles: Latest edge after its deadline, in any scenario.
        rates: The motor's highest safe rates, as planned, the last one beside all that is named.
    """

    measured_max: int = 0
    bound: int = 0
    cycles_per_step: float = 0.0
    max_steps_per_second: float = 0.0
    jitter_cycles: int = 0
    longest_path: tuple[str, ...] = ()
    rates: tuple[RateLimit, ...] = ()


@dataclass
class SpecReport:
    """
    The outcome of verifying one spec with one compiler on one simulator.

    *left_out* has what the simulator cannot run, by name, and why. The stack is that of the step
    interrupts, measured and as the program bounds it; *masked_cycles* is the longest that was
    measured with interrupts off in a call.
    """

    spec: str
    compiler: str
    simulator: str
    checks: list[Check] = field(default_factory=list)
    left_out: dict[str, str] = field(default_factory=dict)
    motors: dict[str, MotorFigures] = field(default_factory=dict)
    flash_bytes: int = 0
    ram_bytes: int = 0
    stack_bytes: int = 0
    stack_bound_bytes: int = 0
    masked_cycles: int = 0

    @property
    def passed(self) -> bool:
        """
        Tell whether every check passed; without a check nothing has.
        """
        return bool(self.checks) and all(check.passed for check in self.checks)

    def check(self, name: str, findings: tuple[str, ...], fine: str) -> None:
        """
        Add a check that passed if there are no *findings*; *fine* says what was seen then.
        """
        self.checks.append(Check(name, not findings, "; ".join(findings) or fine))

    def as_json(self) -> dict[str, Any]:
        """
        Return the object that ``stepgen verify --json`` prints.
        """
        return {
            "spec": self.spec,
            "compiler": self.compiler,
            "simulator": self.simulator,
            "passed": self.passed,
            "checks": [vars(check) for check in self.checks],
            "left_out": self.left_out,
            "motors": {
                name: {
                    "isr_cycles": {"measured_max": one.measured_max, "bound": one.bound},
                    "cycles_per_step": one.cycles_per_step,
                    "max_steps_per_second": one.max_steps_per_second,
                    "jitter_cycles": one.jitter_cycles,
                    "longest_path": list(one.longest_path),
                    "safe_rates": [
                        {
                            "beside": limit.beside,
                            "steps_per_second": limit.steps_per_second,
                            "cause": limit.cause,
                        }
                        for limit in one.rates
                    ],
                }
                for name, one in self.motors.items()
            },
            "flash_bytes": self.flash_bytes,
            "ram_bytes": self.ram_bytes,
            "stack_bytes": self.stack_bytes,
            "stack_bound_bytes": self.stack_bound_bytes,
        }

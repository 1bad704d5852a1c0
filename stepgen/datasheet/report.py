"""
What of a verification the datasheet shows: the object that ``stepgen verify --json`` prints.
"""

from pydantic import BaseModel, ConfigDict


class _Part(BaseModel):
    model_config = ConfigDict(frozen=True)


class Check(_Part):
    """
    One thing that was checked, and what came out.
    """

    name: str
    passed: bool
    detail: str


class IsrCycles(_Part):
    """
    A step interrupt from response through RETI: the longest measured, and what the program allows.
    """

    measured_max: int
    bound: int


class MotorFigures(_Part):
    """
    What was measured of a motor, in CPU cycles.
    """

    isr_cycles: IsrCycles
    cycles_per_step: float
    jitter_cycles: int


class Report(_Part):
    """
    A verification of one spec with one compiler on one simulator.
    """

    compiler: str
    simulator: str
    passed: bool
    checks: tuple[Check, ...]
    motors: dict[str, MotorFigures]
    flash_bytes: int
    ram_bytes: int
    stack_bytes: int
    stack_bound_bytes: int

"""
Runs the conformance suite.
"""

import functools
from collections.abc import Iterable
from dataclasses import dataclass

from stepgen.errors import StepgenError
from stepgen.verify.compilers import Compiler
from stepgen.verify.conformance.lab import Lab
from stepgen.verify.conformance.point import Point
from stepgen.verify.simulators import Simulator


@dataclass(frozen=True)
class Verdict:
    """
    What came of one point on one simulator.

    Args:
        point: The point.
        findings: What differs from the chip; None where the simulator has no such chip.
        is_corrected: Whether it is met only because stepgen puts the simulator right.
    """

    point: Point
    findings: tuple[str, ...] | None
    is_corrected: bool

    @property
    def is_met(self) -> bool:
        """
        Tell whether the simulator does what the chip does.
        """
        return self.findings == ()

    @property
    def word(self) -> str:
        """
        Return ok, corrected, wrong or no chip.
        """
        if self.findings is None:
            return "no chip"
        if self.findings:
            return "wrong"
        return "corrected" if self.is_corrected else "ok"


@functools.cache
def judge(point: Point, simulator: Simulator, compiler: Compiler) -> Verdict:
    """
    Return whether *simulator* meets *point*, with programs that *compiler* made.

    A program that crashes or hangs in it is a finding, too.
    """
    corrected = point.name in simulator.corrected
    if point.mcu not in simulator.mcus:
        return Verdict(point, None, corrected)
    try:
        findings = tuple(point.judge(Lab(simulator, compiler, point.mcu)))
    except (StepgenError, IndexError, ValueError, KeyError) as error:
        findings = (f"{type(error).__name__}: {error}",)
    return Verdict(point, findings, corrected)


def judge_all(
    points: Iterable[Point], simulator: Simulator, compiler: Compiler
) -> tuple[Verdict, ...]:
    """
    Return the verdict of each of *points*.
    """
    return tuple(judge(point, simulator, compiler) for point in points)

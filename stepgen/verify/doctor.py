"""
What is installed, and how far each simulator can be trusted.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from stepgen.verify.compilers import Compiler, find_compilers
from stepgen.verify.conformance import Point, Verdict, judge, points
from stepgen.verify.conformance.needs import dependents
from stepgen.verify.simulators import SIMAVR, SIMULATORS, Simulator


@dataclass(frozen=True)
class Diagnosis:
    """
    What was found.

    Args:
        compilers: The compilers, those of the PATH first.
        simulators: Every simulator that stepgen knows -> its version, None if it is not here.
        verdicts: Each point of the conformance suite -> simulator -> verdict, for those here.
    """

    compilers: tuple[Compiler, ...]
    simulators: dict[str, str | None]
    verdicts: dict[Point, dict[str, Verdict]]

    @property
    def is_fit(self) -> bool:
        """
        Tell whether specs can be verified: a compiler, and simavr meets all that any spec needs.
        """
        needed = [row for point, row in self.verdicts.items() if dependents(point)]
        return bool(needed) and all(
            SIMAVR.name in row and row[SIMAVR.name].is_met for row in needed
        )

    def failures(self) -> Iterator[tuple[str, Verdict]]:
        """
        Yield simulator and verdict of each point that is not met.
        """
        for row in self.verdicts.values():
            for name, verdict in row.items():
                if verdict.findings:
                    yield name, verdict

    def as_json(self) -> dict[str, Any]:
        """
        Return the object that ``stepgen doctor --json`` prints.
        """
        return {
            "fit": self.is_fit,
            "compilers": {one.name: one.version for one in self.compilers},
            "simulators": self.simulators,
            "points": [
                {
                    "name": point.name,
                    "demand": point.demand,
                    "section": point.source,
                    "mcu": point.mcu,
                    "needed_by": list(dependents(point)),
                    "simulators": {
                        name: {"verdict": verdict.word, "findings": list(verdict.findings or ())}
                        for name, verdict in row.items()
                    },
                }
                for point, row in self.verdicts.items()
            ],
        }


def diagnose(track: Callable[[Sequence[Point]], Iterable[Point]] = iter) -> Diagnosis:
    """
    Look for compilers and simulators and run the conformance suite on each simulator.

    *track* passes the points on one by one, to show progress.
    """
    compilers = find_compilers()
    versions = {simulator.name: simulator.find_version() for simulator in SIMULATORS}
    here = [simulator for simulator in SIMULATORS if versions[simulator.name]]
    tried = track(points()) if compilers else ()
    verdicts = {point: _row(point, here, compilers[0]) for point in tried}
    return Diagnosis(compilers, versions, verdicts)


def _row(point: Point, simulators: list[Simulator], compiler: Compiler) -> dict[str, Verdict]:
    return {simulator.name: judge(point, simulator, compiler) for simulator in simulators}

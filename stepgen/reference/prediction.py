"""
One whole run of the integer model at once.
"""

from collections.abc import Iterable
from dataclasses import dataclass

from stepgen.reference.contract import Code, Status
from stepgen.reference.facts import MotorFacts, ServiceCycle, served_at_once
from stepgen.reference.integer import MotorModel
from stepgen.reference.notices import CallbackMade
from stepgen.reference.stimuli import Edge, Stimulus


@dataclass(frozen=True)
class Prediction:
    """
    What a motor does in one run, and how it stands at its end.
    """

    edges: tuple[Edge, ...]
    return_codes: tuple[Code, ...]
    status: Status
    position: int
    running: bool
    steps_left: int | None
    callbacks: tuple[CallbackMade, ...] = ()
    overruns: int = 0


def predict(
    facts: MotorFacts,
    stimuli: Iterable[Stimulus],
    until_cycle: int,
    service_cycle: ServiceCycle = served_at_once,
) -> Prediction:
    """
    Return what the motor does with *stimuli*, in order of their cycles, up to *until_cycle*.

    Raises:
        ValueError: A stimulus lies before the one before it, or after *until_cycle*.
    """
    model = MotorModel(facts, service_cycle)
    for stimulus in stimuli:
        model.apply(stimulus)
    return Prediction(
        edges=tuple(model.advance(until_cycle)),
        return_codes=model.return_codes,
        status=model.status,
        position=model.position,
        running=model.running,
        steps_left=model.steps_left,
        callbacks=model.callbacks,
        overruns=model.overruns,
    )

"""
What is left of a scenario that fails: its smallest part that still does, as a scenario file.
"""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from random import Random
from typing import Self

import pytest
from hypothesis import HealthCheck, Phase, find, settings
from hypothesis import strategies as st
from hypothesis.errors import NoSuchExample

from stepgen import api
from stepgen.errors import StepgenError
from stepgen.plan.model import Plan
from stepgen.spec import LoadedSpec
from stepgen.verify.bench import Call
from stepgen.verify.firmware import build_firmware
from stepgen.verify.runner import run_scenario
from stepgen.verify.scenario_file import scenario_text
from stepgen.verify.scenarios import Action, Scenario
from stepgen.verify.toolchain import default_compiler

ROOT = Path(__file__).parents[2]
FAILURES = ROOT / "build" / "failures"
Actions = tuple[Action, ...]
Fails = Callable[[Scenario], bool]

# Hypothesis makes numbers smaller as long as it still fails. Of a range as wide as this, a random
# number is hardly ever 0: it begins with all actions, and ends with as many dropped as can be.
_KEEP = st.integers(0, (1 << 20) - 1)
_SETTINGS = settings(
    max_examples=20_000,
    database=None,
    deadline=None,
    phases=(Phase.generate, Phase.shrink),
    suppress_health_check=list(HealthCheck),
)


@dataclass(frozen=True)
class Library:
    """
    The library of a spec on the bench.
    """

    path: Path
    loaded: LoadedSpec
    plan: Plan
    elf: Path

    @classmethod
    def of(cls, stem: str, templates: Path | None = None) -> Self:
        """
        Return that of the spec *stem*; with *templates* in place of stepgen's own, for mutants.
        """
        path = ROOT / "specs" / f"{stem}.yaml"
        loaded, plan = api.load(path), api.plan(path)
        firmware = build_firmware(plan, loaded.document.text, default_compiler(), templates)
        return cls(path, loaded, plan, firmware.bench)

    def findings(self, scenario: Scenario) -> tuple[str, ...]:
        """
        Return what differs from the model in *scenario*; a crash differs too.
        """
        try:
            return run_scenario(self.loaded, self.plan, self.elf, scenario).findings
        except StepgenError as error:
            return (str(error),)

    def fails(self, scenario: Scenario) -> bool:
        """
        Tell whether anything differs from the model in *scenario*.
        """
        return bool(self.findings(scenario))

    def must_pass(self, scenario: Scenario) -> None:
        """
        Fail the test if *scenario* fails, with its smallest failing part as a file.
        """
        if self.fails(scenario):
            pytest.fail(self.failure(scenario))

    def failure(self, scenario: Scenario, folder: Path = FAILURES) -> str:
        """
        Shrink *scenario*, which fails, write what is left to *folder*, and return all of that.
        """
        smallest = shrink(scenario, self.fails)
        text = scenario_text(smallest, self.plan)
        name = "".join(c if c.isalnum() else "_" for c in f"{self.path.stem} {scenario.name}")
        folder.mkdir(parents=True, exist_ok=True)
        file = folder / f"{name}.yaml"
        file.write_text(text, encoding="utf-8")
        differs = "\n".join(self.findings(smallest))
        return f"{differs}\n\n{text}\nstepgen simulate {self.path} --scenario {file}"


def shrink(scenario: Scenario, fails: Fails) -> Scenario:
    """
    Return the smallest part of *scenario*, which fails, that still *fails*; always the same.
    """

    def still_fails(actions: Actions) -> bool:
        calls = any(isinstance(action, Call) for action in actions)
        return calls and fails(replace(scenario, actions=actions))

    actions = _thinned(scenario.actions, still_fails)
    with suppress(NoSuchExample):  # where it fails only as a whole
        actions = find(
            _parts(actions),
            still_fails,
            settings=_SETTINGS,
            random=Random(0),  # noqa: S311 - repeatable, not secret
        )
    return replace(scenario, actions=actions)


_FINE_PIECE = 8


def _thinned(actions: Actions, still_fails: Callable[[Actions], bool]) -> Actions:
    """
    Return *actions* without the pieces that are not needed: halves, then quarters, and so on.

    Trying a long scenario takes a while, and hypothesis, which does the rest, tries many.
    """
    pieces = 2
    while pieces <= len(actions):
        size = -(-len(actions) // pieces)
        place = 0
        while place < len(actions) and len(actions) > size:
            shorter = actions[:place] + actions[place + size :]
            if still_fails(shorter):
                actions = shorter
            else:
                place += size
        pieces *= 2
        if size < _FINE_PIECE:
            break
    return actions


@st.composite
def _parts(draw: st.DrawFn, actions: Actions) -> Actions:
    """
    Draw some of *actions*, in their order.
    """
    return tuple(action for action in actions if draw(_KEEP))

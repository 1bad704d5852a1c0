"""
Reports that ``stepgen matrix`` keeps.
"""

from collections.abc import Callable
from pathlib import Path

import pytest

from stepgen import api
from stepgen.verify import remembered
from stepgen.verify.compilers import default_compiler
from stepgen.verify.report import MotorFigures, SpecReport
from stepgen.verify.simulators import SIMAVR

SPEC = "library: Kept\nboard: uno\nmotors:\n  motor: {drive: motor-shield, timer: 1}\n"
Verified = Callable[[str], list[str]]


def report_of(spec: Path, *, may_refuse: bool = False) -> SpecReport | str:
    """
    Return the report of *spec* on simavr, or why that cannot be used.
    """
    tools = (default_compiler(), SIMAVR)
    return remembered.remembered_report(api.load(spec), *tools, may_refuse=may_refuse)


@pytest.fixture
def verified(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Verified:
    """
    Return a function that asks for the report of a spec twice, and gives what was really run.

    A motor called `bad` fails.
    """
    monkeypatch.setenv("STEPGEN_CACHE", str(tmp_path / "cache"))
    spec, runs = tmp_path / "spec.yaml", list[str]()

    def run(loaded: object, compiler: object, *, simulator: object) -> SpecReport:
        runs.append(f"{compiler}{simulator}")
        is_bad = " bad:" in spec.read_text(encoding="utf-8")
        report = SpecReport("spec", "gcc-5.4", "simavr", motors={"motor": MotorFigures(7)})
        report.check("steps", ("one too many",) if is_bad else (), f"fine, {loaded is not None}")
        return report

    monkeypatch.setattr(remembered, "verify_spec", run)

    def ask(text: str) -> list[str]:
        spec.write_text(text, encoding="utf-8")
        runs.clear()
        first, second = (report_of(spec) for _ in range(2))
        assert first == second
        assert isinstance(first, SpecReport)
        assert first.motors["motor"].measured_max == 7
        return list(runs)

    return ask


def test_what_passed_is_not_run_again_until_the_spec_changes(verified: Verified) -> None:
    """
    The report from the cache is the same; another text of the spec is another report.
    """
    assert len(verified(SPEC)) == 1
    assert verified(SPEC) == []
    assert len(verified(f"{SPEC}# changed\n")) == 1


def test_what_failed_is_run_again(verified: Verified) -> None:
    """
    A failure may come from the machine, and its reason must be shown each time.
    """
    assert len(verified(SPEC.replace(" motor:", " bad:"))) == 2


def test_another_stepgen_verifies_anew(verified: Verified, monkeypatch: pytest.MonkeyPatch) -> None:
    """
    The key holds the contents of stepgen itself.
    """
    assert len(verified(SPEC)) == 1
    monkeypatch.setattr(remembered, "stepgen_key", lambda: "another")
    assert len(verified(SPEC)) == 1


def test_why_a_simulator_is_not_used_is_kept_too(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """
    With may_refuse the reason is the result, and is worked out once.
    """
    monkeypatch.setenv("STEPGEN_CACHE", str(tmp_path / "cache"))
    spec, asked = tmp_path / "spec.yaml", list[object]()
    spec.write_text(SPEC, encoding="utf-8")

    def refuse(*tools: object) -> str:
        asked.append(tools)
        return "has no such chip"

    monkeypatch.setattr(remembered, "refusal", refuse)

    for _ in range(2):
        assert report_of(spec, may_refuse=True) == "has no such chip"
    assert len(asked) == 1

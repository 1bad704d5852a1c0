"""
`stepgen verify` says in its exit code and in words whether a library keeps its promises.
"""

from collections.abc import Callable
from pathlib import Path
from typing import Any

Stepgen = Callable[..., Any]

SPEC = """\
library: Quick
board: uno
motors:
  motor:
    drive: motor-shield
    timer: 1
    budget: {isr_cycles: 100}
"""


def test_a_step_interrupt_over_its_budget_fails(stepgen: Stepgen, tmp_path: Path) -> None:
    """
    Exit code 1, the budget beside what it can take, and with --paths the longest way.
    """
    (tmp_path / "quick.yaml").write_text(SPEC, encoding="utf-8")

    run = stepgen("verify", "quick.yaml", "--paths")

    assert run.code == 1
    assert "FAIL worst case: motor: a step interrupt can take" in run.out
    assert "over the budget of 100" in run.out
    assert "\n    response: 4 cycles\n" in run.out

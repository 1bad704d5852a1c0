"""
The rules that a library folder must keep for the Arduino IDE and its library manager.
"""

from stepgen.lint.linter import LintReport, lint
from stepgen.lint.rules import Finding, Rule

__all__ = ["Finding", "LintReport", "Rule", "lint"]

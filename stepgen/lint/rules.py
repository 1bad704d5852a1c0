"""
What a rule is, and the list of all of them.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from stepgen.lint.library import Library

Places = Iterable[tuple[str, str]]
"""Where a rule is broken, ``file`` or ``file:line`` inside the folder, and what is wrong."""

Check = Callable[[Library], Places]
"""Finds where a rule is broken."""


@dataclass(frozen=True)
class Rule:
    """
    One rule.

    Args:
        name: LS, LP, LC, LD and SS with a number are the rules of Arduino Lint, the checker of
            the library manager; LK and LJ are those of keywords.txt and library.json, which
            have none there.
        title: The rule in a few words.
        fix: What to do where it is broken.
        check: Finds where that is.
    """

    name: str
    title: str
    fix: str
    check: Check


@dataclass(frozen=True, order=True)
class Finding:
    """
    A place where a rule is broken: ``file`` or ``file:line``, the rule, what is wrong, the fix.
    """

    place: str
    rule: str
    reason: str
    fix: str

    def __str__(self) -> str:
        """
        Return the finding as one line of a compiler-like report.
        """
        return f"{self.place}: {self.rule}: {self.reason}; {self.fix}"


class RuleBook:
    """
    The rules of one subject; its method `rule` adds the function that it decorates.
    """

    def __init__(self) -> None:
        self.rules: list[Rule] = []

    def rule(self, name: str, title: str, fix: str) -> Callable[[Check], Check]:
        """
        Return a decorator that makes a check the rule *name*.
        """

        def add(check: Check) -> Check:
            self.rules.append(Rule(name, title, fix, check))
            return check

        return add

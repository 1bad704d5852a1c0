"""
What several motors share is told once, and nothing is lost by it.
"""

import re

from stepgen import api
from stepgen.datasheet.outcome import passed_checks
from stepgen.datasheet.tables import Table, told_once
from tests.datasheet.pages import page, report_of, spec

HEADING = ("motor", "drive", "pin", "none")


def test_a_column_of_one_value_is_a_note() -> None:
    """
    Columns that differ stay; one in which no row has anything goes without a note.
    """
    rows = (("x", "A4988", "D2", "-"), ("y", "A4988", "D3", "-"))
    more = (*HEADING, "port"), (("x", "A4988", "D2", "-", "D"), ("y", "A4988", "D3", "-", "E"))

    assert told_once(Table("T", *more)) == Table(
        "T", ("motor", "pin", "port"), (("x", "D2", "D"), ("y", "D3", "E")), "drive: A4988"
    )
    assert told_once(Table("T", HEADING, rows, "seen")) == Table(
        "T", (), (), "seen; drive: A4988; pin: x D2, y D3"
    )


def test_the_table_of_one_motor_stays() -> None:
    """
    With one row there is nothing that rows have in common.
    """
    table = Table("T", HEADING, (("x", "A4988", "D2", "-"),))

    assert told_once(table) is table


def test_checks_that_several_motors_passed_are_told_once() -> None:
    """
    Those of the library come first; a check that one motor failed is told of the others.
    """
    plan = api.plan(spec("mega_ramps_limits"))
    passed = {
        "compiles": True,
        "x: runs": True,
        "x: homing": True,
        "y: runs": True,
        "y: homing": False,
        "z: runs": True,
        "not a motor: odd": True,
    }
    checks = [{"name": name, "passed": good, "detail": ""} for name, good in passed.items()]
    report = report_of(plan, passed=False, checks=checks)

    assert list(passed_checks(report, plan)) == [
        ("", "compiles; not a motor: odd"),
        ("x, y and z", "runs"),
        ("x", "homing"),
    ]


def test_no_table_is_laid_out_as_another_kind_of_element() -> None:
    """
    Its class in the style is none that says how something else is laid out.
    """
    text = page(spec("uno_homing"))
    kinds = set(re.findall(r'<table class="(\w+)">', text))
    others = set(re.findall(r'<(?:dl|div|header) class="(\w+)">', text))

    assert kinds == {"motors", "wires", "plain", "safe", "numbers", "figures"}
    assert not kinds & others

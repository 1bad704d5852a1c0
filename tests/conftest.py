"""
What holds for all tests; and what the campaigns covered, at the end of their run.
"""

import pytest
from hypothesis import settings

settings.register_profile("stepgen", deadline=None)  # how long an example takes decides nothing
settings.load_profile("stepgen")


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """
    Print each property `campaign` that a test recorded.
    """
    lines = [
        str(value)
        for report in terminalreporter.getreports("passed")
        for name, value in report.user_properties
        if name == "campaign"
    ]
    if lines:
        terminalreporter.section("campaign")
    for line in sorted(lines):
        terminalreporter.write_line(line)

"""
Reports in the XML of JUnit, which CI services show.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from xml.etree import ElementTree as ET


@dataclass(frozen=True)
class Case:
    """
    One thing that was tried.

    Args:
        group: What it is about, such as a spec.
        name: What was tried.
        failure: What is wrong, or "".
        skipped: Why it was left out, or "".
    """

    group: str
    name: str
    failure: str = ""
    skipped: str = ""


def junit_xml(suites: Iterable[tuple[str, Iterable[Case]]]) -> str:
    """
    Return the report of *suites*, each a name and its cases.
    """
    root = ET.Element("testsuites")
    for title, cases in suites:
        suite = ET.SubElement(root, "testsuite", name=title)
        counts = {"tests": 0, "failures": 0, "skipped": 0}
        for case in cases:
            element = ET.SubElement(suite, "testcase", classname=case.group, name=case.name)
            counts["tests"] += 1
            for kind, tag, text in (
                ("failures", "failure", case.failure),
                ("skipped", "skipped", case.skipped),
            ):
                if text:
                    counts[kind] += 1
                    first = text.splitlines()[0]
                    ET.SubElement(element, tag, message=_plain(first)).text = _plain(text)
        suite.attrib.update({name: str(count) for name, count in counts.items()})
    ET.indent(root)
    return ET.tostring(root, encoding="unicode", xml_declaration=True) + "\n"


def _plain(text: str) -> str:
    """
    Return *text* without characters that XML cannot hold.
    """
    return "".join(c if c.isprintable() or c in "\t\n" else "?" for c in text)

"""
What YAML can do and a spec never needs: found in its events, before anything is built of them.
"""

import re
from collections.abc import Iterator
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.events import (
    AliasEvent,
    CollectionEndEvent,
    CollectionStartEvent,
    DocumentStartEvent,
    Event,
    NodeEvent,
    ScalarEvent,
)
from ruamel.yaml.scanner import RoundTripScanner

MAXIMUM_DEPTH = 12
MAXIMUM_NODES = 2000
_TOO_DEEP = "is nested too deeply for a spec; remove a level"
_LONGEST_NUMBER = 24  # digits and signs; 2**64 has 20

# Characters that nobody sees, or that make text look like other text: control characters, marks
# that turn the direction of writing, separators of lines that only some programs know, halves of
# characters. The joiners U+200C and U+200D stay: Persian names and emoji are written with them.
HIDDEN = re.compile(
    "[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\xad\u061c\u180e\u200b\u200e\u200f\u2028-\u202e"
    "\u2060-\u206f\ufeff\ufff9-\uffff\ud800-\udfff\U000e0000-\U000e0fff]"
)
_NUMBER = re.compile(r"[-+]?(0[xob])?[0-9A-Fa-f_]+")
_LEADING_ZERO = re.compile(r"[-+]?0[0-9_]*[0-9]")

Place = tuple[int, int]
"""Line and column, both counted from 0."""


class _TooDeepError(Exception):
    """
    Brackets within brackets, more of them than a spec has levels: how many follow decides nothing.
    """


class _ShallowScanner(RoundTripScanner):
    """
    Ruamel's, but it gives up at too many open brackets.

    Each may begin a key, so that it reads 1024 characters on before it tells of the first one, and
    compares each with all before it: a million times, for nothing.
    """

    def fetch_flow_collection_start(self, TokenClass: Any, to_push: str) -> None:  # noqa: ANN401, N803 - ruamel's
        """
        Note a bracket that opens.
        """
        if len(self.flow_context) == MAXIMUM_DEPTH:
            mark = self.reader.get_mark()
            raise _TooDeepError(mark.line, mark.column)
        super().fetch_flow_collection_start(TokenClass, to_push)


def hidden_character(text: str) -> str:
    """
    Return why *text* is refused for a character that nobody sees in it, or "".
    """
    found = HIDDEN.search(text)
    if not found:
        return ""
    return f"holds the character U+{ord(found[0]):04X}, which nobody sees; remove it"


def unwanted(text: str) -> tuple[Place, str] | None:
    """
    Return where the YAML *text* first has what no spec needs, and what to do; None if nowhere.

    Refused are anchors, aliases, tags, merge keys, directives, a second document, more than
    `MAXIMUM_DEPTH` levels or `MAXIMUM_NODES` values, hidden characters behind escapes, and
    numbers that programs read differently. Nothing is read beyond the first of them, so what
    it would grow into costs nothing.

    Raises:
        YAMLError: *text* is no YAML.
    """
    try:
        return _first_unwanted(text)
    except _TooDeepError as error:
        line, column = error.args
        return (line, column), _TOO_DEEP


def _first_unwanted(text: str) -> tuple[Place, str] | None:
    documents = depth = nodes = 0
    yaml = YAML(typ="rt", pure=True)
    yaml.Scanner = _ShallowScanner
    for event in yaml.parse(text):
        place = (event.start_mark.line, event.start_mark.column)
        documents += isinstance(event, DocumentStartEvent)
        depth += isinstance(event, CollectionStartEvent)
        depth -= isinstance(event, CollectionEndEvent)
        nodes += isinstance(event, NodeEvent)
        if documents > 1:
            return place, "begins another document; a file holds one spec, so split it"
        if depth > MAXIMUM_DEPTH:
            return place, _TOO_DEEP
        if nodes > MAXIMUM_NODES:
            return place, f"is too much: a spec has at most {MAXIMUM_NODES} values; remove some"
        reason = next(_reasons(event), "")
        if reason:
            return place, reason
    return None


def _reasons(event: Event) -> Iterator[str]:
    if isinstance(event, DocumentStartEvent) and (event.version or event.tags):
        yield "% directives have no use in a spec; remove the line"
    if isinstance(event, AliasEvent) or getattr(event, "anchor", None) is not None:
        yield "tags and anchors have no use in a spec; remove it"
    if str(getattr(event, "tag", None) or "") not in ("", "None"):
        yield "tags and anchors have no use in a spec; remove it"
    if isinstance(event, ScalarEvent):
        yield from filter(None, (hidden_character(event.value),))
        if event.style in (None, ""):
            yield from _plain_reasons(event.value)


def _plain_reasons(value: str) -> Iterator[str]:
    if value == "<<":
        yield "tags and anchors have no use in a spec; remove it"
    if len(value) > _LONGEST_NUMBER and _NUMBER.fullmatch(value):
        yield "is a number with too many digits; write a shorter one, or put text in quotes"
    if _LEADING_ZERO.fullmatch(value):
        yield f"{value} is octal to some programs; write the number without the leading zero"

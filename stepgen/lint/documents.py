"""
Rules of keywords.txt and library.json, which the checker of the library manager passes over.
"""

import json
import re
from collections import Counter
from collections.abc import Iterable
from typing import Any

from stepgen.lint.library import Library
from stepgen.lint.rules import Places, RuleBook

DOCUMENTS = RuleBook()
KEYWORDS = "keywords.txt"
MANIFEST = "library.json"
_TYPES = {"KEYWORD1", "KEYWORD2", "KEYWORD3", "LITERAL1", "LITERAL2"}
_MANIFEST_FIELDS = ("name", "version", "description")


def _keyword_lines(library: Library) -> Iterable[tuple[str, str]]:
    for number, line in enumerate(library.folder.lines(KEYWORDS) or (), start=1):
        if line.strip() and not line.startswith("#"):
            yield f"{KEYWORDS}:{number}", line


@DOCUMENTS.rule("LK001", "keywords.txt is there", "list the names of the library's functions")
def _keywords(library: Library) -> Places:
    if library.folder.lines(KEYWORDS) is None:
        yield KEYWORDS, "there is no such file, or it cannot be read"


@DOCUMENTS.rule("LK002", "true tabs in keywords.txt", "write NAME, one tab, KEYWORD2")
def _tabs(library: Library) -> Places:
    for place, line in _keyword_lines(library):
        if "\t" not in line:
            yield place, "no tab divides the name from its type, so the IDE shows no colour"
        elif "\t\t" in line.rstrip("\t"):
            yield place, "the name and its type are divided by more than one tab"
        elif " " in line.rstrip():
            yield place, "there is a blank beside the tab"


@DOCUMENTS.rule("LK003", "types of keywords", f"write one of {', '.join(sorted(_TYPES))}")
def _types(library: Library) -> Places:
    for place, line in _keyword_lines(library):
        parts = line.split("\t")
        if len(parts) > 1 and parts[1].strip() not in _TYPES:
            yield place, f'"{parts[1]}" is no type of a keyword'


@DOCUMENTS.rule("LK004", "keywords are names", "write the name alone, without brackets")
def _identifiers(library: Library) -> Places:
    for place, line in _keyword_lines(library):
        name = line.split("\t")[0].strip()
        if not re.fullmatch(r"[A-Za-z_]\w*", name):
            yield place, f'"{name}" is no name of C++'


@DOCUMENTS.rule("LK005", "each keyword once", "remove one of them")
def _repeated(library: Library) -> Places:
    seen: Counter[str] = Counter()
    for place, line in _keyword_lines(library):
        name = line.split("\t")[0].strip()
        seen[name] += 1
        if seen[name] > 1:
            yield place, f"{name} is there before"


def _manifest(library: Library) -> dict[str, Any] | None:
    lines = library.folder.lines(MANIFEST)
    if lines is None:
        return None
    try:
        data = json.loads("\n".join(lines))
    except (ValueError, RecursionError):
        return None
    return data if isinstance(data, dict) else None


@DOCUMENTS.rule("LJ001", "library.json is JSON", "write an object with name and version")
def _json(library: Library) -> Places:
    if any(str(file) == MANIFEST for file in library.folder.files) and _manifest(library) is None:
        yield MANIFEST, "this is no JSON object"


@DOCUMENTS.rule("LJ002", "library.json has its fields", "add the field")
def _manifest_fields(library: Library) -> Places:
    data = _manifest(library)
    for field in _MANIFEST_FIELDS if data is not None else ():
        if not isinstance((data or {}).get(field), str) or not (data or {})[field]:
            yield MANIFEST, f'the field "{field}" is missing or no text'


@DOCUMENTS.rule("LJ003", "both manifests say the same", "write the same in both files")
def _agreement(library: Library) -> Places:
    data = _manifest(library) or {}
    for field in ("name", "version"):
        other = library.fields.get(field)
        if other is not None and field in data and data[field] != other:
            yield MANIFEST, f'"{field}" is {data[field]!r} here and {other!r} in library.properties'

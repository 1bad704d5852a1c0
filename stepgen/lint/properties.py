"""
Rules of library.properties (Arduino library specification, "library.properties file format").
"""

import re
from collections.abc import Iterable
from pathlib import PurePosixPath
from typing import get_args
from urllib.parse import urlsplit

from stepgen.lint.library import LONGEST_NAME, PROPERTIES, Library
from stepgen.lint.rules import Places, RuleBook
from stepgen.spec.model import Category

METADATA = RuleBook()
CATEGORIES = get_args(Category)
_RECOMMENDED_NAME = 32
_OPTIONAL = ("depends", "dot_a_linkage", "includes", "precompiled", "ldflags", "architectures")
_FIELDS = (
    *("name", "version", "author", "maintainer", "email", "sentence", "paragraph", "category"),
    *("url", "license", "core_dependencies", *_OPTIONAL),
)
_NAME = re.compile(r"(?=.*[A-Za-z])[A-Za-z0-9][A-Za-z0-9 _.-]*")
_NUMBER = r"(0|[1-9]\d*)"
_LABEL = r"[0-9A-Za-z-]+(\.[0-9A-Za-z-]+)*"
_SEMVER = re.compile(rf"{_NUMBER}\.{_NUMBER}\.{_NUMBER}(-{_LABEL})?(\+{_LABEL})?")
_RELAXED = re.compile(rf"{_NUMBER}(\.{_NUMBER}){{0,2}}(-{_LABEL})?(\+{_LABEL})?")
_ALIASES = {"atmelavr": "avr", "atmelsam": "sam", "espressif8266": "esp8266", "ststm32": "stm32"}
_ARCHITECTURES = ("avr", "megaavr", "sam", "samd", "mbed", "esp8266", "esp32", "stm32", "renesas")
_CONSTRAINT = re.compile(r"!?\(*\s*(<|<=|=|>=|>|\^|~)\s*\d+(\.\d+){0,2}[^<>=^~]*\)*")


@METADATA.rule("LP005", "lines are fields", "write key=value, or # before a comment")
def _format(library: Library) -> Places:
    for number, text in library.broken:
        yield f"{PROPERTIES}:{number}", f'"{text[:40]}" is no field'


@METADATA.rule("LP006", "fields are spelt right", "correct the field's name")
def _misspelt(library: Library) -> Places:
    for field in library.fields:
        if field in _FIELDS:
            continue
        plain = re.sub(r"[^a-z]", "", field.lower()).rstrip("s")
        alike = [name for name in _FIELDS if re.sub(r"[^a-z]", "", name).rstrip("s") == plain]
        if alike:
            yield library.place(field), f"{field} looks like {alike[0]}"


def _require(rule: str, field: str) -> None:
    @METADATA.rule(rule, f"{field} is there", f"add {field}=...")
    def _missing(library: Library) -> Places:
        if library.has_properties and field not in library.fields:
            yield PROPERTIES, f"the field {field} is missing"


def _fill(rule: str, field: str, fix: str) -> None:
    @METADATA.rule(rule, f"{field} is not empty", fix)
    def _empty(library: Library) -> Places:
        if library.fields.get(field) == "":
            yield library.place(field), f"the field {field} is empty"


def _forbid(rule: str, field: str, pattern: str, reason: str, fix: str) -> None:
    @METADATA.rule(rule, reason, fix)
    def _forbidden(library: Library) -> Places:
        if re.match(pattern, library.fields.get(field, ""), re.IGNORECASE):
            yield library.place(field), f'{field} "{library.fields[field]}" {reason}'


_require("LP007", "name")
_fill("LP008", "name", "write the library's name")


@METADATA.rule("LP009", "length of the name", "shorten it to 63 characters or fewer")
def _name_length(library: Library) -> Places:
    if len(library.fields.get("name", "")) > LONGEST_NAME:
        yield library.place("name"), f"the name has {len(library.fields['name'])} characters"


@METADATA.rule("LP010", "recommended length of the name", "shorten it to 32 characters or fewer")
def _name_recommended(library: Library) -> Places:
    length = len(library.fields.get("name", ""))
    if _RECOMMENDED_NAME < length <= LONGEST_NAME:
        yield library.place("name"), f"the name has {length} characters"


@METADATA.rule(
    "LP011", "characters of the name", "use letters, digits, spaces, dots, dashes and underscores"
)
def _name_characters(library: Library) -> Places:
    name = library.fields.get("name", "")
    if name and not _NAME.fullmatch(name):
        yield library.place("name"), f'the name "{name}" has a character that it must not'


_forbid("LP012", "name", "arduino", "begins with Arduino", "names that do are Arduino's own")
_forbid("LP014", "name", ".+arduino", "contains Arduino", "leave that word out")
_forbid("LP015", "name", ".* ", "contains a space", "use a dash or an underscore")
_forbid("LP016", "name", ".*library", "contains library", "leave that word out")
_require("LP019", "version")


@METADATA.rule("LP020", "version is a version", "write three numbers, such as 1.0.0")
def _version(library: Library) -> Places:
    version = library.fields.get("version")
    if version is not None and not _RELAXED.fullmatch(version):
        yield library.place("version"), f'"{version}" is no version'


@METADATA.rule("LP021", "version has three numbers", "write three numbers, such as 1.0.0")
def _semver(library: Library) -> Places:
    version = library.fields.get("version", "")
    if _RELAXED.fullmatch(version) and not _SEMVER.fullmatch(version):
        yield library.place("version"), f'"{version}" has fewer than three numbers'


_require("LP023", "author")
_fill("LP024", "author", "write who made the library")
_require("LP025", "maintainer")
_fill("LP026", "maintainer", "write who looks after the library")
_forbid("LP027", "maintainer", "arduino", "begins with Arduino", "write who looks after it")
_forbid("LP057", "maintainer", ".+arduino", "contains Arduino", "write who looks after it")


@METADATA.rule("LP028", "maintainer, not email", "rename the field to maintainer")
def _email(library: Library) -> Places:
    if "email" in library.fields and "maintainer" not in library.fields:
        yield library.place("email"), "email is the old name of maintainer"


_fill("LP029", "email", "remove it")
_require("LP031", "sentence")
_fill("LP032", "sentence", "say in a sentence what the library does")
_require("LP034", "paragraph")


@METADATA.rule("LP036", "paragraph goes on after sentence", "leave the repetition out")
def _repeats(library: Library) -> Places:
    sentence = library.fields.get("sentence", "")
    if sentence and library.fields.get("paragraph", "").startswith(sentence):
        yield library.place("paragraph"), "paragraph repeats sentence, and is shown behind it"


_require("LP037", "category")


@METADATA.rule("LP038", "category is one of the list", f"write one of {', '.join(CATEGORIES)}")
def _category(library: Library) -> Places:
    category = library.fields.get("category")
    if category is not None and category not in (*CATEGORIES, "Uncategorized"):
        yield library.place("category"), f'"{category}" is no category'


_forbid("LP039", "category", "Uncategorized$", "says nothing", "write a category of the list")
_require("LP040", "url")
_fill("LP056", "url", "write the address of a page about the library")


@METADATA.rule("LP041", "url is an address", "write one such as https://example.org/motor")
def _url(library: Library) -> Places:
    url = library.fields.get("url", "")
    if not url:
        return
    try:
        parts = urlsplit(url)
        fine = bool(parts.scheme in {"http", "https"} and parts.hostname and " " not in url)
    except ValueError:
        fine = False
    if not fine:
        yield library.place("url"), f'"{url}" is no address of a page'


_require("LP043", "architectures")
_fill("LP044", "architectures", "write avr, or * for all")


@METADATA.rule("LP045", "architectures are Arduino's", "write Arduino's name of it too")
def _alias(library: Library) -> Places:
    items = library.items("architectures")
    for item in items:
        true = _ALIASES.get(item.lower())
        if true and true not in items:
            yield library.place("architectures"), f"{item} is another framework's name of {true}"


@METADATA.rule("LP046", "architectures in small letters", "write it in small letters")
def _architecture_case(library: Library) -> Places:
    for item in library.items("architectures"):
        if item.lower() in _ARCHITECTURES and item != item.lower():
            yield library.place("architectures"), f"{item} is not found as {item.lower()}"


@METADATA.rule("LP047", "depends is a list of names", "write names with commas between them")
def _depends(library: Library) -> Places:
    for item in library.items("depends"):
        name = item.partition("(")[0].strip()
        if not _NAME.fullmatch(name):
            yield library.place("depends"), f'"{name}" is no name of a library'


@METADATA.rule("LP058", "constraints of depends", "write such as Servo (>=1.1.0)")
def _constraints(library: Library) -> Places:
    for item in library.items("depends"):
        _, bracket, constraint = item.partition("(")
        parts = re.split(r"&&|\|\|", constraint[:-1])
        is_closed = constraint.endswith(")")
        fine = is_closed and all(_CONSTRAINT.fullmatch(part.strip()) for part in parts)
        if bracket and not fine:
            yield library.place("depends"), f'"({constraint}" is no constraint of a version'


@METADATA.rule("LP049", "dot_a_linkage is true", "write true, or remove the field")
def _dot_a(library: Library) -> Places:
    if library.fields.get("dot_a_linkage", "true") != "true":
        yield library.place("dot_a_linkage"), "dot_a_linkage has another value than true"


@METADATA.rule("LP050", "dot_a_linkage needs src", "move the sources to src")
def _dot_a_layout(library: Library) -> Places:
    if "dot_a_linkage" in library.fields and library.folder.sources != "src":
        yield library.place("dot_a_linkage"), "it works for libraries with a folder src only"


_fill("LP051", "includes", "write the headers that a sketch needs, or remove the field")


@METADATA.rule("LP052", "includes are there", "write headers that lie right in src")
def _includes(library: Library) -> Places:
    every = {str(file.relative_to(library.folder.sources)) for file in _below_sources(library)}
    for item in library.items("includes"):
        if item not in every:
            yield library.place("includes"), f"{item} is not in the folder of the sources"


def _below_sources(library: Library) -> Iterable[PurePosixPath]:
    return (file for file in library.folder.files if file.is_relative_to(library.folder.sources))


@METADATA.rule("LP053", "precompiled is true or full", "write true or full, or remove the field")
def _precompiled(library: Library) -> Places:
    if library.fields.get("precompiled", "true") not in {"true", "full", "false"}:
        yield library.place("precompiled"), "precompiled has another value"


@METADATA.rule("LP054", "precompiled needs src", "move the sources to src")
def _precompiled_layout(library: Library) -> Places:
    if library.fields.get("precompiled") in {"true", "full"} and library.folder.sources != "src":
        yield library.place("precompiled"), "it works for libraries with a folder src only"


_fill("LP055", "ldflags", "write the flags, or remove the field")

"""
Rules of a library's folders and files (Arduino library specification, "Layout of folders").
"""

import re

from stepgen.lint.folder import HEADER_SUFFIXES, SKETCH_SUFFIXES
from stepgen.lint.library import LONGEST_NAME, PROPERTIES, Library
from stepgen.lint.rules import Places, RuleBook

STRUCTURE = RuleBook()
_SOURCES = HEADER_SUFFIXES | SKETCH_SUFFIXES | {".c", ".cpp"}
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]*")
_LICENSES = re.compile(r"(?i)(licen[cs]e|copying)(\.(md|txt|rst))?")
_READMES = re.compile(r"(?i)readme(\.(md|markdown|mdown|txt|rst|adoc))?")


@STRUCTURE.rule("LS001", "a library has a header", "put NAME.h into the folder src")
def _header(library: Library) -> Places:
    if not library.folder.headers:
        yield library.folder.sources, "there is no header file"


@STRUCTURE.rule("LS002", "length of the folder's name", "shorten it to 63 characters or fewer")
def _folder_length(library: Library) -> Places:
    if len(library.folder.name) > LONGEST_NAME:
        yield ".", f"the folder's name has {len(library.folder.name)} characters"


@STRUCTURE.rule(
    "LS003",
    "characters of the folder's name",
    "use letters, digits, dots, dashes and underscores, a letter or digit first",
)
def _folder_characters(library: Library) -> Places:
    if not _NAME.fullmatch(library.folder.name):
        yield ".", f'the folder\'s name "{library.folder.name}" has a character that it must not'


@STRUCTURE.rule("LS004", "no Git submodule", "copy its files into the library")
def _submodule(library: Library) -> Places:
    if any(file.name == ".gitmodules" for file in library.folder.top_files()):
        yield ".gitmodules", "there is a Git submodule, which an installation leaves out"


@STRUCTURE.rule("LS005", "no symbolic links", "replace it with the file it points to")
def _links(library: Library) -> Places:
    for link in library.folder.links:
        yield str(link), "this is a symbolic link"


@STRUCTURE.rule("LS006", "no .development file", "remove it before you publish")
def _development(library: Library) -> Places:
    if any(file.name == ".development" for file in library.folder.top_files()):
        yield ".development", "this file keeps the library manager from accepting the library"


@STRUCTURE.rule("LS007", "no .exe file", "remove it")
def _executable(library: Library) -> Places:
    for file in library.folder.files:
        if file.suffix == ".exe":
            yield str(file), "this is a program for Windows"


@STRUCTURE.rule("LS008", "a header named like the library", "name a header like the library")
def _header_name(library: Library) -> Places:
    names = {header.stem for header in library.folder.headers}
    if "name" in library.fields and names and library.installed_name not in names:
        yield library.folder.sources, f"there is no {library.installed_name}.h"


@STRUCTURE.rule("LS009", "the folder of the sources is src", "rename it to src")
def _src_case(library: Library) -> Places:
    yield from _other_case(library, "src")


@STRUCTURE.rule("LS010", "no folder utility beside src", "move its files below src")
def _utility(library: Library) -> Places:
    names = {folder.name for folder in library.folder.top_folders()}
    if {"src", "utility"} <= names:
        yield "utility", "nobody compiles this folder in a library with src"


@STRUCTURE.rule("LS011", "the folder for extras is extras", "rename it to extras")
def _extras(library: Library) -> Places:
    for folder in library.folder.top_folders():
        if folder.name.lower() == "extra":
            yield str(folder), "this looks like extras"


@STRUCTURE.rule("LS012", "extras is in small letters", "rename it to extras")
def _extras_case(library: Library) -> Places:
    yield from _other_case(library, "extras")


@STRUCTURE.rule("LP001", "there is a library.properties", "add the file, in UTF-8")
def _properties(library: Library) -> Places:
    if not library.has_properties:
        yield PROPERTIES, "there is no such file, or it cannot be read"


@STRUCTURE.rule("LP002", "library.properties is spelt so", "rename it to library.properties")
def _properties_name(library: Library) -> Places:
    alike = re.compile(r"(?i)librar(y|ies|ie)s?[._-]?propert(y|ies|ie)s?")
    for file in library.folder.top_files():
        if alike.fullmatch(file.name) and file.name.lower() != PROPERTIES:
            yield str(file), "this looks like library.properties"


@STRUCTURE.rule("LP003", "library.properties is in small letters", "rename it")
def _properties_case(library: Library) -> Places:
    for file in library.folder.top_files():
        if file.name.lower() == PROPERTIES != file.name:
            yield str(file), "this is library.properties in other letters"


@STRUCTURE.rule("LP004", "one library.properties", "remove it")
def _one_properties(library: Library) -> Places:
    for file in library.folder.files:
        if file.name == PROPERTIES and len(file.parts) > 1:
            yield str(file), "only the one right in the library's folder counts"


@STRUCTURE.rule("LC001", "Arduino.h with a capital A", "write #include <Arduino.h>")
def _arduino_h(library: Library) -> Places:
    include = re.compile(r'\s*#\s*include\s*[<"](arduino\.h)[>"]', re.IGNORECASE)
    for file in library.folder.files:
        if file.suffix not in _SOURCES:
            continue
        for number, line in enumerate(library.folder.lines(file) or (), start=1):
            match = include.match(line)
            if match and match[1] != "Arduino.h":
                yield f"{file}:{number}", f"{match[1]} is found on Windows and macOS only"


@STRUCTURE.rule("LD001", "a README", "write a README.md")
def _readme(library: Library) -> Places:
    if not any(_READMES.fullmatch(file.name) for file in library.folder.top_files()):
        yield ".", "there is no README"


@STRUCTURE.rule("LD002", "a LICENSE", "add a LICENSE file")
def _license(library: Library) -> Places:
    if not any(_LICENSES.fullmatch(file.name) for file in library.folder.top_files()):
        yield ".", "there is no LICENSE"


@STRUCTURE.rule("LD003", "sketches are examples", "move it to examples/NAME/NAME.ino")
def _stray_sketch(library: Library) -> Places:
    for sketch in library.folder.sketches:
        if sketch.parts[0] not in {"examples", "extras"}:
            yield str(sketch), "this sketch is in none of the folders examples and extras"


@STRUCTURE.rule("LD004", "an example", "add examples/NAME/NAME.ino")
def _examples(library: Library) -> Places:
    if not any(sketch.parts[0] == "examples" for sketch in library.folder.sketches):
        yield "examples", "there is no example"


@STRUCTURE.rule("LD005", "the folder of the examples is examples", "rename it to examples")
def _examples_name(library: Library) -> Places:
    for folder in library.folder.top_folders():
        if re.fullmatch(r"(?i)examples?|demos?", folder.name) and (
            folder.name.lower() != "examples"
        ):
            yield str(folder), "this looks like examples"


@STRUCTURE.rule("LD006", "examples is in small letters", "rename it to examples")
def _examples_case(library: Library) -> Places:
    yield from _other_case(library, "examples")


@STRUCTURE.rule("SS001", "a sketch is named like its folder", "give both the same name")
def _sketch_name(library: Library) -> Places:
    sketches = library.folder.sketches
    for folder in sorted({sketch.parent for sketch in sketches if len(sketch.parts) > 1}):
        names = {sketch.stem for sketch in sketches if sketch.parent == folder}
        if folder.name not in names:
            yield str(folder), f"there is no {folder.name}.ino in this folder"


@STRUCTURE.rule("SS003", "sketches end in .ino", "rename it")
def _pde(library: Library) -> Places:
    for sketch in library.folder.sketches:
        if sketch.suffix == ".pde":
            yield str(sketch), "the ending .pde is of the IDE before 1.0"


@STRUCTURE.rule(
    "SS004",
    "characters of a sketch's name",
    "use letters, digits, dots, dashes and underscores, a letter or digit first",
)
def _sketch_characters(library: Library) -> Places:
    for sketch in library.folder.sketches:
        if not _NAME.fullmatch(sketch.name) or len(sketch.stem) > LONGEST_NAME:
            yield str(sketch), "the IDE refuses this name, or it is longer than 63 characters"


def _other_case(library: Library, name: str) -> Places:
    for folder in library.folder.top_folders():
        if folder.name.lower() == name != folder.name:
            yield str(folder), f"this is {name} in other letters"

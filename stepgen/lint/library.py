"""
A library folder with its metadata read: what every rule gets.
"""

import re
from dataclasses import dataclass

from stepgen.lint.folder import Folder

PROPERTIES = "library.properties"
LONGEST_NAME = 63
"""Characters that the name of a library, a folder or a sketch may have."""


@dataclass(frozen=True)
class Library:
    """
    A folder and the fields of its library.properties.

    Args:
        folder: What is in it.
        has_properties: Whether there is a library.properties that can be read.
        fields: The fields by name; of a field that is there twice the last one counts.
        places: Where each field stands, ``library.properties:line``.
        broken: Lines that are neither field, comment nor empty: number and text.
    """

    folder: Folder
    has_properties: bool
    fields: dict[str, str]
    places: dict[str, str]
    broken: tuple[tuple[int, str], ...]

    def place(self, field: str) -> str:
        """
        Return where *field* stands, or should stand.
        """
        return self.places.get(field, PROPERTIES)

    def items(self, field: str) -> tuple[str, ...]:
        """
        Return the comma-separated entries of *field*.
        """
        return tuple(item.strip() for item in self.fields.get(field, "").split(",") if item.strip())

    @property
    def installed_name(self) -> str:
        """
        Return the folder's name after an installation: the library's, spaces as underscores.
        """
        return re.sub(r"[^A-Za-z0-9._-]", "_", self.fields.get("name", ""))


def read_library(folder: Folder) -> Library:
    """
    Return *folder* with the fields of its library.properties: ``key=value``, ``#`` a comment.
    """
    lines = folder.lines(PROPERTIES)
    fields: dict[str, str] = {}
    places: dict[str, str] = {}
    broken: list[tuple[int, str]] = []
    for number, line in enumerate(lines or (), start=1):
        text = line.strip()
        if not text or text.startswith("#"):
            continue
        key, equals, value = text.partition("=")
        if not equals or not key.strip():
            broken.append((number, text))
            continue
        fields[key.strip()] = value.strip()
        places[key.strip()] = f"{PROPERTIES}:{number}"
    return Library(folder, lines is not None, fields, places, tuple(broken))

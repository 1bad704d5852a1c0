"""
A library as a zip, as the Arduino IDE's "Add .ZIP Library" takes it.
"""

import io
import os
from collections.abc import Mapping
from pathlib import Path
from zipfile import ZIP_STORED, BadZipFile, ZipFile, ZipInfo

from stepgen.errors import Fault, StepgenError
from stepgen.library.marker import LARGEST_MARKER_BYTES, MARKER, parse_marker, with_marker
from stepgen.library.swap import locked, os_errors, recover, replace_file, spare_nothing

_NO_DATE = (1980, 1, 1, 0, 0, 0)  # the earliest that the format knows
_UNIX = 3  # the system that the attributes are of
_PLAIN_FILE = 0o100644 << 16


def zip_library(files: Mapping[str, str], name: str, target: Path) -> bool:
    """
    Make *target* the zip of the library *name*; return whether it had to be written.

    The same files give the same bytes on every machine: sorted, without dates, and stored as
    they are, because compressors differ. It is swapped in as a whole, like a folder.

    Raises:
        StepgenError: *target* is refused (see `zip_refusals`) or cannot be written.
    """
    content = _zip(files, name)
    with os_errors(target):
        _refuse(name, target)
        target.parent.mkdir(parents=True, exist_ok=True)
        with locked(target.parent) as alone:
            if alone:
                recover(target, spare_nothing)
            _refuse(name, target)
            if target.is_file() and target.read_bytes() == content:
                return False
            replace_file(content, target)
            return True


def check_zip(files: Mapping[str, str], name: str, target: Path) -> list[str]:
    """
    Return what is wrong with the zip *target*, a line each; nothing when it is fresh.

    Raises:
        StepgenError: *target* cannot be read.
    """
    with os_errors(target):
        if not os.path.lexists(target):
            return [f"{target.name}: missing"]
        return [] if target.read_bytes() == _zip(files, name) else [f"{target.name}: stale"]


def zip_refusals(name: str, target: Path) -> list[Fault]:
    """
    Return why `zip_library` would refuse *target*: it is there, and no zip of this library.

    Raises:
        StepgenError: *target* cannot be read.
    """
    with os_errors(target):
        return _refusals(name, target)


def _refuse(name: str, target: Path) -> None:
    faults = _refusals(name, target)
    if faults:
        raise StepgenError(faults)


def _refusals(name: str, target: Path) -> list[Fault]:
    if not os.path.lexists(target) or (not target.is_symlink() and _is_ours(name, target)):
        return []
    reason = (
        f"is there already and is no zip of {name} from stepgen; move it or name another folder"
    )
    return [Fault(str(target), "", reason)]


def _is_ours(name: str, target: Path) -> bool:
    if not target.is_file():
        return False
    try:
        with ZipFile(target) as archive, archive.open(f"{name}/{MARKER}") as marker:
            return parse_marker(marker.read(LARGEST_MARKER_BYTES)) is not None
    except (BadZipFile, KeyError, NotImplementedError, RuntimeError, EOFError):
        return False


def _zip(files: Mapping[str, str], name: str) -> bytes:
    made = io.BytesIO()
    with ZipFile(made, "w", ZIP_STORED) as archive:
        for path, content in with_marker(files).items():
            entry = ZipInfo(f"{name}/{path}", _NO_DATE)
            entry.create_system = _UNIX
            entry.external_attr = _PLAIN_FILE
            archive.writestr(entry, content)
    return made.getvalue()

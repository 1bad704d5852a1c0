"""
Writing a library: safe for what is there already, and whole at any moment.

A folder is replaced only when every file in it is one that stepgen wrote and nobody has edited
since; its marker (`stepgen.library.marker`) tells. What else users keep there is never lost.
"""

import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from stepgen.errors import Fault, StepgenError
from stepgen.library.archive import check_zip, zip_library, zip_refusals
from stepgen.library.marker import MARKER, digest, read_marker, with_marker
from stepgen.library.swap import locked, os_errors, recover, replace_folder

_SHOWN = 3  # foreign files that a message names
_CLUTTER = frozenset({".DS_Store", "Thumbs.db", "desktop.ini"})  # file managers leave it


@dataclass(frozen=True)
class WriteResult:
    """
    What a run did: paths inside *target*, sorted; a zip's result has the zip itself as target.

    Args:
        target: The library's folder, or the zip.
        written: New files.
        changed: Files with other content than before.
        removed: Files that the library no longer has.
        unchanged: Files that were right already.
    """

    target: Path
    written: tuple[str, ...] = ()
    changed: tuple[str, ...] = ()
    removed: tuple[str, ...] = ()
    unchanged: tuple[str, ...] = ()

    @property
    def is_fresh(self) -> bool:
        """
        Return whether nothing had to be done.
        """
        return not (self.written or self.changed or self.removed)


def write_library(files: Mapping[str, str], target: Path, *, force: bool = False) -> WriteResult:
    """
    Make *target* the library's folder with exactly *files* and the marker.

    The new library is written beside *target* and changes places with it in one instant; a
    kill leaves the old one or the new one, whole. Two runs at once take turns. When *target*
    is right already, nothing is touched.

    Args:
        files: Path inside the library -> text, without the marker.
        target: The library's own folder; missing folders above it are made.
        force: Also overwrite files of stepgen's that somebody has edited. Files that stepgen
            did not write are never removed, not even so.

    Raises:
        StepgenError: *target* is refused (see `refusals`) or cannot be written.
    """
    contents = with_marker(files)

    def judge(old: Path) -> None:
        reason = _not_replaceable(contents, old, force=force)
        if reason:
            raise StepgenError.of(reason, place=str(target))

    with os_errors(target):
        _refuse_place(target)
        target.parent.mkdir(parents=True, exist_ok=True)
        with locked(target.parent) as alone:
            if alone:
                recover(target, _holds_foreign)
            _refuse(contents, target, force=force)
            result = _compare(contents, target)
            if not result.is_fresh:
                replace_folder(contents, target, judge, _holds_foreign)
            return result


def check_library(files: Mapping[str, str], target: Path) -> list[str]:
    """
    Return what `write_library` would do to *target*, a line each; nothing when it is fresh.

    Such as ``src/Pan.h: stale``, ``README.md: missing`` and ``notes.txt: extra``.

    Raises:
        StepgenError: *target* cannot be read.
    """
    with os_errors(target), _undisturbed(target):
        result = _compare(with_marker(files), target)
    kinds = {"missing": result.written, "stale": result.changed, "extra": result.removed}
    return sorted(f"{path}: {kind}" for kind, paths in kinds.items() for path in paths)


def refusals(files: Mapping[str, str], target: Path, *, force: bool = False) -> list[Fault]:
    """
    Return why `write_library` would refuse *target*; it reads only.

    Refused are a symbolic link, a file, a folder that is not empty and has no marker, a folder
    with files that stepgen did not write, and, without *force*, one with edited files.

    Raises:
        StepgenError: *target* cannot be read.
    """
    with os_errors(target), _undisturbed(target):
        return _refusals(with_marker(files), target, force=force)


@contextmanager
def _undisturbed(target: Path) -> Iterator[None]:
    """
    Keep other runs from replacing *target* while it is read.
    """
    if not target.parent.is_dir():
        yield
        return
    with locked(target.parent):
        yield


def _refuse_place(target: Path) -> None:
    """
    Refuse a place where no folder can be made; what is in *target*, only a lock lets us judge.
    """
    reason = _no_place(target)
    if reason:
        raise StepgenError.of(reason, place=str(target))


def _refuse(contents: Mapping[str, bytes], target: Path, *, force: bool) -> None:
    faults = _refusals(contents, target, force=force)
    if faults:
        raise StepgenError(faults)


def _refusals(contents: Mapping[str, bytes], target: Path, *, force: bool) -> list[Fault]:
    reason = _no_place(target) or _not_replaceable(contents, target, force=force)
    return [Fault(str(target), "", reason)] if reason else []


def _not_replaceable(contents: Mapping[str, bytes], target: Path, *, force: bool) -> str:
    reason = _wrong_kind(target) or _foreign(target)
    return reason if reason or force else _edited(contents, target)


def _wrong_kind(target: Path) -> str:
    if target.is_symlink():
        return (
            "is a symbolic link, and stepgen replaces the library's folder as a whole; "
            "remove the link or name another folder"
        )
    if os.path.lexists(target) and not target.is_dir():
        return "is no folder, so no library can be written there; move it or name another folder"
    return ""


def _no_place(target: Path) -> str:
    above = next((folder for folder in target.parents if os.path.lexists(folder)), target)
    if above != target and not above.is_dir():
        return f"cannot be made, because {above} is no folder; name another folder"
    return ""


def _foreign(target: Path) -> str:
    ours = read_marker(target)
    known = {*(ours or ()), MARKER} if ours is not None else set()
    foreign = [path for path in _paths(target) if path not in known or not _is_plain(target / path)]
    if not foreign:
        return ""
    return (
        f"holds files that stepgen did not write ({_listed(foreign)}) and would lose them; "
        "move them elsewhere or name another folder"
    )


def _holds_foreign(folder: Path) -> bool:
    """
    Tell whether *folder* is a library of stepgen's with other files in it.

    What a run was still writing has no marker yet, or no file that is not in it.
    """
    return read_marker(folder) is not None and bool(_foreign(folder))


def _edited(contents: Mapping[str, bytes], target: Path) -> str:
    """
    Return why edited files forbid writing; an edit that gives the very text to write does not.
    """
    ours = read_marker(target) or {}
    edited = []
    for path in _paths(target):
        if path in ours:
            found = (target / path).read_bytes()
            if digest(found) != ours[path] and found != contents.get(path):
                edited.append(path)
    if not edited:
        return ""
    return (
        f"holds files that were edited since stepgen wrote them ({_listed(edited)}); "
        "move your changes into the spec or the sketch, or overwrite them with --force"
    )


def _listed(paths: list[str]) -> str:
    more = len(paths) - _SHOWN
    return ", ".join(paths[:_SHOWN]) + (f" and {more} more" if more > 0 else "")


def _is_plain(path: Path) -> bool:
    return path.is_file() and not path.is_symlink()


def _paths(target: Path) -> list[str]:
    """
    Return the path of each file and link below *target*, sorted; none where it is no folder.
    """

    def fail(error: OSError) -> None:
        raise error

    if not target.is_dir():
        return []
    found = []
    for folder, folders, files in os.walk(target, onerror=fail):
        links = [name for name in folders if Path(folder, name).is_symlink()]
        found += [Path(folder, name) for name in (*files, *links) if name not in _CLUTTER]
    return sorted(path.relative_to(target).as_posix() for path in found)


def _compare(contents: Mapping[str, bytes], target: Path) -> WriteResult:
    there = set(_paths(target))
    same = {
        path
        for path in there & contents.keys()
        if _is_plain(target / path) and (target / path).read_bytes() == contents[path]
    }
    return WriteResult(
        target,
        written=tuple(sorted(contents.keys() - there)),
        changed=tuple(sorted(contents.keys() & there - same)),
        removed=tuple(sorted(there - contents.keys())),
        unchanged=tuple(sorted(same)),
    )


__all__ = [
    "WriteResult",
    "check_library",
    "check_zip",
    "refusals",
    "write_library",
    "zip_library",
    "zip_refusals",
]

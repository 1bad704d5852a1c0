"""
A library folder as the rules look at it: read once, by no means changed.
"""

import os
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from stepgen.errors import StepgenError

HEADER_SUFFIXES = {".h", ".hh", ".hpp"}
SKETCH_SUFFIXES = {".ino", ".pde"}
_MOST_BYTES = 1024 * 1024


@dataclass(frozen=True)
class Folder:
    """
    What is in a folder; paths are relative to it, with ``/``.

    Args:
        path: Where it is.
        files: Its files, at any depth, in order; a link counts as one.
        folders: Its folders likewise.
        links: Those of both that are symbolic links; what they point to is not looked at.
    """

    path: Path
    files: tuple[PurePosixPath, ...]
    folders: tuple[PurePosixPath, ...]
    links: tuple[PurePosixPath, ...]

    @property
    def name(self) -> str:
        """
        Return the folder's own name.
        """
        return self.path.name

    @property
    def sources(self) -> str:
        """
        Return the folder of the sources: ``src``, or ``.`` in the layout before IDE 1.5.
        """
        return "src" if PurePosixPath("src") in self.folders else "."

    @property
    def headers(self) -> tuple[PurePosixPath, ...]:
        """
        Return the header files right in the folder of the sources.
        """
        return tuple(
            file
            for file in self.files
            if file.suffix in HEADER_SUFFIXES and str(file.parent) == self.sources
        )

    @property
    def sketches(self) -> tuple[PurePosixPath, ...]:
        """
        Return the files of sketches, wherever they are.
        """
        return tuple(file for file in self.files if file.suffix in SKETCH_SUFFIXES)

    def top_files(self) -> Iterable[PurePosixPath]:
        """
        Return the files right in the folder.
        """
        return (file for file in self.files if len(file.parts) == 1)

    def top_folders(self) -> Iterable[PurePosixPath]:
        """
        Return the folders right in the folder.
        """
        return (folder for folder in self.folders if len(folder.parts) == 1)

    def lines(self, file: str | PurePosixPath) -> tuple[str, ...] | None:
        """
        Return the lines of *file*, None if it is no such UTF-8 file of at most 1 MiB.
        """
        wanted = PurePosixPath(file)
        if wanted not in self.files or wanted in self.links:
            return None
        path = self.path / wanted
        if not path.is_file() or path.stat().st_size > _MOST_BYTES:
            return None
        try:
            return tuple(path.read_bytes().decode("utf-8").splitlines())
        except UnicodeDecodeError:
            return None


def read_folder(path: Path) -> Folder:
    """
    Return what is in the folder *path*.

    Raises:
        StepgenError: It is no folder, or cannot be read.
    """
    if not path.is_dir():
        raise StepgenError.of("is no folder; name the folder of a library", place=str(path))
    files: list[PurePosixPath] = []
    folders: list[PurePosixPath] = []
    root = path.resolve()
    for place, below, names in os.walk(root, onerror=_refuse):
        here = PurePosixPath(Path(place).relative_to(root))
        folders.extend(here / name for name in below)
        files.extend(here / name for name in names)
    every = sorted((*files, *folders))
    links = tuple(entry for entry in every if (root / entry).is_symlink())
    return Folder(root, tuple(sorted(files)), tuple(sorted(folders)), links)


def _refuse(error: OSError) -> None:
    raise StepgenError.of(f"cannot be read ({error.strerror})", place=str(error.filename))

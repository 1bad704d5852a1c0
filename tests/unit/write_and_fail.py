"""
A writer whose disk fails: ``write_and_fail.py FOLDER ERROR [--no-exchange]``.

Writes a library over another again and again. In run N the Nth call to the file system (opening,
making, renaming, removing) fails with ERROR, such as ENOSPC, and so does every later one that
makes, moves or writes something. Prints for each run, as JSON, whether stepgen refused, and what
was then where the library belongs or had stepped aside, until a run has fewer than N calls.
"""

import errno
import json
import os
import sys
from pathlib import Path

from stepgen.errors import StepgenError
from stepgen.library import swap, write
from stepgen.library.marker import MARKER

OLD = {"README.md": "old\n", "src/Pan.h": "old header\n", "src/Old.cpp": "old code\n"}
NEW = {"README.md": "new\n", "src/Pan.h": "new header\n", "src/New.cpp": "new code\n"}
_WRITING = os.O_WRONLY | os.O_RDWR


class FailingDisk:
    """
    Fails from call *first* on; an audit hook cannot be removed, so it is told when to look away.
    """

    def __init__(self, error: int) -> None:
        self.error = error
        self.first: int | None = None
        self.seen = 0
        sys.addaudithook(self.hook)

    def hook(self, event: str, arguments: tuple[object, ...]) -> None:
        """
        Count a call to the file system, and let it fail when its time has come.
        """
        if self.first is None or not (event in {"open", "shutil.rmtree"} or event[:3] == "os."):
            return
        flags = arguments[2] if event == "open" else 0
        writes = isinstance(flags, int) and bool(flags & _WRITING)
        makes = writes or event in {"os.mkdir", "os.rename"}
        self.seen += 1
        if self.seen == self.first or (self.seen > self.first and makes):
            raise OSError(self.error, os.strerror(self.error), "x")


def files(folder: Path) -> dict[str, str] | None:
    """
    Return the files of a library in *folder* but for the marker; None where no folder is.
    """
    if not folder.is_dir():
        return None
    found = {path.relative_to(folder).as_posix(): path for path in folder.rglob("*")}
    texts = {name: path.read_text() for name, path in found.items() if path.is_file()}
    return {name: text for name, text in texts.items() if name != MARKER}


def main() -> None:
    """
    Write, and come to grief at each call in turn.
    """
    folder = Path(sys.argv[1])
    target = folder / "Pan"
    disk = FailingDisk(getattr(errno, sys.argv[2]))
    if "--no-exchange" in sys.argv:
        swap.exchange = lambda one, two: one == two  # which they never are
    results = []
    for first in range(1, 1000):
        write.write_library(OLD, target)
        disk.seen, disk.first, refused = 0, first, False
        try:
            write.write_library(NEW, target)
        except StepgenError:
            refused = True
        disk.first = None
        aside = [files(path) for path in folder.glob(".Pan.stepgen-*/old")]
        found: dict[str, object] = {"refused": refused, "target": files(target), "aside": aside}
        write.write_library(NEW, target)  # the next run mends what is to mend
        found["left"] = sorted(path.name for path in folder.iterdir())
        results.append(found)
        if disk.seen < first:
            break
    sys.stdout.write(json.dumps(results))


if __name__ == "__main__":
    main()

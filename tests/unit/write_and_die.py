"""
A writer that is killed: ``write_and_die.py TARGET N [--no-exchange]``.

Writes a library over what is there and kills itself, as kill -9 would, before its Nth call to
the file system (opening, making, renaming, removing). Ends with 0 when N is past the last call.
"""

import os
import signal
import sys
from pathlib import Path

from stepgen.library import swap, write

NEW = {"README.md": "new\n", "src/Pan.h": "new header\n", "src/New.cpp": "new code\n"}
_CALLS = ("open", "shutil.rmtree")


def die_before(call: int) -> None:
    """
    Kill this process before the file system call number *call*.
    """
    seen = 0

    def hook(event: str, _: tuple[object, ...]) -> None:
        nonlocal seen
        if event in _CALLS or (event.startswith("os.") and event != "os.kill"):
            if seen == call:
                os.kill(os.getpid(), signal.SIGKILL)
            seen += 1

    sys.addaudithook(hook)


if __name__ == "__main__":
    if "--no-exchange" in sys.argv:
        swap.exchange = lambda one, two: one == two  # which they never are
    die_before(int(sys.argv[2]))
    write.write_library(NEW, Path(sys.argv[1]))

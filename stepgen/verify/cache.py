"""
The cache folder, and entries in it that are built once and never seen half-finished.
"""

import contextlib
import hashlib
import os
import tempfile
from collections.abc import Callable, Iterable
from pathlib import Path

from stepgen.errors import StepgenError

_KEY_DIGITS = 24


def cache_dir() -> Path:
    """
    Return the cache folder: $STEPGEN_CACHE, else $XDG_CACHE_HOME/stepgen, else ~/.cache/stepgen.
    """
    own = os.environ.get("STEPGEN_CACHE")
    if own:
        return Path(own).absolute()
    shared = os.environ.get("XDG_CACHE_HOME")
    return (Path(shared).absolute() if shared else Path.home() / ".cache") / "stepgen"


def content_key(parts: Iterable[str | bytes]) -> str:
    """
    Return a name for an entry that is made from *parts* and from nothing else.

    Each part is hashed with its length, so that ("ab", "c") and ("a", "bc") differ.
    """
    digest = hashlib.sha256()
    for part in parts:
        data = part.encode() if isinstance(part, str) else part
        digest.update(f"{len(data)}:".encode() + data)
    return digest.hexdigest()[:_KEY_DIGITS]


def build_once(kind: str, key: str, make: Callable[[Path], None]) -> Path:
    """
    Return the folder ``cache_dir()/kind/key``; the first caller has *make* fill it.

    *make* writes into a fresh folder, which is renamed when it is complete: another process
    sees the whole entry or none. Processes that start together may each run *make*; the
    first to finish wins, and the others use its entry. If *make* raises, nothing is kept.

    Args:
        kind: What is kept, a folder name such as "core".
        key: A name that changes whenever the content would, see content_key.
        make: Fills the empty folder that it is given.

    Raises:
        StepgenError: The cache folder cannot be written.
    """
    entry = cache_dir() / kind / key
    if entry.is_dir():
        return entry
    with contextlib.ExitStack() as stack:
        fresh = _fresh_folder(entry, stack)
        make(fresh)
        _publish(fresh, entry)
    return entry


def _fresh_folder(entry: Path, stack: contextlib.ExitStack) -> Path:
    """
    Return an empty folder on the same file system as *entry*, removed with *stack*.
    """
    try:
        entry.parent.mkdir(parents=True, exist_ok=True)
        scratch = stack.enter_context(
            tempfile.TemporaryDirectory(dir=entry.parent, prefix=f".{entry.name}.")
        )
        fresh = Path(scratch) / entry.name
        fresh.mkdir()
    except OSError as error:
        raise StepgenError.of(
            f"the cache folder cannot be written ({error.strerror}); set STEPGEN_CACHE to a "
            "folder that can",
            place=str(entry.parent),
        ) from error
    return fresh


def _publish(fresh: Path, entry: Path) -> None:
    """
    Rename *fresh* to *entry*, unless another process has just done the same.
    """
    try:
        fresh.rename(entry)
    except OSError:
        if not entry.is_dir():
            raise

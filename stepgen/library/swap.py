"""
Replacing a folder or a file as a whole: whoever looks, and at any kill, sees the old or the new.
"""

import ctypes
import errno
import glob
import os
import shutil
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from tempfile import mkdtemp

from stepgen.errors import StepgenError

if sys.platform != "win32":
    import fcntl

LOCK_TIMEOUT_S = 20.0
_LOCK_RETRY_S = 0.02
_NEW, _OLD = "new", "old"
_AT_FDCWD = -100  # <fcntl.h>: paths are relative to the working directory
_RENAME_EXCHANGE = 2  # <linux/fs.h>
_NO_LOCKS_HERE = (errno.EBADF, errno.ENOLCK, errno.ENOTSUP, errno.EINVAL)


Spare = Callable[[Path], bool]
"""Tells whether a folder that is to be removed holds files that are not stepgen's."""


def spare_nothing(_folder: Path) -> bool:
    """
    Tell so of no folder: for files, which are stepgen's as a whole.
    """
    return False


@contextmanager
def os_errors(target: Path) -> Iterator[None]:
    """
    Report an operating system's refusal (no permission, disk full ...) as a fault of *target*.

    Raises:
        StepgenError: Instead of the OSError.
    """
    try:
        yield
    except OSError as error:
        what = error.strerror or str(error)
        full = error.errno in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
        way_out = "make room on the disk" if full else "name a folder that you may write to"
        raise StepgenError.of(f"cannot be written ({what}); {way_out}", place=str(target)) from None


@contextmanager
def locked(folder: Path) -> Iterator[bool]:
    """
    Keep other runs of stepgen out of *folder* meanwhile; they wait for their turn.

    The lock is one on the folder itself: no file is left behind, and a killed run holds
    nothing. Yields False where the system cannot lock a folder (Windows, some network drives):
    of two runs at once one may be refused there, but each still swaps a whole library in.

    Raises:
        StepgenError: Another run has kept the lock for `LOCK_TIMEOUT_S`.
    """
    if sys.platform == "win32":
        yield False
        return
    descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        yield _lock(descriptor, folder)
    finally:
        os.close(descriptor)


def _lock(descriptor: int, folder: Path) -> bool:
    deadline = time.monotonic() + LOCK_TIMEOUT_S
    while True:
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            if time.monotonic() > deadline:
                reason = "another run of stepgen is writing here; try again when it has ended"
                raise StepgenError.of(reason, place=str(folder)) from None
            time.sleep(_LOCK_RETRY_S)
        except OSError as error:
            if error.errno in _NO_LOCKS_HERE:
                return False
            raise
        else:
            return True


def recover(target: Path, spare: Spare) -> None:
    """
    Tidy up after runs that were killed: bring the old *target* back if it is missing.

    Only for who holds the lock, since it removes what another run may still be working on.

    Raises:
        StepgenError: *spare* says that a killed run left files there that are not stepgen's.
    """
    for staging in sorted(target.parent.glob(f"{glob.escape(_prefix(target))}*")):
        old = staging / _OLD
        if old.is_dir() and not os.path.lexists(target):
            old.rename(target)
        _remove(staging, target, spare)
        if spare(staging / _NEW) or spare(old):
            reason = (
                "holds files that stepgen did not write, left there by a run that was killed; "
                "move them elsewhere and remove the folder"
            )
            raise StepgenError.of(reason, place=str(staging))


def _remove(staging: Path, target: Path, spare: Spare) -> None:
    """
    Remove *staging*, but not an old *target* that could not be put back, nor what to *spare*.
    """
    old = staging / _OLD
    if (old.is_dir() and not os.path.lexists(target)) or spare(old) or spare(staging / _NEW):
        return
    shutil.rmtree(staging, ignore_errors=True)


def _prefix(target: Path) -> str:
    # Hidden, so that the Arduino IDE takes it for no library.
    return f".{target.name}.stepgen-"


@contextmanager
def _staging(target: Path, spare: Spare) -> Iterator[Path]:
    """
    Make a folder beside *target*, on the same file system; it goes away whatever happens.
    """
    folder = Path(mkdtemp(prefix=_prefix(target), dir=target.parent))
    try:
        yield folder
    finally:
        with suppress(OSError):
            _remove(folder, target, spare)


def replace_folder(
    contents: Mapping[str, bytes], target: Path, judge: Callable[[Path], None], spare: Spare
) -> None:
    """
    Make *target* a folder that holds exactly *contents*, path -> bytes, in one instant.

    The new folder is written and flushed beside *target*, then changes places with it. Where
    the system cannot exchange two folders, the old one steps aside first; a kill in between
    leaves it beside *target*, and `recover` brings it back.

    Args:
        contents: What to write.
        target: The folder.
        judge: Looks once more at the old folder, which nobody else can reach any more, before it
            is removed: if somebody has saved a file there in the last moment, it raises, and
            the old folder comes back.
        spare: Tells whether a folder holds files that must not be removed.

    Raises:
        OSError: Something cannot be written; *target* is then whole, the old one or, if
            only flushing it failed, the new one.
    """
    with _staging(target, spare) as staging:
        new = staging / _NEW
        for path, content in contents.items():
            write_durably(new / path, content)
        for folder, _, _ in os.walk(new):
            _flush_folder(Path(folder))
        if os.path.lexists(target):
            old = _change_places(new, target)
            try:
                judge(old)
            except StepgenError:
                _change_places(old, target)
                raise
        else:
            new.rename(target)
        _flush_folder(target.parent)


def _change_places(new: Path, target: Path) -> Path:
    """
    Put *new* in the place of *target*; return where the old one is now.
    """
    if exchange(new, target):
        return new
    old = new.with_name(_OLD if new.name == _NEW else _NEW)
    target.rename(old)
    try:
        new.rename(target)
    except OSError:
        old.rename(target)
        raise
    return old


def replace_file(content: bytes, target: Path) -> None:
    """
    Make *target* a file that holds *content*, in one instant.

    Raises:
        OSError: It cannot be written; *target* is then as it was.
    """
    with _staging(target, spare_nothing) as staging:
        write_durably(staging / _NEW, content)
        (staging / _NEW).replace(target)
        _flush_folder(target.parent)


def write_durably(path: Path, content: bytes) -> None:
    """
    Write a file that is on the disk when this returns, and the folders that lead to it.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("xb") as stream:
        stream.write(content)
        stream.flush()
        os.fsync(stream.fileno())


def _flush_folder(folder: Path) -> None:
    if sys.platform == "win32":
        return
    descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        with suppress(OSError):  # some file systems cannot flush a folder
            os.fsync(descriptor)
    finally:
        os.close(descriptor)


def exchange(one: Path, two: Path) -> bool:
    """
    Let two paths change places in one instant; False where the system cannot.

    Source: renameat2(2), RENAME_EXCHANGE (Linux).

    Raises:
        OSError: The system can, but not with these two.
    """
    if sys.platform != "linux":
        return False
    libc = ctypes.CDLL(None, use_errno=True)
    if not hasattr(libc, "renameat2"):
        return False
    paths = (_AT_FDCWD, os.fsencode(one), _AT_FDCWD, os.fsencode(two))
    if libc.renameat2(*paths, ctypes.c_uint(_RENAME_EXCHANGE)) == 0:
        return True
    code = ctypes.get_errno()
    if code in (errno.EINVAL, errno.ENOSYS, errno.ENOTSUP):
        return False
    raise OSError(code, os.strerror(code), str(two))

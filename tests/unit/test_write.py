"""
Libraries on disk: whole at any kill, one run at a time, and nothing of the user's is lost.
"""

import errno
import json
import resource
import signal
import stat
import subprocess
import sys
import threading
import zipfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from stepgen.errors import StepgenError
from stepgen.library import swap
from stepgen.library.write import (
    check_library,
    check_zip,
    refusals,
    write_library,
    zip_library,
)

OLD = {"README.md": "old\n", "src/Pan.h": "old header\n", "src/Old.cpp": "old code\n"}
NEW = {"README.md": "new\n", "src/Pan.h": "new header\n", "src/New.cpp": "new code\n"}
MARKER = "extras/stepgen.json"
KILLER = Path(__file__).with_name("write_and_die.py")
FAILER = Path(__file__).with_name("write_and_fail.py")
WRITER = """
import json, pathlib, sys
from stepgen.library.write import write_library
for _ in range(100):
    write_library(json.loads(sys.argv[2]), pathlib.Path(sys.argv[1]))
"""
# On a file system of its own, which only this process sees, and which goes away with it.
FULL_DISK = """
import json, pathlib, sys
from stepgen.errors import StepgenError
from stepgen.library.write import write_library
old, new, target = json.loads(sys.argv[1]), json.loads(sys.argv[2]), pathlib.Path(sys.argv[3])
write_library(old, target)
try:
    write_library(new, target)
except StepgenError as error:
    assert "make room on the disk" in str(error), error
    new = old
assert all((target / path).read_text() == text for path, text in new.items())
assert [path.name for path in target.parent.iterdir()] == ["Pan"]
print(new == old)
"""
MOUNT = 'mount -t tmpfs -o size="$1k" tmpfs "$2" && shift 2 && exec "$@"'

Tree = dict[str, bytes | str]


def tree(folder: Path) -> Tree:
    """
    Return all that is below *folder*: contents of files, targets of links, names of folders.
    """

    def content(path: Path) -> bytes | str:
        if path.is_symlink():
            return str(path.readlink())
        return path.read_bytes() if path.is_file() else "folder"

    return {str(path.relative_to(folder)): content(path) for path in sorted(folder.rglob("*"))}


def names(folder: Path) -> list[str]:
    """
    Return what *folder* holds, hidden files included.
    """
    return sorted(path.name for path in folder.iterdir())


def texts(folder: Path) -> dict[str, str]:
    """
    Return the files below *folder* as text, without the marker.
    """
    paths = (path for path in folder.rglob("*") if path.is_file())
    found = {path.relative_to(folder).as_posix(): path.read_text() for path in paths}
    return {path: text for path, text in found.items() if path != MARKER}


@pytest.fixture
def target(tmp_path: Path) -> Path:
    """
    Return the folder of a library that is there already.
    """
    write_library(OLD, tmp_path / "libraries" / "Pan")
    return tmp_path / "libraries" / "Pan"


@contextmanager
def refused(target: Path, *words: str) -> Iterator[None]:
    """
    Check that the block is refused with *words* in the message, and that it leaves no trace.
    """
    before = tree(target.parent)
    with pytest.raises(StepgenError) as caught:
        yield
    assert all(word in str(caught.value) for word in (str(target), *words)), caught.value
    assert tree(target.parent) == before


def test_a_new_library_has_its_files_and_the_marker(tmp_path: Path) -> None:
    """
    Missing folders are made, and nothing but the library is left.
    """
    target = tmp_path / "a" / "b" / "Pan"

    result = write_library(OLD, target)

    assert texts(target) == OLD
    assert result.written == ("README.md", MARKER, "src/Old.cpp", "src/Pan.h")
    assert names(target.parent) == ["Pan"]
    assert stat.S_IMODE(target.stat().st_mode) & 0o500 == 0o500


def test_the_marker_is_the_same_every_time(tmp_path: Path) -> None:
    """
    The marker is plain JSON with a checksum for each file, and depends on nothing else.
    """
    for name in ("one", "two"):
        write_library(OLD, tmp_path / name)

    marker = (tmp_path / "one" / MARKER).read_bytes()
    assert marker == (tmp_path / "two" / MARKER).read_bytes()
    # printf 'old\n' | sha256sum
    digest = "01d09d19c2139a46aebfb577780d123d7396e97201bc7ead210a2ebff8239dee"
    assert json.loads(marker)["generator"] == "stepgen"
    assert json.loads(marker)["files"]["README.md"] == digest


def test_a_second_run_says_what_it_did(target: Path) -> None:
    """
    Added, changed and removed files are told apart.
    """
    result = write_library(NEW, target)

    assert texts(target) == NEW
    assert result.written == ("src/New.cpp",)
    assert result.changed == ("README.md", MARKER, "src/Pan.h")
    assert result.removed == ("src/Old.cpp",)
    assert result.unchanged == ()


def test_a_fresh_library_is_not_touched(target: Path) -> None:
    """
    Writing the same again leaves even the folder itself as it was.
    """
    before = target.stat()

    assert write_library(OLD, target).is_fresh
    assert (target.stat().st_ino, target.stat().st_mtime_ns) == (before.st_ino, before.st_mtime_ns)


@pytest.mark.parametrize("force", [False, True])
def test_a_folder_without_the_marker_is_refused(tmp_path: Path, *, force: bool) -> None:
    """
    A folder that stepgen did not write is left alone, and three of its files are named.
    """
    target = tmp_path / "Pan"
    target.mkdir()
    for name in "abcde":
        (target / name).write_text("mine")

    with refused(target, "(a, b, c and 2 more)"):
        write_library(OLD, target, force=force)


@pytest.mark.parametrize(
    "marker",
    [
        "",
        "[]",
        '{"generator": "other"}',
        "\x00",
        "[" * 100_000,
        '{"generator": "stepgen"} ' * 50_000,
    ],
)
def test_a_damaged_marker_is_none(tmp_path: Path, marker: str) -> None:
    """
    What merely has the marker's name does not make a folder stepgen's.
    """
    (tmp_path / "Pan" / "extras").mkdir(parents=True)
    (tmp_path / "Pan" / MARKER).write_text(marker)
    (tmp_path / "Pan" / "mine.txt").write_text("mine")

    with refused(tmp_path / "Pan", "mine.txt"):
        write_library(OLD, tmp_path / "Pan", force=True)


@pytest.mark.parametrize("force", [False, True])
def test_foreign_files_beside_ours_are_refused(target: Path, *, force: bool) -> None:
    """
    A file that the user put into the library is never lost.
    """
    (target / "src" / "mine.h").write_text("mine")

    with refused(target, "src/mine.h"):
        write_library(NEW, target, force=force)


def test_a_link_beside_our_files_is_foreign(target: Path, tmp_path: Path) -> None:
    """
    A link inside the library counts as the user's file, also where it leads to a folder.
    """
    (target / "more").symlink_to(tmp_path)

    with refused(target, "more"):
        write_library(NEW, target)


def test_a_file_manager_s_clutter_is_not_foreign(target: Path) -> None:
    """
    .DS_Store and its like do not keep a library from being written.
    """
    (target / ".DS_Store").write_bytes(b"\x00")

    write_library(NEW, target)

    assert texts(target) == NEW


def test_edited_files_need_force(target: Path) -> None:
    """
    An edited file is refused, overwritten with force, and no obstacle once it is right.
    """
    (target / "README.md").write_text("edited")
    with refused(target, "README.md", "--force"):
        write_library(NEW, target)

    write_library(NEW, target, force=True)
    (target / "README.md").write_text(OLD["README.md"])
    write_library({**NEW, "README.md": OLD["README.md"]}, target)

    assert texts(target) == {**NEW, "README.md": OLD["README.md"]}


def test_a_deleted_file_comes_back(target: Path) -> None:
    """
    What the user removed from the library is written again.
    """
    (target / "src" / "Pan.h").unlink()

    assert write_library(OLD, target).written == ("src/Pan.h",)
    assert texts(target) == OLD


def _link(target: Path) -> None:
    (target.parent / "real").mkdir()
    target.symlink_to(target.parent / "real")


def _dangling_link(target: Path) -> None:
    target.symlink_to(target.parent / "nowhere")


def _file(target: Path) -> None:
    target.write_text("mine")


@pytest.mark.parametrize("make", [_link, _dangling_link, _file])
def test_what_is_no_folder_is_refused(tmp_path: Path, make: Callable[[Path], None]) -> None:
    """
    A link or a file in the library's place is neither followed nor replaced.
    """
    make(tmp_path / "Pan")

    with refused(tmp_path / "Pan", "link" if make is not _file else "no folder"):
        write_library(OLD, tmp_path / "Pan", force=True)
    assert len(refusals(OLD, tmp_path / "Pan")) == 1


def test_an_empty_folder_is_taken(tmp_path: Path) -> None:
    """
    A folder that holds nothing is as good as none.
    """
    (tmp_path / "Pan").mkdir()

    write_library(OLD, tmp_path / "Pan")

    assert texts(tmp_path / "Pan") == OLD


def test_a_file_above_the_library_is_named(tmp_path: Path) -> None:
    """
    Where an output folder is a file, the message says which.
    """
    (tmp_path / "out").write_text("mine")

    with refused(tmp_path / "out" / "Pan", f"{tmp_path / 'out'} is no folder"):
        write_library(OLD, tmp_path / "out" / "Pan")


def test_no_permission_is_a_fault(target: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """
    The system's refusal is a message with the folder; tests run as root, so it is made here.
    """

    def refuse(**_: object) -> str:
        raise PermissionError(errno.EACCES, "Permission denied", "x")

    monkeypatch.setattr(swap, "mkdtemp", refuse)

    with refused(target, "Permission denied"):
        write_library(NEW, target)


def test_proc_cannot_be_written() -> None:
    """
    A real folder that even root cannot write to gives a message, not a traceback.
    """
    with pytest.raises(StepgenError, match="/proc/stepgen/Pan: error: cannot be written"):
        write_library(OLD, Path("/proc/stepgen/Pan"))


def test_a_full_disk_leaves_the_old_library(target: Path) -> None:
    """
    When a file cannot be written to its end, the old library stays and nothing is left beside.
    """
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    before = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    try:
        with refused(target, "make room"):
            resource.setrlimit(resource.RLIMIT_FSIZE, (4096, limits[1]))
            write_library({**NEW, "src/Pan.h": "x" * 10_000}, target)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        signal.signal(signal.SIGXFSZ, before)


@pytest.mark.campaign
def test_a_small_disk_leaves_the_old_library(tmp_path: Path) -> None:
    """
    On disks from too small to large enough for the new library beside the old, one is whole.
    """
    large = {**NEW, "src/Pan.h": "x" * 50_000}
    mount = ("unshare", "--map-root-user", "--mount", "sh", "-c", MOUNT, "sh")
    write = (sys.executable, "-c", FULL_DISK, json.dumps(OLD), json.dumps(large))
    kept_old = []
    for size_kib in range(32, 144, 8):
        command = (*mount, str(size_kib), str(tmp_path), *write, str(tmp_path / "Pan"))
        done = subprocess.run(command, check=False, capture_output=True, text=True, timeout=60)
        assert done.returncode == 0, done.stderr
        kept_old.append(done.stdout == "True\n")

    assert kept_old == sorted(kept_old, reverse=True)
    assert kept_old[0]
    assert not kept_old[-1]


@pytest.mark.parametrize("path", ["/etc/x", "../x", "a/../../x", "", MARKER])
def test_files_stay_inside_the_library(tmp_path: Path, path: str) -> None:
    """
    A path that leads out of the library or the zip, or is the marker's, is the caller's mistake.
    """
    with pytest.raises(ValueError, match="cannot be a file of a library"):
        write_library({path: "text"}, tmp_path / "Pan")
    with pytest.raises(ValueError, match="cannot be a file of a library"):
        zip_library({path: "text"}, "Pan", tmp_path / "Pan.zip")
    assert names(tmp_path) == []


def _die(target: Path, call: int, *options: str) -> bool:
    command = (sys.executable, str(KILLER), str(target), str(call), *options)
    code = subprocess.run(command, check=False, timeout=60).returncode
    assert code in (0, -signal.SIGKILL)
    return code != 0


@pytest.mark.parametrize("options", [(), ("--no-exchange",)])
def test_a_kill_leaves_a_whole_library(tmp_path: Path, options: tuple[str, ...]) -> None:
    """
    Killed before any call to the file system, the old or the new library is whole.

    Without the exchange the old one may have stepped aside; the next run brings it back. In
    both cases the next run ends well and leaves nothing beside the library.
    """
    seen = []
    target = tmp_path / "Pan"
    for call in range(1000):
        write_library(OLD, target, force=True)
        if not _die(target, call, *options):
            break
        aside = [path / "old" for path in tmp_path.glob(".Pan.stepgen-*") if options]
        whole = next(path for path in (target, *aside) if path.exists())
        seen.append((texts(whole), whole == target))
        assert texts(whole) in (OLD, NEW)
        write_library(NEW, target)
        assert texts(target) == NEW
        assert names(tmp_path) == ["Pan"]

    assert (OLD, True) in seen
    assert (NEW, True) in seen
    assert ((OLD, False) in seen) == bool(options)


def test_a_killed_first_run_leaves_no_half_library(tmp_path: Path) -> None:
    """
    Where no library was, there is none or a whole one after a kill.
    """
    call = 0
    while _die(tmp_path / str(call) / "Pan", call):
        target = tmp_path / str(call) / "Pan"
        assert not target.exists() or texts(target) == NEW
        call += 1
    assert call > len(NEW)


@pytest.mark.parametrize("error", ["ENOSPC", "EIO"])
@pytest.mark.parametrize("options", [(), ("--no-exchange",)])
def test_a_failing_disk_leaves_a_whole_library(
    tmp_path: Path, options: tuple[str, ...], error: str
) -> None:
    """
    From any call to the file system on nothing more can be written: one library is whole.

    Without the exchange it may have stepped aside; the next run ends well and mends that.
    """
    command = (sys.executable, str(FAILER), str(tmp_path), error, *options)
    done = subprocess.run(command, check=True, timeout=60, capture_output=True)
    results = json.loads(done.stdout)

    for result in results:
        whole = result["target"] or result["aside"][0]
        assert whole in ((OLD, NEW) if result["refused"] else (NEW,))
        assert result["target"] is not None or options
        assert result["left"] == ["Pan"]
    assert [result["refused"] for result in results].count(True) > len(NEW)
    assert not results[-1]["refused"]
    assert any(result["target"] is None for result in results) == bool(options)


@pytest.mark.parametrize("exchanges", [True, False])
def test_a_file_saved_in_the_last_moment_is_not_lost(
    target: Path, monkeypatch: pytest.MonkeyPatch, *, exchanges: bool
) -> None:
    """
    What comes into the library between the look at it and the swap brings the old one back.
    """
    exchange = swap.exchange
    unsaved = ["mine"]

    def save_and_exchange(one: Path, two: Path) -> bool:
        if unsaved:
            (target / "mine.txt").write_text(unsaved.pop())
        return exchanges and exchange(one, two)

    monkeypatch.setattr(swap, "exchange", save_and_exchange)
    with pytest.raises(StepgenError, match=r"did not write \(mine.txt\)") as caught:
        write_library(NEW, target)

    assert caught.value.faults[0].place == str(target)
    assert texts(target) == {**OLD, "mine.txt": "mine"}
    assert names(target.parent) == ["Pan"]


def test_a_killed_run_s_folder_with_a_saved_file_is_kept(target: Path) -> None:
    """
    A kill right after the swap leaves the old library aside; what was saved in it is not lost.
    """
    aside = target.parent / ".Pan.stepgen-killed"
    aside.mkdir()
    target.rename(aside / "new")
    write_library(NEW, target)  # it finds no trace of a file that is not its own
    assert names(target.parent) == ["Pan"]

    write_library(OLD, aside / "new")
    (aside / "new" / "mine.txt").write_text("mine")
    with refused(target.parent / ".Pan.stepgen-killed", "a run that was killed", "move them"):
        write_library(OLD, target)


def test_two_runs_at_once_do_not_mix(tmp_path: Path) -> None:
    """
    Of many runs at once with two libraries, one wins as a whole, and nothing is left beside.
    """
    processes = [
        subprocess.Popen(
            [
                sys.executable,
                "-c",
                WRITER,
                str(tmp_path / "Pan"),
                json.dumps(files),
            ]
        )
        for files in (OLD, NEW, OLD, NEW)
    ]

    assert [process.wait(timeout=120) for process in processes] == [0, 0, 0, 0]
    assert texts(tmp_path / "Pan") in (OLD, NEW)
    assert names(tmp_path) == ["Pan"]


def test_a_run_waits_for_another(target: Path) -> None:
    """
    A run begins when the one before it has let the folder go.
    """
    thread = threading.Thread(target=write_library, args=(NEW, target))
    with swap.locked(target.parent) as alone:
        thread.start()
        thread.join(timeout=0.2)
        assert alone
        assert thread.is_alive()
        assert texts(target) == OLD
    thread.join(timeout=20)
    assert texts(target) == NEW


def test_a_run_does_not_wait_for_ever(target: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """
    When the other run never ends, a message says so.
    """
    monkeypatch.setattr(swap, "LOCK_TIMEOUT_S", 0.05)
    with (
        swap.locked(target.parent),
        pytest.raises(StepgenError, match="another run of stepgen is writing here"),
    ):
        write_library(NEW, target)


def test_check_names_each_difference(target: Path, tmp_path: Path) -> None:
    """
    Stale, missing and extra files are named; a fresh library has none, a missing one has all.
    """
    (target / "mine.txt").write_text("mine")
    before = tree(tmp_path)

    assert check_library(NEW, target) == [
        "README.md: stale",
        f"{MARKER}: stale",
        "mine.txt: extra",
        "src/New.cpp: missing",
        "src/Old.cpp: extra",
        "src/Pan.h: stale",
    ]
    (target / "mine.txt").unlink()
    assert check_library(OLD, target) == []
    assert len(check_library(OLD, tmp_path / "none")) == len(OLD) + 1
    assert set(before) - set(tree(tmp_path)) == {"libraries/Pan/mine.txt"}


def test_a_zip_is_the_same_every_time(tmp_path: Path) -> None:
    """
    Sorted, dated 1980, under the library's name, and byte for byte equal on a second run.
    """
    one, two = tmp_path / "one.zip", tmp_path / "two.zip"

    assert zip_library(OLD, "Pan", one)
    assert zip_library(dict(reversed(OLD.items())), "Pan", two)

    assert one.read_bytes() == two.read_bytes()
    with zipfile.ZipFile(one) as archive:
        assert archive.testzip() is None
        assert archive.namelist() == [f"Pan/{path}" for path in sorted([*OLD, MARKER])]
        assert {entry.date_time for entry in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}
        assert archive.read("Pan/src/Pan.h").decode() == OLD["src/Pan.h"]


def test_a_zip_is_replaced_only_when_it_is_ours(tmp_path: Path) -> None:
    """
    A zip of this library is renewed; any other file, folder or link of that name is refused.
    """
    zipped = tmp_path / "Pan.zip"
    zip_library(OLD, "Pan", zipped)
    assert not zip_library(OLD, "Pan", zipped)
    assert check_zip(NEW, "Pan", zipped) == ["Pan.zip: stale"]
    assert zip_library(NEW, "Pan", zipped)
    assert check_zip(NEW, "Pan", zipped) == []
    assert names(tmp_path) == ["Pan.zip"]

    with refused(zipped, "no zip of Tilt"):
        zip_library(OLD, "Tilt", zipped)
    zipped.write_bytes(b"PK no zip")
    with refused(zipped, "no zip of Pan"):
        zip_library(OLD, "Pan", zipped)
    zipped.unlink()
    assert check_zip(NEW, "Pan", zipped) == ["Pan.zip: missing"]
    zipped.symlink_to("elsewhere.zip")
    with refused(zipped, "no zip of Pan"):
        zip_library(OLD, "Pan", zipped)

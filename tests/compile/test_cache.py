"""
The cache builds each entry once, and nobody sees half of one.
"""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from stepgen.errors import StepgenError
from stepgen.verify.cache import build_once, cache_dir, content_key


def test_an_entry_is_whole_or_absent(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """
    Of several at once one wins and all get its entry; one that fails leaves nothing behind.
    """
    monkeypatch.setenv("STEPGEN_CACHE", str(tmp_path))

    def maker(number: int) -> Callable[[Path], None]:
        def make(folder: Path) -> None:
            for name in ("a", "b"):
                (folder / name).write_text(str(number))

        return make

    def fail(folder: Path) -> None:
        (folder / "half").touch()
        raise RuntimeError(folder.name)

    with ThreadPoolExecutor(8) as pool:
        entries = set(pool.map(lambda n: build_once("test", "entry", maker(n)), range(8)))
    with pytest.raises(RuntimeError, match="broken"):
        build_once("test", "broken", fail)

    assert entries == {tmp_path / "test" / "entry"}
    (entry,) = entries
    assert (entry / "a").read_text() == (entry / "b").read_text()
    assert list((tmp_path / "test").iterdir()) == [entry]


def test_the_cache_folder_follows_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    """
    STEPGEN_CACHE comes before XDG_CACHE_HOME, and that before the home folder.
    """
    monkeypatch.setenv("HOME", "/home/ada")
    monkeypatch.setenv("XDG_CACHE_HOME", "/xdg")
    monkeypatch.setenv("STEPGEN_CACHE", "/own")
    own = cache_dir()
    monkeypatch.delenv("STEPGEN_CACHE")
    shared = cache_dir()
    monkeypatch.delenv("XDG_CACHE_HOME")

    assert [own, shared] == [Path("/own"), Path("/xdg/stepgen")]
    assert cache_dir() == Path("/home/ada/.cache/stepgen")


def test_a_cache_folder_that_cannot_be_made_is_reported(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """
    The message says which variable chooses another folder.
    """
    (tmp_path / "file").touch()
    monkeypatch.setenv("STEPGEN_CACHE", str(tmp_path / "file"))

    with pytest.raises(StepgenError, match="set STEPGEN_CACHE"):
        build_once("test", "entry", lambda _: None)


def test_keys_tell_parts_apart() -> None:
    """
    The same letters in other parts are another key.
    """
    assert content_key(["ab", "c"]) != content_key(["a", "bc"])
    assert content_key(["ab", "c"]) == content_key([b"ab", b"c"])

"""
Compiles the C side of the harness on first use and keeps it in the user's cache.
"""

import contextlib
import functools
import hashlib
import importlib.util
import io
import os
import re
import shlex
import subprocess
import sys
import sysconfig
import tempfile
from pathlib import Path
from types import ModuleType

import cffi

from stepgen.errors import StepgenError

_HERE = Path(__file__).parent
_DEBIAN_PACKAGES = "gcc libsimavr-dev libelf-dev python3-dev"
INSTALL = f"on Debian: apt install {_DEBIAN_PACKAGES}"
_PACKAGE_FILES = ("lib/*/pkgconfig/simavr.pc", "lib/pkgconfig/simavr.pc")
_UNKNOWN = "of unknown version"
_FLAGS = ("-std=gnu11", "-O2", "-fPIC", "-shared", "-Wall", "-Wextra")


def sources() -> tuple[Path, ...]:
    """
    Return the C files of the harness, in the order of their names.
    """
    return tuple(sorted(_HERE.glob("*.c")))


def cache_dir() -> Path:
    """
    Return where compiled harnesses are kept: $XDG_CACHE_HOME/stepgen or ~/.cache/stepgen.
    """
    base = os.environ.get("XDG_CACHE_HOME")
    return (Path(base) if base else Path.home() / ".cache") / "stepgen"


def find_version() -> str | None:
    """
    Return the version of libsimavr that its pkg-config file states, None without libsimavr.
    """
    for base in (Path("/usr/local"), Path("/usr")):
        for pattern in _PACKAGE_FILES:
            for path in base.glob(pattern):
                found = re.search(r"^Version: *(\S+)", path.read_text(), re.MULTILINE)
                return found[1] if found else _UNKNOWN
    return _UNKNOWN if Path("/usr/include/simavr").is_dir() else None


def _compiler() -> list[str]:
    return shlex.split(os.environ.get("CC", "gcc"))


def _include_dirs() -> tuple[str, ...]:
    # simavr's own headers include each other without their folder.
    return (str(_HERE), sysconfig.get_paths()["include"], "/usr/include/simavr")


def _fingerprint() -> str:
    digest = hashlib.sha256()
    for path in (*sources(), *sorted(_HERE.glob("*.h"))):
        digest.update(path.name.encode() + b"\0" + path.read_bytes())
    for part in (sys.version, cffi.__version__, *_compiler(), *_FLAGS):
        digest.update(part.encode() + b"\0")
    return digest.hexdigest()[:16]


def _compile(name: str, target: Path) -> None:
    builder = cffi.FFI()
    builder.cdef((_HERE / "api.h").read_text(encoding="ascii"))
    builder.set_source(name, '#include "harness.h"')
    target.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=target.parent) as folder:
        wrapper = Path(folder) / f"{name}.c"
        built = Path(folder) / target.name
        with contextlib.redirect_stdout(io.StringIO()):  # cffi reports each file it writes
            builder.emit_c_code(str(wrapper))
        include = [f"-I{path}" for path in _include_dirs()]
        files = [str(path) for path in (wrapper, *sources())]
        _run_compiler([*_compiler(), *_FLAGS, *include, *files, "-lsimavr", "-o", str(built)])
        # Parallel builders each make their own; the last rename wins, all are alike.
        built.replace(target)


def _run_compiler(command: list[str]) -> None:
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except FileNotFoundError:
        raise StepgenError.of(
            f"{command[0]} is not here, and the simulator harness is compiled on first use; "
            f"{INSTALL}"
        ) from None
    if done.returncode:
        detail = next((line for line in done.stderr.splitlines() if "error" in line), done.stderr)
        raise StepgenError.of(
            f"the simulator harness does not compile ({detail.strip()}); {INSTALL}"
        )


@functools.cache
def load() -> ModuleType:
    """
    Return the compiled harness, a cffi module with `ffi` and `lib`.

    Raises:
        StepgenError: libsimavr, its headers or a C compiler are missing.
    """
    name = f"_stepgen_simavr_{_fingerprint()}"
    target = cache_dir() / f"{name}{sysconfig.get_config_var('EXT_SUFFIX')}"
    if not target.exists():
        _compile(name, target)
    spec = importlib.util.spec_from_file_location(name, target)
    if spec is None or spec.loader is None:  # pragma: no cover
        raise StepgenError.of(f"{target} is no Python extension; delete it and try again")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module

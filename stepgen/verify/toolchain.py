"""
Compiles a sketch and its library with the real Arduino core, as the Arduino IDE would.
"""

import re
import shutil
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

from stepgen.errors import Fault, StepgenError
from stepgen.verify.arduino_core import Options, Toolchain, core_archive, core_key
from stepgen.verify.cache import build_once, content_key
from stepgen.verify.compilers import (
    Compiler,
    compiler_named,
    default_compiler,
    find_compilers,
    shorten,
)
from stepgen.verify.recipes import Target, platform_dir

__all__ = [
    "Build",
    "Compiler",
    "Target",
    "Toolchain",
    "build",
    "compiler_named",
    "default_compiler",
    "empty_sketch",
    "find_compilers",
    "measure",
]

_NO_DEFINES: Mapping[str, str] = MappingProxyType({})
_EMPTY_SKETCH = "void setup() {}\nvoid loop() {}\n"

# What generated libraries promise to compile with, whatever the core moves on to.
_LANGUAGE = "-std=gnu++11"


@dataclass(frozen=True)
class Build:
    """
    A linked program and what it takes of the chip, as the IDE counts.

    Args:
        elf: The program, with debug information.
        flash_bytes: Code and the initial values of variables.
        ram_bytes: Variables, without heap and stack.
    """

    elf: Path
    flash_bytes: int
    ram_bytes: int


def build(  # noqa: PLR0913 - what is compiled, for what, with what, and how strictly
    sources: Sequence[Path],
    includes: Sequence[Path],
    target: Target,
    compiler: Compiler,
    out_dir: Path,
    *,
    warnings_as_errors: bool = True,
    defines: Mapping[str, str] = _NO_DEFINES,
) -> Build:
    """
    Return the program made of *sources* and the Arduino core, in *out_dir*.

    The command lines are those of platform.txt, so that the code is the IDE's, byte for byte.
    A ``.ino`` gets ``#include <Arduino.h>``, but no function prototypes: it has to declare
    what it calls before it calls it.

    Args:
        sources: ``.ino``, ``.cpp``, ``.c`` or ``.S`` files: the sketch first, then its libraries'.
        includes: Folders of the libraries' headers.
        target: The board.
        compiler: One of find_compilers().
        out_dir: Where the program and intermediate files go; made if needed.
        warnings_as_errors: Whether a -Wall -Wextra warning outside the core is an error.
        defines: Macros for the C++ *sources*, not for the core.

    Raises:
        StepgenError: Each source that does not compile, with what the compiler printed;
            or the program does not link, or is too big for the board.
    """
    tools = Toolchain(target, compiler)
    out_dir = out_dir.resolve()
    out_dir.mkdir(parents=True, exist_ok=True)
    options = Options(
        warnings="all" if warnings_as_errors else "none",
        flags=(_LANGUAGE, *(f"-D{name}={value}" for name, value in defines.items())),
        includes=tuple(folder.resolve() for folder in includes),
    )
    objects = _compile_all(tools, [_as_code(path, out_dir) for path in sources], out_dir, options)
    shutil.copyfile(core_archive(tools), out_dir / "core.a")
    output = tools.link(objects, out_dir, sources[0].name)
    if warnings_as_errors:
        _refuse_warnings(output, str(sources[0]))
    return measure(out_dir / f"{sources[0].name}.elf", tools)


def empty_sketch(target: Target, compiler: Compiler) -> Build:
    """
    Return the program whose setup() and loop() do nothing, from the cache if it is there.

    Sizes "over an empty sketch" are over this one.
    """
    tools = Toolchain(target, compiler)

    def make(folder: Path) -> None:
        sketch = folder / "empty.ino"
        sketch.write_text(_EMPTY_SKETCH, encoding="utf-8")
        build([sketch], [], target, compiler, folder)

    folder = build_once("empty", content_key([core_key(tools), _EMPTY_SKETCH]), make)
    return measure(folder / "empty.ino.elf", tools)


def measure(elf: Path, tools: Toolchain) -> Build:
    """
    Return *elf* with its sizes, counted by the size recipe of platform.txt.

    Raises:
        StepgenError: It does not fit the board, by boards.txt's upload.maximum_size (which
            leaves out the bootloader) or upload.maximum_data_size.
    """
    words = {"build.path": str(elf.parent), "build.project_name": elf.stem}
    table, properties = tools.run("recipe.size.pattern", words), tools.properties
    flash_bytes = _total(properties["recipe.size.regex"], table)
    ram_bytes = _total(properties["recipe.size.regex.data"], table)
    for what, used, limit_key in (
        ("flash", flash_bytes, "upload.maximum_size"),
        ("RAM", ram_bytes, "upload.maximum_data_size"),
    ):
        limit = int(properties[limit_key])
        if used > limit:
            raise StepgenError.of(
                f"{elf.stem} needs {used} bytes of {what} with its library, and "
                f"{tools.target.fqbn} has {limit}; give the library fewer motors, "
                "`motion: constant` or shorter tables, or take a board with more memory",
                place=str(elf),
            )
    return Build(elf, flash_bytes, ram_bytes)


def _total(pattern: str, table: str) -> int:
    return sum(int(size) for size in re.findall(pattern, table, re.MULTILINE))


def _as_code(source: Path, out_dir: Path) -> Path:
    """
    Return *source*, or for a ``.ino`` the ``.cpp`` in *out_dir* that it stands for.
    """
    source = source.resolve()
    if source.suffix != ".ino":
        return source
    code = out_dir / f"{source.name}.cpp"
    text = source.read_text(encoding="utf-8")
    code.write_text(f'#include <Arduino.h>\n#line 1 "{source}"\n{text}', encoding="utf-8")
    return code


def _compile_all(
    tools: Toolchain, sources: Sequence[Path], out_dir: Path, options: Options
) -> list[Path]:
    objects = [out_dir / f"{number}-{path.name}.o" for number, path in enumerate(sources)]

    def compile_one(source: Path, out: Path) -> tuple[Fault, ...]:
        try:
            output = tools.compile(source, out, options)
            if options.warnings != "none":
                _refuse_warnings(output, str(source))
        except StepgenError as error:
            return error.faults
        return ()

    with ThreadPoolExecutor() as pool:
        faults = [fault for found in pool.map(compile_one, sources, objects) for fault in found]
    if faults:
        raise StepgenError(faults)
    return objects


def _refuse_warnings(output: str, place: str) -> None:
    """
    Raise if *output* has a warning, unless it is about a file of the core itself.

    This is -Werror, except that the core's headers may warn: with -Werror they could not.
    """
    core = str(platform_dir())
    if any("warning: " in line and not line.startswith(core) for line in output.splitlines()):
        raise StepgenError.of(f"the compiler warns:\n{shorten(output)}", place=place)

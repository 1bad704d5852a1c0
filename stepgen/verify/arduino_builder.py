"""
Runs the Arduino IDE's own build engine, arduino-builder, without the IDE.
"""

import functools
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from stepgen.errors import StepgenError
from stepgen.verify.compilers import Compiler, missing, require_tool, run, shorten
from stepgen.verify.recipes import HARDWARE_DIR, IDE_VERSION, Target, board_properties
from stepgen.verify.toolchain import Build

# Here Debian tells arduino-builder where arduino-ctags is; it has no other tools.
_BUILDER_DIR = Path("/usr/share/arduino-builder")

_FLASH = re.compile(r"^Sketch uses (\d+) bytes", re.MULTILINE)
_RAM = re.compile(r"^Global variables use (\d+) bytes", re.MULTILINE)


@dataclass(frozen=True)
class IdeBuild(Build):
    """
    A program that the IDE's engine built; the sizes are the ones it reports.

    Args:
        warnings: The compiler's about files in the libraries folder, and the IDE's own
            about libraries ("WARNING: Category ... is not valid").
        others: The compiler's about other files, such as the core's where it was compiled.
    """

    warnings: tuple[str, ...]
    others: tuple[str, ...]


def build_with_ide(  # noqa: PLR0913 - the options of the IDE that matter here
    sketch_dir: Path,
    libraries_dir: Path,
    fqbn: str,
    compiler: Compiler,
    build_path: Path,
    *,
    others: Sequence[Path] = (),
    core_cache: Path | None = None,
) -> IdeBuild:
    """
    Return what the Arduino IDE makes of the sketch ``sketch_dir/<its name>.ino``.

    Args:
        sketch_dir: The folder of the sketch, of the same name as its ``.ino``.
        libraries_dir: The libraries folder of a sketchbook.
        fqbn: The board, "arduino:avr:uno" or "arduino:avr:mega:cpu=atmega2560".
        compiler: One of find_compilers().
        build_path: Where the program goes; made if needed.
        others: Further folders of libraries.
        core_cache: Where the compiled core is looked for, and kept.

    Raises:
        StepgenError: A tool is missing, the board is unknown, or the IDE refuses the sketch
            or one of the libraries.
    """
    board_properties(Target.from_fqbn(fqbn))
    sketch = sketch_dir.resolve() / f"{sketch_dir.resolve().name}.ino"
    libraries, out = libraries_dir.resolve(), build_path.resolve()
    out.mkdir(parents=True, exist_ok=True)
    arguments = ["-fqbn", fqbn, "-libraries", str(libraries), "-build-path", str(out)]
    arguments += [word for folder in others for word in ("-libraries", str(folder.resolve()))]
    arguments += ["-build-cache", str(core_cache)] if core_cache else []
    output = run([*_builder_command(compiler), *arguments, str(sketch)], place=str(sketch))
    elf = out / f"{sketch.name}.elf"
    flash_bytes, ram_bytes = _reported(_FLASH, output), _reported(_RAM, output)
    return IdeBuild(elf, flash_bytes, ram_bytes, *_warnings(output, libraries))


@functools.cache
def builder_version() -> str:
    """
    Return what arduino-builder says about its version.

    Raises:
        StepgenError: It is not installed.
    """
    return run([str(require_tool("arduino-builder")), "-version"])


def _builder_command(compiler: Compiler) -> list[str]:
    builder = require_tool("arduino-builder")
    require_tool("arduino-ctags")
    if not _BUILDER_DIR.is_dir():
        raise missing(f"arduino-builder's folder {_BUILDER_DIR} is missing", "arduino-builder")
    return [
        *(str(builder), "-compile", "-logger=human", "-warnings=all"),
        *("-hardware", str(_BUILDER_DIR), "-hardware", str(HARDWARE_DIR)),
        *("-tools", str(_BUILDER_DIR), f"-ide-version={IDE_VERSION}"),
        f"-prefs=compiler.path={compiler.bin_dir}/",
        f"-prefs=compiler.cpp.extra_flags={' '.join(compiler.extra_flags)}",
    ]


def _reported(pattern: re.Pattern[str], output: str) -> int:
    match = pattern.search(output)
    if match is None:
        raise StepgenError.of(f"arduino-builder reports no size:\n{shorten(output)}")
    return int(match[1])


def _warnings(output: str, libraries: Path) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """
    Return the warnings about what is in *libraries*, and those about the rest.
    """
    found = [line for line in output.splitlines() if re.search(r"\bwarning: |^WARNING: ", line)]
    own = (f"{libraries}/", "WARNING: ")
    return (
        tuple(line for line in found if line.startswith(own)),
        tuple(line for line in found if not line.startswith(own)),
    )

"""
Runs the Arduino IDE's own build engine, arduino-builder, without the IDE.
"""

import re
from collections.abc import Iterator
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
    """

    warnings: tuple[str, ...]


def build_with_ide(
    sketch_dir: Path, libraries_dir: Path, fqbn: str, compiler: Compiler, build_path: Path
) -> IdeBuild:
    """
    Return what the Arduino IDE makes of the sketch ``sketch_dir/<its name>.ino``.

    Args:
        sketch_dir: The folder of the sketch, of the same name as its ``.ino``.
        libraries_dir: The libraries folder of a sketchbook.
        fqbn: The board, "arduino:avr:uno" or "arduino:avr:mega:cpu=atmega2560".
        compiler: One of find_compilers().
        build_path: Where the program goes; made if needed.

    Raises:
        StepgenError: A tool is missing, the board is unknown, or the IDE refuses the sketch
            or one of the libraries.
    """
    board_properties(Target.from_fqbn(fqbn))
    sketch = sketch_dir.resolve() / f"{sketch_dir.resolve().name}.ino"
    libraries, out = libraries_dir.resolve(), build_path.resolve()
    out.mkdir(parents=True, exist_ok=True)
    arguments = ["-fqbn", fqbn, "-libraries", str(libraries), "-build-path", str(out)]
    output = run([*_builder_command(compiler), *arguments, str(sketch)], place=str(sketch))
    elf = out / f"{sketch.name}.elf"
    flash_bytes, ram_bytes = _reported(_FLASH, output), _reported(_RAM, output)
    return IdeBuild(elf, flash_bytes, ram_bytes, tuple(_warnings(output, libraries)))


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


def _warnings(output: str, libraries: Path) -> Iterator[str]:
    for line in output.splitlines():
        ours = line.startswith(f"{libraries}/") and "warning: " in line
        if ours or line.startswith("WARNING: "):
            yield line

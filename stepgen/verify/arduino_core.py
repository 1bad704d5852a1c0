"""
The Arduino core, compiled as the IDE does: one source file at a time, and core.a only once.
"""

import shlex
from collections.abc import Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from stepgen.verify.cache import build_once, content_key
from stepgen.verify.compilers import Compiler, run
from stepgen.verify.recipes import Target, board_properties, command, platform_dir

# In the order in which the Arduino IDE puts them into core.a.
RECIPES = {".S": "recipe.S.o.pattern", ".c": "recipe.c.o.pattern", ".cpp": "recipe.cpp.o.pattern"}


@dataclass(frozen=True)
class Options:
    """
    What one source file gets beyond the recipe.

    Args:
        warnings: The IDE's Compiler Warnings preference: none, default, more, all.
        flags: Further flags, C++ only.
        includes: Folders to search after the core's.
    """

    warnings: str = "none"
    flags: tuple[str, ...] = ()
    includes: tuple[Path, ...] = ()


@dataclass(frozen=True)
class Toolchain:
    """
    A compiler at work for a board.
    """

    target: Target
    compiler: Compiler

    @property
    def properties(self) -> Mapping[str, str]:
        """
        Return the properties of the board, see board_properties.
        """
        return board_properties(self.target)

    def run(self, recipe: str, words: Mapping[str, str | Sequence[str]], place: str = "") -> str:
        """
        Run a recipe of platform.txt with this compiler and return what it printed.
        """
        return run(self._command(recipe, words), place=place)

    def compile(self, source: Path, out: Path, options: Options) -> str:
        """
        Compile the .cpp, .c or .S file *source* and return what the compiler printed.
        """
        return run(self.compile_command(source, out, options), place=str(source))

    def compile_command(self, source: Path, out: Path, options: Options) -> list[str]:
        """
        Return the command line that compiles *source* to *out*.
        """
        folders = (*self.source_folders(), *options.includes)
        words = {
            "compiler.warning_flags": self._warning_flags(options.warnings),
            "compiler.cpp.extra_flags": [*self.compiler.extra_flags, *options.flags],
            "includes": [f"-I{folder}" for folder in folders],
            "source_file": str(source),
            "object_file": str(out),
        }
        return self._command(RECIPES[source.suffix], words)

    def link(self, objects: Iterable[Path], build_dir: Path, name: str) -> str:
        """
        Link *objects* with ``core.a`` of *build_dir* to ``name.elf`` there.
        """
        words = {
            "compiler.warning_flags": self._warning_flags("all"),
            "build.path": str(build_dir),
            "build.project_name": name,
            "archive_file": "core.a",
            "object_files": [str(path) for path in objects],
        }
        return self.run("recipe.c.combine.pattern", words)

    def source_folders(self) -> tuple[Path, Path]:
        """
        Return the folders of the core and of the board's variant.
        """
        root = platform_dir()
        return (
            root / "cores" / self.properties["build.core"],
            root / "variants" / self.properties["build.variant"],
        )

    def _command(self, recipe: str, words: Mapping[str, str | Sequence[str]]) -> list[str]:
        path = {"compiler.path": f"{self.compiler.bin_dir}/"}
        return command(self.properties, recipe, {**words, **path})

    def _warning_flags(self, level: str) -> list[str]:
        return self.properties[f"compiler.warning_flags.{level}"].split()


def core_key(tools: Toolchain) -> str:
    """
    Return a name for all that the core's code depends on: sources, recipes, compiler.
    """
    recipes = [
        shlex.join(tools.compile_command(Path(f"in{suffix}"), Path("out.o"), Options()))
        for suffix in RECIPES
    ]
    files = [path for folder in tools.source_folders() for path in sorted(folder.iterdir())]
    contents = [part for path in files for part in (path.name, path.read_bytes())]
    version = tools.properties["version"]
    return content_key([version, tools.compiler.version, *recipes, *contents])


def core_archive(tools: Toolchain) -> Path:
    """
    Return core.a, compiled the first time and found in the cache afterwards.

    Raises:
        StepgenError: The core is not installed or does not compile.
    """
    return build_once("core", core_key(tools), lambda out: _compile_core(tools, out)) / "core.a"


def _compile_core(tools: Toolchain, out_dir: Path) -> None:
    objects = {source: out_dir / f"{source.name}.o" for source in _core_sources(tools)}
    with ThreadPoolExecutor() as pool:
        list(pool.map(lambda source: tools.compile(source, objects[source], Options()), objects))
    archive = str(out_dir / "core.a")
    for path in objects.values():
        tools.run("recipe.ar.pattern", {"archive_file_path": archive, "object_file": str(path)})
    for leftover in (*out_dir.glob("*.o"), *out_dir.glob("*.d")):
        leftover.unlink()


def _core_sources(tools: Toolchain) -> Iterator[Path]:
    core, _ = tools.source_folders()
    for suffix in RECIPES:
        yield from sorted(core.glob(f"*{suffix}"))

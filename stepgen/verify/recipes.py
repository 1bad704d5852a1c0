"""
The Arduino core's own words: boards.txt, platform.txt, and the command lines they give.
"""

import functools
import re
import shlex
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Self

from stepgen.errors import StepgenError
from stepgen.verify.compilers import missing

HARDWARE_DIR = Path("/usr/share/arduino/hardware")
IDE_VERSION = "10819"
_CORE_PACKAGE = "arduino-core-avr"

# arduino-builder 1.3.25 adds ",--relax" (short calls and jumps) for this MCU of its own accord:
# addRelaxTrickIfATMEGA2560 in its linker phase, nowhere in platform.txt. arduino-cli did too,
# until https://github.com/arduino/arduino-cli/pull/749 (2020).
_RELAXED_MCU = "atmega2560"
_LINK_FLAGS = "compiler.c.elf.flags"

_FQBN = re.compile(r"arduino:avr:(?P<board>\w+)(?::cpu=(?P<cpu>\w+))?")
_PLACEHOLDER = re.compile(r"\{([^{}]+)\}")


@dataclass(frozen=True)
class Target:
    """
    What the IDE's Board and Processor menus choose.

    Args:
        board_id: The board in boards.txt: "uno", "mega".
        cpu: The choice in its Processor menu, "atmega2560"; "" where it has no such menu.
    """

    board_id: str
    cpu: str = ""

    @classmethod
    def from_fqbn(cls, fqbn: str) -> Self:
        """
        Return the target of a fully qualified board name, "arduino:avr:mega:cpu=atmega2560".

        Raises:
            StepgenError: *fqbn* is not of this form.
        """
        match = _FQBN.fullmatch(fqbn)
        if match is None:
            raise StepgenError.of(
                "write a board as arduino:avr:uno or arduino:avr:mega:cpu=atmega2560", text=fqbn
            )
        return cls(match["board"], match["cpu"] or "")

    @property
    def fqbn(self) -> str:
        """
        Return the fully qualified board name.
        """
        return f"arduino:avr:{self.board_id}" + (f":cpu={self.cpu}" if self.cpu else "")

    @property
    def title(self) -> str:
        """
        Return the same in short, "mega:atmega2560".
        """
        return f"{self.board_id}:{self.cpu}" if self.cpu else self.board_id


def targets() -> tuple[Target, ...]:
    """
    Return every choice of the Board and Processor menus, in the order of boards.txt.

    Raises:
        StepgenError: The core is not installed.
    """
    return _targets(platform_dir())


def platform_dir() -> Path:
    """
    Return the folder of the AVR core, with platform.txt and boards.txt.

    Raises:
        StepgenError: It is not installed.
    """
    folder = HARDWARE_DIR / "arduino" / "avr"
    if not (folder / "platform.txt").is_file():
        raise missing(f"the Arduino AVR core is not in {folder}", _CORE_PACKAGE)
    return folder


def board_properties(target: Target) -> Mapping[str, str]:
    """
    Return platform.txt's properties with those of *target* over them, not yet expanded.

    Raises:
        StepgenError: The core does not know the board, or the cpu is missing or unknown.
    """
    return _board_properties(platform_dir(), target)


def command(
    properties: Mapping[str, str], recipe: str, words: Mapping[str, str | Sequence[str]]
) -> list[str]:
    """
    Return the argument list of a recipe such as "recipe.cpp.o.pattern".

    Placeholders that neither *words* nor *properties* know are dropped, as by the IDE.

    Args:
        properties: See board_properties.
        recipe: The key of the command line in platform.txt.
        words: What paths and lists stand for, by placeholder; they win over *properties* and
            may hold spaces and quotes. A list must be an argument of its own.
    """
    arguments: list[str] = []
    known = {key: text for key, text in properties.items() if key not in words}
    for argument in shlex.split(_expand(known, properties[recipe])):
        value = words.get(argument[1:-1]) if _PLACEHOLDER.fullmatch(argument) else None
        if value is not None and not isinstance(value, str):
            arguments += value
        elif filled := _PLACEHOLDER.sub(lambda match: str(words.get(match[1], "")), argument):
            arguments.append(filled)
    return arguments


@functools.cache
def _targets(platform: Path) -> tuple[Target, ...]:
    boards = _read_properties(platform / "boards.txt")
    names = [key.removesuffix(".name") for key in boards if re.fullmatch(r"\w+\.name", key)]
    cpus = {
        name: [key for key in _under(boards, f"{name}.menu.cpu.") if "." not in key]
        for name in names
    }
    return tuple(Target(name, cpu) for name in names for cpu in cpus[name] or [""])


@functools.cache
def _board_properties(platform: Path, target: Target) -> Mapping[str, str]:
    boards = _read_properties(platform / "boards.txt")
    board = _under(boards, f"{target.board_id}.")
    if not board:
        raise StepgenError.of("the Arduino AVR core has no such board", text=target.fqbn)
    menu = _under(board, "menu.cpu.")
    choices = sorted(key for key in menu if "." not in key)
    if target.cpu not in (choices or [""]):
        way_out = f"write one of :cpu={', :cpu='.join(choices)}" if choices else "leave :cpu out"
        raise StepgenError.of(f"{target.board_id}: {way_out}", text=target.fqbn)
    chosen = _under(menu, f"{target.cpu}.") if choices else {}
    given = {"build.arch": platform.name.upper(), "runtime.ide.version": IDE_VERSION}
    properties = _read_properties(platform / "platform.txt") | board | chosen | given
    if properties["build.mcu"] == _RELAXED_MCU:
        properties[_LINK_FLAGS] += ",--relax"
    return properties


def _read_properties(path: Path) -> dict[str, str]:
    lines = (line.strip() for line in path.read_text(encoding="utf-8").splitlines())
    pairs = (line.partition("=") for line in lines if "=" in line and not line.startswith("#"))
    return {key.strip(): value.strip() for key, _, value in pairs}


def _under(properties: Mapping[str, str], prefix: str) -> dict[str, str]:
    return {
        key.removeprefix(prefix): value
        for key, value in properties.items()
        if key.startswith(prefix)
    }


def _expand(properties: Mapping[str, str], text: str) -> str:
    """
    Return *text* with each {placeholder} that *properties* know, however deep, filled in.
    """
    while True:
        filled = _PLACEHOLDER.sub(lambda match: properties.get(match[1], match[0]), text)
        if filled == text:
            return text
        text = filled

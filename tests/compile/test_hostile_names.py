"""
Names and texts that are code elsewhere: what a spec may say compiles without a warning.
"""

import json
import re
import subprocess
from pathlib import Path
from typing import Any

import pytest

from stepgen import api
from stepgen.devices import find_board
from stepgen.spec.model import Library
from tests.fuzz.specs import CODE

CORE = Path("/usr/share/arduino/hardware/arduino/avr")
INCLUDES = (CORE / "cores/arduino", CORE / "variants/mega")
# ISO/IEC 14882:2011, 2.12, as far as they can name a motor: letters only.
KEYWORDS = """
    alignas alignof asm auto bool break case catch char class const constexpr continue decltype
    default delete do double else enum explicit export extern false float for friend goto if
    inline int long mutable namespace new noexcept nullptr operator private protected public
    register return short signed sizeof static struct switch template this throw true try typedef
    typeid typename union unsigned using virtual void volatile wchar while
"""
MACRO = re.compile(r"^#define ([A-Za-z]\w*)", re.MULTILINE)
MOTORS_OF_A_MEGA = 4
STRICT = (
    "-std=gnu++11",
    "-Wall",
    "-Wextra",
    "-Werror",
    "-Wcomment",
    "-fsyntax-only",
    "-Os",
    "-DF_CPU=16000000UL",
)


def macros() -> list[str]:
    """
    Return every macro that a sketch for a Mega sees.
    """
    command = ["avr-g++", "-mmcu=atmega2560", "-DF_CPU=16000000UL", "-DARDUINO=10819"]
    folders = [f"-I{folder}" for folder in INCLUDES]
    text = subprocess.run(
        [*command, *folders, "-xc++", "-E", "-dM", "-"],
        input="#include <Arduino.h>\n", capture_output=True, text=True, check=True,
    ).stdout  # fmt: skip
    return sorted(set(MACRO.findall(text)))


def compile_spec(folder: Path, data: dict[str, Any], *flags: str) -> None:
    """
    Generate the library of the spec *data* and let the compiler read its source and its example.
    """
    spec = folder / "spec.yaml"
    spec.write_text(json.dumps(data), encoding="ascii")  # which is YAML, too
    for path, text in api.render(spec).items():
        if path.startswith(("src/", "examples/")):
            (folder / Path(path).name).write_text(text, encoding="utf-8")
    (folder / "Turn.ino").rename(folder / "Turn.cpp")
    board = find_board(data["board"])
    assert board is not None
    command = ["avr-g++", f"-mmcu={board.mcu.name}", *STRICT, *flags, f"-I{folder}"]
    core = [f"-I{include}" for include in INCLUDES]
    sources = sorted(str(path) for path in folder.glob("*.cpp"))
    done = subprocess.run([*command, *core, *sources], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def spec_of(library: object, names: list[str]) -> dict[str, Any]:
    """
    Return a spec for a Mega with a motor of each of *names*.
    """
    pins = [[f"D{pin + step}" for step in range(4)] for pin in range(22, 38, 4)]
    motion = {"kind": "update-events", "debug": True}
    motors = {
        name: {"drive": {"kind": "four-wire", "pins": pins[index]}, "motion": motion}
        for index, name in enumerate(names)
    }
    return {"library": library, "board": "mega", "motors": motors}


def test_names_that_are_code_elsewhere_compile(tmp_path: Path) -> None:
    """
    Keywords, macros of the core in small letters as motors, and macros such as PORTB as libraries.
    """
    defined = macros()
    assert {"PORTB", "F", "B1", "PI", "bit", "abs"} <= set(defined)
    small = [name for name in defined if re.fullmatch("[a-z][A-Za-z0-9]{0,30}", name)]
    names = sorted({*KEYWORDS.split(), *small})
    libraries = ["PORTB", "F", "B1", "PI", "INPUT", "ISR", "F_CPU", "TCNT1", "DDRB", "SREG"]
    groups = [names[at : at + MOTORS_OF_A_MEGA] for at in range(0, len(names), MOTORS_OF_A_MEGA)]

    for index, group in enumerate(groups):
        folder = tmp_path / str(index)
        folder.mkdir()
        compile_spec(folder, spec_of(libraries[index % len(libraries)], group))


@pytest.mark.parametrize("text", CODE)
def test_hostile_text_compiles(tmp_path: Path, text: str) -> None:
    """
    Texts that end comments, go on in the next line or look like templates, with trigraphs on.
    """
    fields = dict.fromkeys(("author", "maintainer", "sentence", "paragraph"), text)

    compile_spec(tmp_path, spec_of({"name": "Text", **fields}, ["motor"]), "-trigraphs")


def test_no_library_takes_the_place_of_a_header() -> None:
    """
    Each header that ``#include <...>`` finds by its name alone is refused as a library's name.
    """
    command = ["avr-g++", "-mmcu=atmega2560", "-xc++", "-E", "-v", "-"]
    said = subprocess.run(command, input="", capture_output=True, text=True, check=True).stderr
    found = said.split("#include <...> search starts here:")[1].split("End of search list.")[0]
    folders = [*map(Path, found.split()), *INCLUDES]
    headers = {path.stem for folder in folders for path in folder.glob("*.h")}
    libraries = {path.stem for path in (CORE / "libraries").glob("*/src/*.h")}
    names = {name for name in headers | libraries if re.fullmatch(r"[A-Za-z]\w*", name)}

    assert {"stdint", "string", "Arduino", "Wire"} <= names
    for name in sorted(names):
        with pytest.raises(ValueError, match="is a header of the Arduino core or of C"):
            raise AssertionError(Library(name=name))

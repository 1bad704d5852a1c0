"""
The toolchain builds what the Arduino IDE builds, and says clearly why when it cannot.
"""

import subprocess
from pathlib import Path

import pytest

from stepgen.devices import boards
from stepgen.errors import StepgenError
from stepgen.verify import recipes
from stepgen.verify.arduino_builder import build_with_ide
from stepgen.verify.toolchain import (
    Build,
    Compiler,
    Target,
    build,
    compiler_named,
    default_compiler,
    empty_sketch,
    find_compilers,
)

BLINK = """\
#include <Arduino.h>
#include <Lamp.h>
void setup() {
  lampBegin(LED_BUILTIN);
  Serial.begin(9600);
}
void loop() {
  Serial.println(lampToggle(LED_BUILTIN), 2);
  delay(500);
}
"""
LAMP_H = """\
#pragma once
#include <stdint.h>
void lampBegin(uint8_t pin);
float lampToggle(uint8_t pin);
"""
LAMP_CPP = """\
#include "Lamp.h"
#include <Arduino.h>
static volatile uint16_t toggles = 1;
void lampBegin(uint8_t pin) { pinMode(pin, OUTPUT); }
float lampToggle(uint8_t pin) {
  digitalWrite(pin, !digitalRead(pin));
  return ++toggles / 3.0f;
}
"""
LAMP_PROPERTIES = """\
name=Lamp
version=1.0.0
author=stepgen
maintainer=stepgen
sentence=Blinks a lamp.
paragraph=For a test.
category=Device Control
url=https://example.org/
architectures=avr
"""
WARNING = "int unusedParameterHere(int unused) { return 1; }\n"

both_compilers = pytest.mark.parametrize("compiler_name", ["gcc-5.4", "gcc-7.3"])
# One board of each chip and clock: what else differs is bootloader and menu.
FQBNS = {(board.mcu.name, board.f_cpu_hz): board.fqbn for board in boards()}.values()
each_chip = pytest.mark.parametrize("fqbn", FQBNS)

UNO = Target("uno")


@pytest.fixture
def own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """
    Return an empty cache folder, used by this test only.
    """
    cache = tmp_path / "cache"
    monkeypatch.setenv("STEPGEN_CACHE", str(cache))
    return cache


@pytest.fixture
def blink(tmp_path: Path) -> Path:
    """
    Return the folder of a sketch named Blink, with its library in ``libraries`` beside it.
    """
    files = {
        "Blink/Blink.ino": BLINK,
        "libraries/Lamp/library.properties": LAMP_PROPERTIES,
        "libraries/Lamp/src/Lamp.h": LAMP_H,
        "libraries/Lamp/src/Lamp.cpp": LAMP_CPP,
    }
    for name, text in files.items():
        path = tmp_path / "a sketchbook" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    return tmp_path / "a sketchbook" / "Blink"


def build_blink(blink: Path, target: Target, compiler: Compiler, out_dir: Path) -> Build:
    """
    Return the sketch *blink* built with its library.
    """
    library = blink.parent / "libraries" / "Lamp" / "src"
    sources = [blink / "Blink.ino", library / "Lamp.cpp"]
    return build(sources, [library], target, compiler, out_dir)


def write(path: Path, text: str) -> Path:
    """
    Write *text* to *path* and return it.
    """
    path.write_text(text, encoding="utf-8")
    return path


def code_of(program: Build, compiler: Compiler) -> bytes:
    """
    Return the bytes that would be flashed.
    """
    image = program.elf.with_suffix(".bin")
    objcopy = str(compiler.bin_dir / "avr-objcopy")
    subprocess.run(
        [objcopy, "-O", "binary", "-R", ".eeprom", str(program.elf), str(image)], check=True
    )
    return image.read_bytes()


@both_compilers
@each_chip
def test_a_build_is_the_ides_byte_for_byte(
    compiler_name: str, fqbn: str, blink: Path, tmp_path: Path
) -> None:
    """
    A sketch with a library has the code and the sizes that arduino-builder gives it.
    """
    compiler = compiler_named(compiler_name)
    ours = build_blink(blink, Target.from_fqbn(fqbn), compiler, tmp_path / "out")
    libraries = blink.parent / "libraries"
    ide = build_with_ide(blink, libraries, fqbn, compiler, tmp_path / "ide")

    assert (ours.flash_bytes, ours.ram_bytes) == (ide.flash_bytes, ide.ram_bytes)
    assert code_of(ours, compiler) == code_of(ide, compiler)
    assert ide.warnings == ()


@both_compilers
@each_chip
def test_an_empty_sketch_is_smaller_than_blink(
    compiler_name: str, fqbn: str, blink: Path, tmp_path: Path
) -> None:
    """
    The sizes to compare with are those of the IDE's build of an empty sketch.
    """
    compiler, target = compiler_named(compiler_name), Target.from_fqbn(fqbn)
    folder = tmp_path / "Empty"
    folder.mkdir()
    write(folder / "Empty.ino", "void setup() {\n}\nvoid loop() {\n}\n")
    empty = empty_sketch(target, compiler)
    ide = build_with_ide(folder, tmp_path, fqbn, compiler, tmp_path / "ide")
    full = build_blink(blink, target, compiler, tmp_path / "out")

    assert (empty.flash_bytes, empty.ram_bytes) == (ide.flash_bytes, ide.ram_bytes)
    assert empty.flash_bytes < full.flash_bytes
    assert empty.ram_bytes < full.ram_bytes


@both_compilers
def test_a_warning_in_our_source_is_an_error(compiler_name: str, tmp_path: Path) -> None:
    """
    An -Wextra warning fails a strict build, with its place, and passes a lenient one.
    """
    compiler = compiler_named(compiler_name)
    sketch = write(tmp_path / "Bad.ino", "void setup() {}\nvoid loop() {}\n" + WARNING)

    with pytest.raises(StepgenError, match=r"Bad\.ino:3:.*\[-Wunused-parameter\]"):
        build([sketch], [], UNO, compiler, tmp_path / "out")
    lenient = build([sketch], [], UNO, compiler, tmp_path / "out", warnings_as_errors=False)
    assert lenient.flash_bytes == empty_sketch(UNO, compiler).flash_bytes


@both_compilers
def test_a_warning_in_the_core_is_no_error(compiler_name: str, tmp_path: Path) -> None:
    """
    EEPROM.h, whose object this sketch does not use, warns in a strict build and may.
    """
    eeprom = recipes.platform_dir() / "libraries" / "EEPROM" / "src"
    text = "#include <EEPROM.h>\nvoid setup() {}\nvoid loop() {}\n"
    sketch = write(tmp_path / "Eeprom.ino", text)

    build([sketch], [eeprom], UNO, compiler_named(compiler_name), tmp_path / "out")


def test_all_faulty_sources_are_reported_together(tmp_path: Path) -> None:
    """
    Two sources that do not compile are two faults, each short and with its compiler's words.
    """
    sketch = write(tmp_path / "Bad.ino", "void setup() { nowhere(); }\n")
    other = write(tmp_path / "worse.cpp", "wrong x;\n" * 100)

    with pytest.raises(StepgenError) as caught:
        build([sketch, other], [], UNO, default_compiler(), tmp_path / "out")
    first, second = caught.value.faults
    assert "Bad.ino:1:" in first.reason
    assert "'nowhere' was not declared" in first.reason
    assert second.place == str(other)
    assert len(second.reason.splitlines()) < 50
    assert second.reason.endswith("lines more")


def test_a_program_without_loop_does_not_link(tmp_path: Path) -> None:
    """
    A missing definition is the linker's error, in its words.
    """
    sketch = write(tmp_path / "Half.ino", "void setup() {}\n")

    with pytest.raises(StepgenError, match="undefined reference to `loop'"):
        build([sketch], [], UNO, default_compiler(), tmp_path / "out")


@pytest.mark.parametrize(
    ("qualifier", "size", "message"),
    [
        ("", 2040, "bytes of RAM with its library, and arduino:avr:uno has 2048"),
        ("const PROGMEM", 32256, "bytes of flash with its library, and arduino:avr:uno has 32256"),
    ],
)
def test_a_program_too_big_for_the_board_is_refused(
    qualifier: str, size: int, message: str, tmp_path: Path
) -> None:
    """
    An Uno has 2048 bytes of RAM and, beside its bootloader of 512, 32256 of flash.

    The linker of GCC 7.3 accepts both of these; that of 5.4 refuses the first itself.
    """
    text = f"volatile {qualifier} char big[{size}] = {{1}};\n"
    sketch = write(tmp_path / "Big.ino", text + "void setup() { big[0]; }\nvoid loop() {}\n")

    with pytest.raises(StepgenError, match=message):
        build([sketch], [], UNO, compiler_named("gcc-7.3"), tmp_path / "out")


def test_defines_reach_our_sources(tmp_path: Path) -> None:
    """
    A define with quotes and spaces arrives as it was written.
    """
    text = 'static_assert(sizeof(WORD) == 4, "a b");\nvoid setup() {}\nvoid loop() {}\n'
    sketch = write(tmp_path / "Word.ino", text)

    build([sketch], [], UNO, default_compiler(), tmp_path, defines={"WORD": '"a b"'})


def test_the_core_is_compiled_once(own_cache: Path, blink: Path, tmp_path: Path) -> None:
    """
    A second build takes core.a from the cache, where nothing but core.a is kept.
    """
    build_blink(blink, UNO, default_compiler(), tmp_path / "one")
    (core,) = own_cache.glob("core/*/*")
    first = core.stat()
    build_blink(blink, UNO, default_compiler(), tmp_path / "two")

    assert core.name == "core.a"
    assert list(own_cache.glob("core/*/*")) == [core]
    assert (core.stat().st_mtime_ns, core.stat().st_ino) == (first.st_mtime_ns, first.st_ino)


def test_each_board_and_compiler_has_a_core_of_its_own(own_cache: Path) -> None:
    """
    Two boards and two compilers make four cached cores.
    """
    for compiler in find_compilers():
        for target in (UNO, Target("mega", "atmega2560")):
            empty_sketch(target, compiler)

    assert len(list(own_cache.glob("core/*/core.a"))) == 4


@pytest.mark.parametrize(
    ("fqbn", "message"),
    [
        ("uno", "write a board as arduino:avr:uno"),
        ("arduino:avr:unknown", "no such board"),
        ("arduino:avr:mega", "mega: write one of :cpu=atmega1280, :cpu=atmega2560"),
        ("arduino:avr:mega:cpu=atmega8", "mega: write one of :cpu=atmega1280, :cpu=atmega2560"),
        ("arduino:avr:uno:cpu=atmega2560", "uno: leave :cpu out"),
    ],
)
def test_an_impossible_board_is_refused(fqbn: str, message: str) -> None:
    """
    A board that the IDE's menus do not offer is refused with what to write.
    """
    with pytest.raises(StepgenError, match=message):
        recipes.board_properties(Target.from_fqbn(fqbn))


def test_a_target_has_its_name_back() -> None:
    """
    A fully qualified board name survives the way through a Target.
    """
    for fqbn in FQBNS:
        assert Target.from_fqbn(fqbn).fqbn == fqbn


def test_the_ides_warnings_about_a_library_are_returned(blink: Path, tmp_path: Path) -> None:
    """
    The compiler's warning about the library and the IDE's own about its category, no others.
    """
    library = blink.parent / "libraries" / "Lamp"
    write(library / "src" / "Lamp.cpp", LAMP_CPP + WARNING)
    properties = LAMP_PROPERTIES.replace("Device Control", "Lamps")
    write(library / "library.properties", properties)
    compiler, out = default_compiler(), tmp_path / "ide"
    category, unused = build_with_ide(blink, library.parent, UNO.fqbn, compiler, out).warnings

    assert "'Lamps' in library Lamp is not valid" in category
    assert unused.startswith(f"{library}/src/Lamp.cpp:9:")


def test_a_sketch_the_ide_refuses_is_an_error(blink: Path, tmp_path: Path) -> None:
    """
    The IDE's words are in the message, and the sketch is its place.
    """
    sketch = write(blink / "Blink.ino", BLINK + "void more() { nowhere(); }\n")

    with pytest.raises(StepgenError, match="'nowhere' was not declared") as caught:
        build_with_ide(blink, blink.parent / "libraries", UNO.fqbn, default_compiler(), tmp_path)
    assert caught.value.faults[0].place == str(sketch)

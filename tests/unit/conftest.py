"""
A plan of a spec's text, and the independent sources that device facts are checked against.

These are avr-libc and the Arduino core. Each fixture asks the compiler, so that no header is read
by guesswork; a missing compiler or a missing Arduino core fails the tests.
"""

import re
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from elftools.elf.elffile import ELFFile
from elftools.elf.sections import Symbol, SymbolTableSection

from stepgen.devices import Board, Mcu, boards, find_board
from stepgen.plan.model import Plan
from stepgen.plan.planner import make_plan
from stepgen.spec import load_spec

ARDUINO_AVR = Path("/usr/share/arduino/hardware/arduino/avr")

_SFR = re.compile(r"_SFR_(IO|MEM)(?:8|16)\((0[xX][0-9A-Fa-f]+)\)")
_VECTOR = re.compile(r"_VECTOR\((\d+)\)")
_NUMBER = re.compile(r"\(?(0[xX][0-9A-Fa-f]+|\d+)\)?")


def _run(*command: str | Path, stdin: str = "") -> str:
    return subprocess.run(command, input=stdin, capture_output=True, text=True, check=True).stdout


def _macros(*command: str, header: str) -> dict[str, str]:
    """
    Return all object-like macros that are defined after including *header*.
    """
    listing = _run(*command, "-E", "-dM", "-", stdin=f"#include <{header}>\n")
    return {
        name: text.strip()
        for name, text in re.findall(r"^#define (\w+)\b(?!\()(.*)$", listing, re.MULTILINE)
    }


def _matches(
    macros: dict[str, str], pattern: re.Pattern[str]
) -> Iterator[tuple[str, re.Match[str]]]:
    for name, text in macros.items():
        match = pattern.fullmatch(text)
        if match is not None:
            yield name, match


def _symbols(elf: ELFFile) -> Iterator[Symbol]:
    table = elf.get_section_by_name(".symtab")
    assert isinstance(table, SymbolTableSection)
    return table.iter_symbols()


@pytest.fixture(params=boards(), ids=lambda board: board.name)
def board(request: pytest.FixtureRequest) -> Board:
    """
    Return each board in turn.
    """
    found = request.param
    assert isinstance(found, Board)
    return found


@pytest.fixture
def mcu(board: Board) -> Mcu:
    """
    Return the chip of each board in turn.
    """
    return board.mcu


@pytest.fixture
def uno() -> Board:
    """
    Return the Uno.
    """
    found = find_board("uno")
    assert found is not None
    return found


@pytest.fixture
def mega() -> Board:
    """
    Return the Mega.
    """
    found = find_board("mega")
    assert found is not None
    return found


@pytest.fixture
def libc_macros(mcu: Mcu) -> dict[str, str]:
    """
    Return what avr-gcc and avr-libc's ``avr/io.h`` define for the chip.
    """
    return _macros("avr-gcc", f"-mmcu={mcu.name}", header="avr/io.h")


@pytest.fixture
def libc_registers(libc_macros: dict[str, str]) -> dict[str, int]:
    """
    Return avr-libc's registers with their data-space addresses.
    """
    return {
        name: int(match[2], 16) + (0x20 if match[1] == "IO" else 0)
        for name, match in _matches(libc_macros, _SFR)
    }


@pytest.fixture
def libc_vectors(libc_macros: dict[str, str]) -> dict[str, int]:
    """
    Return avr-libc's interrupt vectors with their numbers.
    """
    return {name: int(match[1]) for name, match in _matches(libc_macros, _VECTOR)}


@pytest.fixture
def libc_numbers(libc_macros: dict[str, str]) -> dict[str, int]:
    """
    Return those macros of avr-libc that are plain numbers.
    """
    return {name: int(match[1], 0) for name, match in _matches(libc_macros, _NUMBER)}


@pytest.fixture
def core_flags(board: Board) -> tuple[str, ...]:
    """
    Return the compiler flags for the board's Arduino core and variant.
    """
    return (
        f"-mmcu={board.mcu.name}",
        f"-I{ARDUINO_AVR / 'cores' / 'arduino'}",
        f"-I{ARDUINO_AVR / 'variants' / board.variant}",
        f"-DF_CPU={board.f_cpu_hz}L",
        "-DARDUINO=10819",
        "-DARDUINO_ARCH_AVR",
        "-DDECIMAL_DIG=__DECIMAL_DIG__",
        *("-DUSB_VID=0x2341", "-DUSB_PID=0x8036"),  # of a board with USB; any will do
    )


@pytest.fixture
def core_numbers(core_flags: tuple[str, ...]) -> dict[str, int]:
    """
    Return those macros of ``Arduino.h`` that are plain numbers, such as ``PIN_A0``.
    """
    macros = _macros("avr-g++", *core_flags, "-xc++", header="Arduino.h")
    return {name: int(match[1], 0) for name, match in _matches(macros, _NUMBER)}


@pytest.fixture
def core_interrupts(core_flags: tuple[str, ...]) -> dict[int, int]:
    """
    Return which vector serves each interrupt number of ``attachInterrupt()``.
    """
    source = ARDUINO_AVR / "cores" / "arduino" / "WInterrupts.c"
    text = _run("avr-gcc", *core_flags, "-E", "-P", source)
    handlers = re.findall(r"void __vector_(\d+) \(void\) \{\s*intFunc\[(\d)\]\(\);", text)
    return {int(interrupt): int(vector) for vector, interrupt in handlers}


@pytest.fixture
def compile_core(core_flags: tuple[str, ...], tmp_path: Path) -> Callable[[Path], Path]:
    """
    Return a function that compiles one C or C++ file beside the Arduino core.
    """

    def compile_file(source: Path) -> Path:
        target = tmp_path / f"{source.name}.o"
        compiler = "avr-gcc" if source.suffix == ".c" else "avr-g++"
        standard = "-std=gnu11" if source.suffix == ".c" else "-std=gnu++11"
        options = (standard, f"-I{source.parent}", "-Os")
        _run(compiler, *core_flags, *options, "-c", source, "-o", target)
        return target

    return compile_file


@pytest.fixture
def pin_tables(
    compile_core: Callable[[Path], Path], core_numbers: dict[str, int], tmp_path: Path
) -> dict[str, bytes]:
    """
    Return the tables of the variant's ``pins_arduino.h``, by name.

    One is made here: ``digital_pin_to_interrupt_PGM``, where NOT_AN_INTERRUPT is 255.
    """
    pins = range(core_numbers["NUM_DIGITAL_PINS"])
    interrupts = ", ".join(f"(uint8_t)digitalPinToInterrupt({pin})" for pin in pins)
    source = tmp_path / "pins.cpp"
    source.write_text(
        "#define ARDUINO_MAIN\n#include <Arduino.h>\n"
        f"extern const uint8_t PROGMEM digital_pin_to_interrupt_PGM[] = {{{interrupts}}};\n",
        encoding="ascii",
    )
    tables: dict[str, bytes] = {}
    with compile_core(source).open("rb") as stream:
        elf = ELFFile(stream)
        for symbol in _symbols(elf):
            if symbol.name.endswith("_PGM"):
                data = elf.get_section(symbol["st_shndx"]).data()
                start = symbol["st_value"]
                tables[symbol.name] = data[start : start + symbol["st_size"]]
    return tables


@pytest.fixture
def vectors_defined_by(compile_core: Callable[[Path], Path]) -> Callable[[str], set[int]]:
    """
    Return a function that tells the vectors that a file of the Arduino package defines.
    """

    def vectors(source: str) -> set[int]:
        with compile_core(ARDUINO_AVR / source).open("rb") as stream:
            names = [
                symbol.name
                for symbol in _symbols(ELFFile(stream))
                if symbol["st_shndx"] != "SHN_UNDEF"
            ]
        found = [re.fullmatch(r"__vector_(\d+)", name) for name in names]
        return {int(match[1]) for match in found if match is not None}

    return vectors


@pytest.fixture(scope="session")
def boards_txt() -> dict[str, str]:
    """
    Return the properties of the core's ``boards.txt``.
    """
    lines = (ARDUINO_AVR / "boards.txt").read_text(encoding="utf-8").splitlines()
    return dict(line.split("=", 1) for line in lines if "=" in line and not line.startswith("#"))


@pytest.fixture
def planned(tmp_path: Path) -> Callable[[str], Plan]:
    """
    Return a function that plans a spec from its text, all but the name of the library.
    """

    def plan(text: str) -> Plan:
        path = tmp_path / "spec.yaml"
        path.write_text(f"library: Mine\n{text}", encoding="utf-8")
        return make_plan(load_spec(path))

    return plan

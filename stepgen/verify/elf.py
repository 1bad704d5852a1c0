"""
What the harness needs of an ELF file of avr-gcc: the flash image and the symbols.
"""

import functools
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from elftools.common.exceptions import ELFError
from elftools.elf.elffile import ELFFile
from elftools.elf.sections import SymbolTableSection

from stepgen.errors import StepgenError

RAM_OFFSET = 0x800000
"""Where avr-gcc's linker puts the data space; addresses below are in flash."""


@dataclass(frozen=True)
class Firmware:
    """
    A linked program.

    Args:
        image: The contents of the flash from address 0 on.
        symbols: Addresses by name, without RAM_OFFSET: data address or flash byte address.
    """

    image: bytes
    symbols: Mapping[str, int]


def read_firmware(path: Path) -> Firmware:
    """
    Return the program in the ELF file *path*, read once as long as the file does not change.

    Raises:
        StepgenError: The file is missing or is no ELF file for AVR.
    """
    try:
        state = path.stat()
    except OSError as problem:
        raise StepgenError.of(f"not an ELF file: {problem}", place=str(path)) from problem
    return _read(path, state.st_mtime_ns, state.st_size)


@functools.lru_cache(maxsize=32)
def _read(path: Path, mtime_ns: int, size: int) -> Firmware:  # noqa: ARG001 - with what the file is
    try:
        with path.open("rb") as stream:
            elf = ELFFile(stream)
            if elf["e_machine"] != "EM_AVR":
                raise StepgenError.of("not a program for AVR", place=str(path))
            return Firmware(_flash_image(elf), _symbols(elf))
    except (OSError, ELFError) as problem:
        raise StepgenError.of(f"not an ELF file: {problem}", place=str(path)) from problem


def _flash_image(elf: ELFFile) -> bytes:
    image = bytearray()
    for segment in elf.iter_segments("PT_LOAD"):
        start, data = segment["p_paddr"], segment.data()
        if start >= RAM_OFFSET or not data:
            continue
        # Erased flash reads as ones.
        image.extend(b"\xff" * (start + len(data) - len(image)))
        image[start : start + len(data)] = data
    return bytes(image)


def _symbols(elf: ELFFile) -> dict[str, int]:
    table = elf.get_section_by_name(".symtab")
    if not isinstance(table, SymbolTableSection):
        return {}
    return {
        symbol.name: symbol["st_value"] % RAM_OFFSET
        for symbol in table.iter_symbols()
        if symbol.name and symbol["st_shndx"] != "SHN_UNDEF"
    }

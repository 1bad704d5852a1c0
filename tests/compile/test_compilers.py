"""
The compilers are found, and what is missing is named with the package that has it.
"""

from pathlib import Path

import pytest

from stepgen.errors import StepgenError
from stepgen.verify import recipes
from stepgen.verify.arduino_builder import build_with_ide
from stepgen.verify.toolchain import (
    Target,
    compiler_named,
    default_compiler,
    empty_sketch,
    find_compilers,
)

UNO = Target("uno")


def test_both_compilers_are_found() -> None:
    """
    Debian's GCC 5.4 is first and the default; the wheel's 7.3 needs no extra flag.
    """
    debian, wheel = find_compilers()

    assert debian == default_compiler()
    assert (debian.name, debian.version) == ("gcc-5.4", "5.4.0")
    assert debian.extra_flags == ("-DDECIMAL_DIG=__DECIMAL_DIG__",)
    assert (wheel.name, wheel.version, wheel.extra_flags) == ("gcc-7.3", "7.3.0", ())


def test_a_missing_compiler_names_its_package(monkeypatch: pytest.MonkeyPatch) -> None:
    """
    Without avr-gcc on the PATH the message says what to install; the wheel still works.
    """
    monkeypatch.setenv("PATH", "")

    with pytest.raises(StepgenError, match=r"avr-gcc is not on the PATH.* gcc-avr$"):
        default_compiler()
    with pytest.raises(StepgenError, match=r"gcc-5\.4.*not installed, but gcc-7\.3;.*gcc-avr"):
        compiler_named("gcc-5.4")
    assert [compiler.name for compiler in find_compilers()] == ["gcc-7.3"]


def test_a_compiler_without_c_library_names_its_package(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """
    An avr-gcc that knows no libc.a answers with the bare name, and avr-libc is missing.
    """
    gcc = tmp_path / "avr-gcc"
    gcc.write_text("#!/bin/sh\necho libc.a\n", encoding="utf-8")
    gcc.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))

    with pytest.raises(StepgenError, match=r"has no C library.* avr-libc$"):
        default_compiler()


def test_a_missing_core_names_its_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """
    Without the Arduino core the message says what to install.
    """
    monkeypatch.setattr(recipes, "HARDWARE_DIR", tmp_path)

    with pytest.raises(StepgenError, match=r"AVR core is not in .* arduino-core-avr$"):
        empty_sketch(UNO, default_compiler())


@pytest.mark.parametrize("tool", ["arduino-builder", "arduino-ctags"])
def test_a_missing_builder_names_its_package(
    tool: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """
    Without arduino-builder or its ctags the message says what to install.
    """
    compiler, only = default_compiler(), tmp_path / "bin"
    only.mkdir()
    for name in {"arduino-builder", "arduino-ctags"} - {tool}:
        (only / name).symlink_to(f"/usr/bin/{name}")
    monkeypatch.setenv("PATH", str(only))

    with pytest.raises(StepgenError, match=f"{tool} is not on the PATH.* {tool}$"):
        build_with_ide(tmp_path, tmp_path, UNO.fqbn, compiler, tmp_path / "ide")

"""
The Python package yasimavr, an optional one.
"""

import functools
from importlib import import_module, metadata
from types import ModuleType

from stepgen.errors import StepgenError

INSTALL = "pip install 'stepgen[yasimavr]' compiles it, with Debian's g++ and python3-dev"


def find_version() -> str | None:
    """
    Return the version of yasimavr, or None where it is not installed.
    """
    try:
        return metadata.version("yasimavr")
    except metadata.PackageNotFoundError:
        return None


@functools.cache
def load() -> tuple[ModuleType, ModuleType]:
    """
    Return the modules yasimavr.lib.core and yasimavr.device_library.

    Raises:
        StepgenError: yasimavr is not installed.
    """
    try:
        return import_module("yasimavr.lib.core"), import_module("yasimavr.device_library")
    except ImportError:
        raise StepgenError.of(f"the simulator yasimavr is not here; {INSTALL}") from None

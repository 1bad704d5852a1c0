"""
yasimavr, the simulator of C. Savergne, driven instruction by instruction.
"""

from stepgen.verify.yasimavr.library import INSTALL, find_version
from stepgen.verify.yasimavr.machine import Machine

__all__ = ["INSTALL", "Machine", "find_version"]

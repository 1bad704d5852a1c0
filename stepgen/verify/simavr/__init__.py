"""
libsimavr, driven so that it behaves as the chip does, cycle by cycle.
"""

from stepgen.verify.simavr.build import INSTALL, find_version
from stepgen.verify.simavr.machine import Machine

__all__ = ["INSTALL", "Machine", "find_version"]

"""
libsimavr, driven so that it behaves as the chip does, cycle by cycle.
"""

from stepgen.verify.simavr.machine import Machine

__all__ = ["Machine"]

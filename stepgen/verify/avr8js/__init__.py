"""
avr8js, the simulator of Wokwi, run under Node.js.
"""

from stepgen.verify.avr8js.machine import Machine
from stepgen.verify.avr8js.node import INSTALL, find_version

__all__ = ["INSTALL", "Machine", "find_version"]

"""
stepgen: interrupt-driven stepper motor libraries for AVR boards, proven before flashing.
"""

__version__ = "0.1.0"

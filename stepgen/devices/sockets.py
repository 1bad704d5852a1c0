"""
Shields with sockets for STEP/DIR driver modules, and the pins of each socket.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

_UNO_HEADERS = ("uno", "uno-mini", "ethernet", "mega", "mega1280")


@dataclass(frozen=True)
class Socket:
    """
    The pins of one socket; its ENABLE is active LOW.
    """

    step: str
    direction: str
    enable: str


@dataclass(frozen=True)
class SocketShield:
    """
    A shield: the boards that it fits, and its sockets by the names printed upon it.
    """

    title: str
    boards: tuple[str, ...]
    sockets: Mapping[str, Socket]


SHIELDS: Mapping[str, SocketShield] = MappingProxyType(
    {
        # RepRap wiki, "RAMPS 1.4", pin list: STEP, DIR and ENABLE of each driver.
        "ramps-1.4": SocketShield(
            "RAMPS 1.4",
            ("mega", "mega1280"),
            MappingProxyType(
                {
                    "X": Socket("D54", "D55", "D38"),
                    "Y": Socket("D60", "D61", "D56"),
                    "Z": Socket("D46", "D48", "D62"),
                    "E0": Socket("D26", "D28", "D24"),
                    "E1": Socket("D36", "D34", "D30"),
                }
            ),
        ),
        # Protoneer CNC shield V3 (grbl's pins): one ENABLE for all; A with the jumpers to D12, D13.
        "cnc-shield": SocketShield(
            "CNC shield V3",
            _UNO_HEADERS,
            MappingProxyType(
                {
                    "X": Socket("D2", "D5", "D8"),
                    "Y": Socket("D3", "D6", "D8"),
                    "Z": Socket("D4", "D7", "D8"),
                    "A": Socket("D12", "D13", "D8"),
                }
            ),
        ),
    }
)
"""The shields by the name that a spec gives them."""

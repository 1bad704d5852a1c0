"""
What datasheets and boards say: chips, ports, timers, vectors, pins, and other libraries.
"""

from stepgen.devices.catalogue import boards, find_board
from stepgen.devices.drivers import DRIVERS, UNFIT_DRIVERS, PulseTimes, StepDriver
from stepgen.devices.interrupts import (
    CORE,
    INTERRUPTS,
    MILLIS,
    UNBOUND,
    LibraryInterrupt,
    UnboundInterrupt,
)
from stepgen.devices.libraries import (
    SKETCH_LIBRARIES,
    LibraryClaims,
    SketchLibrary,
    library_claims,
)
from stepgen.devices.model import (
    Board,
    Mcu,
    Pin,
    Port,
    PortBit,
    Register,
    Timer,
    Timer8,
    Timer16,
    Vector,
)
from stepgen.devices.sockets import SHIELDS, Socket, SocketShield

__all__ = [
    "CORE",
    "DRIVERS",
    "INTERRUPTS",
    "MILLIS",
    "SHIELDS",
    "SKETCH_LIBRARIES",
    "UNBOUND",
    "UNFIT_DRIVERS",
    "Board",
    "LibraryClaims",
    "LibraryInterrupt",
    "Mcu",
    "Pin",
    "Port",
    "PortBit",
    "PulseTimes",
    "Register",
    "SketchLibrary",
    "Socket",
    "SocketShield",
    "StepDriver",
    "Timer",
    "Timer8",
    "Timer16",
    "UnboundInterrupt",
    "Vector",
    "boards",
    "find_board",
    "library_claims",
]

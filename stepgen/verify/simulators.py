"""
The simulators that firmware can run in, behind one interface.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Protocol, Self

from stepgen.errors import StepgenError
from stepgen.verify import avr8js, simavr, yasimavr
from stepgen.verify.events import Events


class Machine(Protocol):
    """
    One simulated chip that runs one program; cycles count CPU clocks since reset.
    """

    fine: bool
    """Whether MASKED and UNMASKED are recorded."""

    @property
    def cycle(self) -> int:
        """The cycle of the instruction boundary that was reached."""

    @property
    def isr_stack(self) -> dict[int, int]:
        """Most stack bytes that each vector took; empty where the simulator does not say."""

    def __enter__(self) -> Self:
        """Return the machine."""

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Close it."""

    def run_until(self, cycle: int) -> None:
        """Run to the first instruction boundary at or after *cycle*."""

    def run_until_mark(self, value: int, *, limit_cycles: int) -> bool:
        """Run until *value* is written to EEDR; return False after *limit_cycles* more."""

    def run_until_zero(self, address: int, *, step_cycles: int, limit_cycles: int) -> bool:
        """Run until RAM at *address* is 0, looking each *step_cycles*; False after the limit."""

    def read_ram(self, address: int, size: int) -> bytes:
        """Return *size* bytes of RAM from data address *address* on."""

    def write_ram(self, address: int, data: bytes) -> None:
        """Put *data* into RAM from data address *address* on."""

    def register(self, address: int) -> int:
        """Return what an I/O register (data address) holds; reading disturbs nothing."""

    def symbol(self, name: str) -> int:
        """Return the address of a variable or function."""

    def send_serial(self, data: bytes) -> None:
        """Let *data* arrive at the first USART."""

    def send_usb(self, data: bytes) -> None:
        """Let a program at the computer open the board's port over USB, and send *data* there."""

    def drive_pin(self, pin_address: int, bit: int, *, high: bool) -> None:
        """Pull a pin high or low from outside."""

    def events(self) -> Events:
        """Return what was recorded since `clear_events`, dtype EVENT."""

    def clear_events(self) -> None:
        """Forget what was recorded."""

    def close(self) -> None:
        """Free what the machine holds."""


class OpenMachine(Protocol):
    """
    Returns a machine just out of reset, with the program *elf* in its flash.
    """

    def __call__(self, elf: Path, *, mcu: str, f_cpu_hz: int, watch: Iterable[int] = ()) -> Machine:
        """See above."""


@dataclass(frozen=True)
class Simulator:
    """
    A simulator with the corrections that stepgen makes around it.

    Args:
        name: What ``--simulator`` takes.
        mcus: The chips that it has.
        find_version: Returns its version, None where it is not installed.
        open: Returns a machine.
        install: How to install it.
        tolerance_cycles: How far from the model's cycle an edge may be.
        longest_scenario_cycles: Longer scenarios are left out, as too slow; None for no limit.
        corrected: Points of the conformance suite that it meets only because stepgen puts it
            right.
        tells_overruns: Whether a sketch that reads a counter gets it to the very cycle, on which
            it depends whether a step counts as missed.
        tells_resets: Whether it records the watchdog's reset, and what the pins do then.
    """

    name: str
    mcus: frozenset[str]
    find_version: Callable[[], str | None]
    open: OpenMachine
    install: str
    tolerance_cycles: int = 0
    longest_scenario_cycles: int | None = None
    corrected: frozenset[str] = frozenset()
    tells_overruns: bool = False
    tells_resets: bool = False

    @property
    def version(self) -> str:
        """
        Return its version.

        Raises:
            StepgenError: It is not installed; the message says how to install it.
        """
        found = self.find_version()
        if found is None:
            raise StepgenError.of(f"the simulator {self.name} is not here; {self.install}")
        return found

    @property
    def title(self) -> str:
        """
        Return name and version.
        """
        return f"{self.name} {self.version}"


# Longer ones take too much of real time: a busy sketch runs at 16 to 27 MHz in avr8js, at 0.5 to
# 0.8 MHz in yasimavr, which is run instruction by instruction; for simavr see `make benchmark`.
_AVR8JS_CYCLES = 16_000_000
_YASIMAVR_CYCLES = 10_000_000

# Interrupts that a mask holds back, and when they may come.
_MASKING = {"sei-delay", "masked-flag"}
_RESPONSES = {"response", "response-32u4", "response-1280", "response-2560", "wake-up"}
# What the watchdog's reset leaves of the chip.
_RESETS = {f"watchdog-reset{chip}" for chip in ("", "-32u4", "-1280", "-2560")}

SIMAVR = Simulator(
    "simavr",
    frozenset({"atmega328p", "atmega32u4", "atmega1280", "atmega2560"}),
    simavr.find_version,
    simavr.Machine,
    simavr.INSTALL,
    # What simavr 1.6 itself was seen to do wrong; its timers 1 to 5 and its watchdog are replaced
    # as a whole.
    corrected=frozenset(
        {"double-buffer", "slow-step", "prescaler-phase", "count-kept", "count-zero-loads-nothing"}
        | {"late-compare-shows", "fast-pwm-icr-period", "ctc-icr-period", "ctc-wrap"}
        | {"compare-pins", "compare-pin-edges", "compare-force"}
        | {
            "driven-input",
            "pin-writes",
            "pin-writes-1280",
            "pin-writes-2560",
            "flag-sbi",
            "uart-buffer",
            "uart-status",
            "usb-banks",
            "usb-port",
        }
        | {"watchdog-period", "watchdog-fed"}
        | _RESETS
        | _MASKING
        | _RESPONSES
    ),
    tells_overruns=True,
    tells_resets=True,
)
AVR8JS = Simulator(
    "avr8js",
    frozenset({"atmega328p", "atmega32u4", "atmega1280", "atmega2560"}),
    avr8js.find_version,
    avr8js.Machine,
    avr8js.INSTALL,
    longest_scenario_cycles=_AVR8JS_CYCLES,
    corrected=frozenset(
        {"prescaler-phase", "count-kept", "start-order", "flag-sbi", "port-write-cycles"}
        | {"ctc-wrap", "compare-flag-edge", "timer2-compare", "channel-c"}
        | {"instruction-cycles", "instruction-cycles-32u4", "usb-frames"}
        | {"instruction-cycles-1280", "instruction-cycles-2560"}
        | _RESETS
        | _MASKING
        | _RESPONSES
    ),
    tells_resets=True,
)
YASIMAVR = Simulator(
    "yasimavr",
    frozenset({"atmega328p"}),
    yasimavr.find_version,
    yasimavr.Machine,
    yasimavr.INSTALL,
    # After a change of the prescaler of a running timer its next flag is a cycle late.
    tolerance_cycles=1,
    longest_scenario_cycles=_YASIMAVR_CYCLES,
    corrected=frozenset(
        {"prescaler-phase", "slow-step", "count-kept", "start-order", "late-compare-shows"}
        | {"compare-flag-edge", "flag-sbi", "pin-writes", "instruction-cycles"}
        | _MASKING
        | {"response", "wake-up"}
    ),
)
SIMULATORS = (SIMAVR, AVR8JS, YASIMAVR)


def installed() -> tuple[Simulator, ...]:
    """
    Return the simulators of this machine.
    """
    return tuple(simulator for simulator in SIMULATORS if simulator.find_version())


def simulator_named(name: str) -> Simulator:
    """
    Return the simulator *name*.

    Raises:
        StepgenError: There is none of that name, or it is not installed.
    """
    for simulator in SIMULATORS:
        if simulator.name == name and simulator.version:
            return simulator
    names = ", ".join(simulator.name for simulator in SIMULATORS)
    raise StepgenError.of(f"is no simulator; choose one of {names}, or all", text=name)

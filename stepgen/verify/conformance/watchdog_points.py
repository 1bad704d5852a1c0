"""
Points about the watchdog in its system reset mode, and about what its reset leaves.
"""

from collections.abc import Iterator

from stepgen.verify.conformance.lab import F_CPU_HZ, Lab, of_kind, ram
from stepgen.verify.conformance.point import MEGA_1280_CHIP, MEGA_CHIP, USB_CHIP, point
from stepgen.verify.events import Kind
from stepgen.verify.simulators import Machine

_OSCILLATOR_HZ = 128_000
_SHORTEST_TICKS = 2048
_TICK_CYCLES = F_CPU_HZ // _OSCILLATOR_HZ
# The marks of the program: out of reset, watchdog on, and fed.
_BEGIN, _ON, _FED = 1, 2, 3
_FEEDS = 4
_WDE, _WDP0, _WDRF = 0x08, 0x01, 0x08


def _period_cycles(select: int) -> int:
    """
    Return the time-out for WDP3:0 of *select*, by the table "Watchdog Timer Prescale Select".
    """
    return (_SHORTEST_TICKS << select) * _TICK_CYCLES


def _resets(machine: Machine, since: int, period: int) -> Iterator[str]:
    """
    Yield a finding unless the program begins again one *period* after the last mark *since*.

    The oscillator's ticks fall where they may: one of them, and a few instructions, either way.
    """
    marks = [(int(row["value"]), int(row["cycle"])) for row in of_kind(machine, Kind.MARK)]
    last = max(cycle for value, cycle in marks if value == since)
    begins = [cycle - last for value, cycle in marks if value == _BEGIN and cycle > last]
    if not begins or abs(begins[0] - period) > 2 * _TICK_CYCLES:
        yield f"reset {begins[:1]} cycles after it was fed last, on the chip {period}"


@point("watchdog-period", "The watchdog resets after 2048 and 32768 ticks of 128 kHz", "11.9.2")
def watchdog_period(lab: Lab) -> Iterator[str]:
    """
    See the program begin again so long after it has switched the watchdog on.
    """
    for select in (0, 4):
        period = _period_cycles(select)
        with lab.running("watchdog", SELECT=select) as machine:
            machine.run_until(period + 10_000)
            yield from _resets(machine, _ON, period)


@point("watchdog-fed", "WDR restarts the watchdog's counter", "11.8")
def watchdog_fed(lab: Lab) -> Iterator[str]:
    """
    Let it be fed four times, each 210 000 cycles of 256 000, and then no more.
    """
    period = _period_cycles(0)
    with lab.running("watchdog", SELECT=0, FED=_FEEDS) as machine:
        machine.run_until((_FEEDS + 1) * period)
        fed = [row for row in of_kind(machine, Kind.MARK) if int(row["value"]) == _FED]
        if len(fed) != _FEEDS:
            yield f"it was fed {len(fed)} times before its reset, on the chip {_FEEDS}"
        yield from _resets(machine, _FED, period)


@point("watchdog-sequence", "WDE and WDP change within 4 cycles of WDCE and WDE only", "11.9.2")
def watchdog_sequence(lab: Lab) -> Iterator[str]:
    """
    Set with the sequence; without it, and 6 cycles after it, nothing changes; 3 and 2 are in time.
    """
    with lab.running("watchdog") as machine:
        machine.run_until(10_000)
        seen = ram(machine, "seen", 6)
        expected = [*[_WDE | _WDP0] * 4, _WDE, 0]
        if seen != expected:
            yield f"WDTCSR is {bytes(seen).hex()}, on the chip {bytes(expected).hex()}"


def _after_reset(lab: Lab) -> Iterator[str]:
    """
    See what the program finds after the reset, and that it stays off once it is switched off.
    """
    period = _period_cycles(0)
    with lab.running("watchdog", SELECT=0) as machine:
        machine.run_until(4 * period)
        cause, on, registers, locked, off = ram(machine, "seen", 5)
        if not cause & _WDRF:
            yield f"MCUSR is {cause:#04x}, without WDRF"
        if on != _WDE:
            yield f"WDTCSR is {on:#04x}, on the chip {_WDE:#04x}: on, with the shortest time"
        if registers:
            yield "registers of port B, timer 1 or SREG keep what they held"
        if locked != _WDE:
            yield f"WDTCSR is {locked:#04x} while WDRF is set, on the chip {_WDE:#04x}"
        if off:
            yield f"WDTCSR is {off:#04x} once WDRF is cleared, on the chip 0"
        begins = [row for row in of_kind(machine, Kind.MARK) if int(row["value"]) == _BEGIN]
        starts = ram(machine, "starts", 1)
        if len(begins) != 2 or starts != [2]:  # noqa: PLR2004 - power-on, and one reset
            yield f"{len(begins)} starts, {starts} counted in RAM, on the chip 2"


watchdog_reset = point(
    "watchdog-reset", "After its reset registers are initial, RAM is kept, WDE locked", "11.9"
)(_after_reset)
watchdog_reset_32u4 = point(
    "watchdog-reset-32u4", "The same on the ATmega32U4", "Atmel-7766: WDTCSR", USB_CHIP
)(_after_reset)
watchdog_reset_1280 = point(
    "watchdog-reset-1280", "The same on the ATmega1280", "WDTCSR", MEGA_1280_CHIP
)(_after_reset)
watchdog_reset_2560 = point(
    "watchdog-reset-2560", "The same on the ATmega2560", "WDTCSR", MEGA_CHIP
)(_after_reset)

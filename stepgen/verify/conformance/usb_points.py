"""
Points about the USB of the ATmega32U4, and the computer at its other end.
"""

from collections.abc import Iterator

from stepgen.verify.conformance.lab import F_CPU_HZ, Lab, cycles, gaps, of_kind, ram
from stepgen.verify.conformance.point import USB_CHIP, point
from stepgen.verify.events import Kind

PORTB = 0x25


@point(
    "usb-frames",
    "The PLL of USB locks, and at a computer a frame begins each millisecond",
    "Atmel-7766: 6.11, 22.18.1",
    USB_CHIP,
)
def usb_frames(lab: Lab) -> Iterator[str]:
    """
    See PB5 toggle each 16 000 cycles, give or take the rjmp of the main loop.
    """
    with lab.running("usb") as machine:
        if not machine.run_until_mark(1, limit_cycles=1000):
            yield "the PLL does not lock"
            return
        machine.run_until(100_000)
        late = [abs(gap - F_CPU_HZ // 1000) for gap in gaps(cycles(machine, Kind.PORT, PORTB))]
        if len(late) < 4 or max(late) > 2:  # noqa: PLR2004 - five frames, one instruction
            yield f"frames are off by {late} cycles"


@point(
    "usb-banks",
    "An endpoint of two banks that sends: flags, byte counter, busy banks",
    "Atmel-7766: 22.14, 22.18.2",
    USB_CHIP,
)
def usb_banks(lab: Lab) -> Iterator[str]:
    """
    Look when it is configured, then at 7 bytes, at 8, with one bank given away, and with both.
    """
    with lab.running("usb_banks") as machine:
        if not machine.run_until_mark(1, limit_cycles=1000):
            yield "the PLL does not lock"
            return
        seen = bytes(ram(machine, "seen", 9)).hex(" ")
        if seen != "80 a1 07 81 a1 00 81 00 82":
            yield f"UESTA0X, UEINTX and UEBCLX show {seen}, on the chip 80 a1 07 81 a1 00 81 00 82"


@point(
    "usb-port",
    "A computer finds a serial port, opens it, and bytes pass both ways",
    "Atmel-7766: 22.4, 22.7, 22.12 to 22.14",
    USB_CHIP,
)
def usb_port(lab: Lab) -> Iterator[str]:
    """
    Let it send each byte plus one, in packets of 8; before, look at the requests that it got.
    """
    with lab.running("usb_port") as machine:
        machine.send_usb(b"HAL and, once more, HAL")
        machine.run_until(80 * F_CPU_HZ // 1000)
        requests = bytes(ram(machine, "seen", 8)).hex(" ")
        if requests != "06 05 06 06 09 20 22 00":
            yield f"requests {requests}, of a computer 06 05 06 06 09 20 22"
        coding = bytes(ram(machine, "coding", 7)).hex(" ")
        if coding != "00 c2 01 00 00 00 08":
            yield f"115200 baud, 8N1 came as {coding}"
        sent = bytes(of_kind(machine, Kind.UART)["value"].astype("u1"))
        if sent != b"IBM!boe-!podf!npsf-!IBM":
            yield f"sent {sent!r}"

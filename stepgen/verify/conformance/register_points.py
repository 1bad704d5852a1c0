"""
Points about the registers of a 16-bit timer. Sections as in `timer_points`.
"""

from collections.abc import Iterator

from stepgen.verify.conformance.lab import Lab, ram
from stepgen.verify.conformance.point import point


@point("temp-register", "The 16-bit registers of a timer share one TEMP byte", "16.3")
def temp_register(lab: Lab) -> Iterator[str]:
    """
    TCNT1 = 0x1234, whose read latches 0x12, which OCR1AH = 0x56 replaces; OCR1A needs no TEMP.
    """
    with lab.running("registers") as machine:
        machine.run_until_mark(1, limit_cycles=10_000)
        seen = ram(machine, "bytes", 4)
        if seen != [0x34, 0x56, 0x78, 0x56]:
            yield f"TCNT1 and OCR1A are read as {bytes(seen).hex()}, on the chip 34567856"


@point("icr-read-only", "ICR1 can be written only where it is TOP", "16.11.7")
def icr_read_only(lab: Lab) -> Iterator[str]:
    """
    In mode 0 it stays 0.
    """
    with lab.running("registers") as machine:
        machine.run_until_mark(1, limit_cycles=10_000)
        seen = ram(machine, "bytes", 6)[4:]
        if seen != [0, 0]:
            yield f"ICR1 is {bytes(seen).hex()} after a write in mode 0, on the chip 0"


@point("count-write-blocks", "A write to TCNT1 blocks the compare of the next tick", "16.7.2")
def count_write_blocks(lab: Lab) -> Iterator[str]:
    """
    TCNT1 = OCR1A raises nothing, TCNT1 = OCR1A - 1 does; OCF1A is bit 1.
    """
    with lab.running("registers") as machine:
        machine.run_until_mark(1, limit_cycles=10_000)
        blocked, passed, _ = ram(machine, "flags", 3)
        if blocked & 2:
            yield "TCNT1 = OCR1A raises the compare flag"
        if not passed & 2:
            yield "TCNT1 = OCR1A - 1 raises no compare flag"


@point("counts-exactly", "Between two writes of the clock bits it counts each cycle", "16.4")
def counts_exactly(lab: Lab) -> Iterator[str]:
    """
    Eight nops and an sts of 2 cycles: 10 ticks; and a stopped counter keeps its value.
    """
    with lab.running("registers") as machine:
        machine.run_until_mark(1, limit_cycles=10_000)
        raw = bytes(ram(machine, "counts", 4))
        seen = [int.from_bytes(raw[i : i + 2], "little") for i in (0, 2)]
        yield from lab.differ("count, read twice", [1010, 1010], seen)


@point("flag-write", "A one written to TIFR1 clears that flag, and its interrupt", "16.11.9")
def flag_write(lab: Lab) -> Iterator[str]:
    """
    TOV1 is seen while interrupts are off, and is gone after `TIFR1 = 1 << TOV1`.
    """
    with lab.running("flags") as machine:
        machine.run_until_mark(1, limit_cycles=10_000)
        seen = ram(machine, "seen", 3)
        if seen != [1, 0, 0]:
            yield f"flag before and after, interrupts after: {seen}, but the chip has [1, 0, 0]"


@point("flag-sbi", "sbi to TIFR1 clears its one flag only", "14.4")
def flag_sbi(lab: Lab) -> Iterator[str]:
    """
    `sbi TIFR1, 1` clears OCF1A and leaves OCF1B raised.
    """
    with lab.running("registers") as machine:
        machine.run_until_mark(1, limit_cycles=10_000)
        flags = ram(machine, "flags", 3)[2]
        seen = (flags >> 2 & 1, flags >> 1 & 1)
        if seen != (1, 0):
            yield f"OCF1B and OCF1A are {seen}, on the chip (1, 0)"
